// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/motion/mirror_code.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "motion/made_lift.hpp"
#include "reachcast/motion/encode.hpp"

namespace reachcast {
namespace {

using tests::made_lift;

/// A lift to the side by a body that is alike on both sides.
Reach lift() {
  return made_lift(1.72, Vec3(0.05, 0.42, 0.2), Vec3(-0.35, 0.3, 1.2));
}

TEST(MirrorImage, IsWhatTheMirroredPosturesGive) {
  const Reach reach = lift();
  const Eigen::VectorXd image = mirror_image(encode_reach(reach).coefficients),
                        wanted = encode_reach(mirrored(reach)).coefficients;
  EXPECT_GT((wanted - encode_reach(reach).coefficients).cwiseAbs().maxCoeff(), 0.1) << "the lift is not its own image";
  EXPECT_LT((image - wanted).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(MirrorImage, OfAStepOfTheLeftFootIsAStepOfTheRight) {
  Reach reach = lift();
  const auto last = static_cast<double>(reach.frames() - 1);
  for (std::size_t f = 0; f < reach.frames(); ++f) {
    const double t = static_cast<double>(f) / last;
    for (const Joint j : {Joint::left_ankle, Joint::left_ball})
      reach.postures[f][index(j)] += Vec3(-0.3 * t, 0.2 * t, 0.4 * t * (1.0 - t));
  }
  const Eigen::VectorXd image = mirror_image(encode_reach(reach).coefficients),
                        wanted = encode_reach(mirrored(reach)).coefficients;
  EXPECT_LT((image - wanted).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(MirrorImage, OfTheImageIsTheMotionInEveryBit) {
  Eigen::VectorXd numbers(code_length());
  for (Eigen::Index i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i + 1);
  EXPECT_EQ(mirror_image(mirror_image(numbers)), numbers);
  EXPECT_NE(mirror_image(numbers), numbers);
}

TEST(MirrorImage, RefusesAnotherLength) {
  EXPECT_THROW((void)mirror_image(Eigen::VectorXd::Zero(code_length() - 1)), std::invalid_argument);
}

}  // namespace
}  // namespace reachcast
