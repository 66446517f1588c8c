// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/motion/encode.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "motion/made_lift.hpp"
#include "reachcast/motion/code_layout.hpp"
#include "reachcast/posture/linkage.hpp"
#include "reachcast/posture/whole_body.hpp"

namespace reachcast {
namespace {

using tests::made_lift;

constexpr double kExact = 1e-12;           // the same arithmetic, in another order
constexpr double kRounding = 1e-9;         // least squares of a few hundred numbers
constexpr double kPathTolerance_m = 0.01;  // eight splines on a lift: far below what people repeat (some 5 cm)
constexpr double kCurveTolerance =
    0.15;  // of logits up to 5: eight splines round the corner where the made lift stands up

const Vec3 kHome(0.02, 0.42, 0.15), kTarget(-0.15, 0.45, 1.15);

Eigen::VectorXd posture_part(const MotionCode& code) {
  return code.coefficients.tail(kBasisCount * posture_coordinate_count(two_handed_linkage()));
}

std::string complaint(const Reach& reach) {
  try {
    (void)encode_reach(reach);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no complaint";
}

TEST(EncodeReach, KeepsWhoAndWhereAndHowLong) {
  Reach reach = made_lift(1.68, kHome, kTarget);
  reach.phase = Phase::retrieve;
  reach.subject.sex = Sex::female;
  const MotionCode code = encode_reach(reach);
  EXPECT_EQ(code.subject.stature_m, 1.68);
  EXPECT_EQ(code.subject.sex, Sex::female);
  EXPECT_EQ(code.phase, Phase::retrieve);
  EXPECT_EQ(code.origin, reach.origin);
  EXPECT_EQ(code.duration_s, reach.duration_s);
  EXPECT_FALSE(code.is_mirrored);
  EXPECT_LT(glm::distance(code.home, kHome), kExact);
  EXPECT_LT(glm::distance(code.target, kTarget), kExact);
  EXPECT_NEAR(code.grip_distance_m, 0.40, kExact);
  EXPECT_EQ(code.coefficients.size(), code_length());
  EXPECT_TRUE(code.coefficients.allFinite());
}

TEST(EncodeReach, KeepsLengthsInStaturesAndHowTheTorsoShortens) {
  Reach reach = made_lift(1.75, kHome, kTarget);
  const Body body = Body::from_stature(1.75);
  const std::array<double, kLengthCount> lengths = lengths_of(encode_reach(reach)),
                                         wanted = segment_lengths(body.posture());
  for (std::size_t i = 0; i < kLengthCount; ++i)
    EXPECT_NEAR(lengths[i] * 1.75, wanted[i], kRounding) << segment_names()[i];
  EXPECT_NEAR(torso_at(encode_reach(reach), 0.4), 1.0, kRounding);
  for (std::size_t f = 0; f < reach.frames(); ++f) {
    const double share = 1.0 - 0.1 * (1.0 - static_cast<double>(f) / static_cast<double>(reach.frames() - 1));
    const Vec3 waist = reach.postures[f][index(Joint::l5s1)];
    Vec3& neck = reach.postures[f][index(Joint::c7t1)];
    neck = waist + share * (neck - waist);
  }
  const MotionCode bent = encode_reach(reach);
  for (const double t : {0.0, 0.3, 1.0}) EXPECT_NEAR(torso_at(bent, t), 0.9 + 0.1 * t, kRounding) << t;
}

TEST(EncodeReach, IsTheSameInEveryBitTheSecondTime) {
  const Reach reach = made_lift(1.75, kHome, kTarget);
  EXPECT_EQ(encode_reach(reach).coefficients, encode_reach(reach).coefficients);
}

TEST(EncodeReach, ThePathOfTheHandsComesBack) {
  const Reach reach = made_lift(1.75, kHome, kTarget);
  const MotionCode code = encode_reach(reach);
  const EndpointPath path = path_of(code);
  EXPECT_EQ(point_at(path, code.home, code.target, 0.0), code.home);
  EXPECT_EQ(point_at(path, code.home, code.target, 1.0), code.target);
  for (std::size_t f = 0; f < reach.frames(); ++f) {
    const double t = static_cast<double>(f) / static_cast<double>(reach.frames() - 1);
    EXPECT_LT(glm::distance(point_at(path, code.home, code.target, t), reach.hold_point(f)), kPathTolerance_m) << f;
  }
}

TEST(EncodeReach, TheCurvesPassThroughThePostures) {
  const Reach reach = made_lift(1.75, kHome, kTarget);
  const MotionCode code = encode_reach(reach);
  for (std::size_t f = 0; f < reach.frames(); ++f) {
    const double t = static_cast<double>(f) / static_cast<double>(reach.frames() - 1);
    const Eigen::VectorXd recorded = encode_posture(two_handed_linkage(), reach.postures[f]);
    EXPECT_LT((coordinates_at(code, t) - recorded).cwiseAbs().maxCoeff(), kCurveTolerance) << f;
  }
}

TEST(EncodeReach, APathPutIntoACodeIsThePathTakenOut) {
  MotionCode code = encode_reach(made_lift(1.75, kHome, kTarget));
  const Eigen::VectorXd postures = posture_part(code);
  const EndpointPath other = path_of(encode_reach(made_lift(1.6, kHome, Vec3(0.15, 0.38, 0.9))));
  set_path(code, other);
  EXPECT_EQ(path_of(code).velocity, other.velocity);
  EXPECT_EQ(path_of(code).deviation, other.deviation);
  EXPECT_EQ(posture_part(code), postures);
}

/// Straight ahead: the way that a body faces is seen from a fixed distance behind it.
TEST(EncodeReach, PosturesDoNotDependOnTheSizeOfThePerson) {
  const Reach reach = made_lift(1.7, {0.0, 0.42, 0.15}, {0.0, 0.45, 1.15});
  Reach larger = reach;
  larger.subject.stature_m *= 1.13;
  for (Posture& posture : larger.postures) {
    for (Vec3& joint : posture) joint *= 1.13;
  }
  const Eigen::VectorXd difference = posture_part(encode_reach(larger)) - posture_part(encode_reach(reach));
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), kRounding);
}

TEST(EncodeReach, TwiceAsManyFramesTellTheSameStory) {
  const MotionCode coarse = encode_reach(made_lift(1.75, kHome, kTarget, 25));
  const MotionCode fine = encode_reach(made_lift(1.75, kHome, kTarget, 49));
  for (const double t : {0.0, 0.1, 0.35, 0.5, 0.8, 1.0}) {
    EXPECT_LT((coordinates_at(coarse, t) - coordinates_at(fine, t)).cwiseAbs().maxCoeff(), kCurveTolerance) << t;
    EXPECT_LT(glm::distance(point_at(path_of(coarse), kHome, kTarget, t), point_at(path_of(fine), kHome, kTarget, t)),
              kPathTolerance_m);
  }
}

TEST(EncodeReach, ACodePlayedBackwardsIsThatOfTheReachPlayedBackwards) {
  for (const Phase phase : {Phase::transfer, Phase::retrieve, Phase::reach, Phase::return_}) {
    Reach reach = made_lift(1.75, kHome, kTarget);
    reach.phase = phase;
    const MotionCode expected = encode_reach(reversed(reach)), code = reversed(encode_reach(reach));
    // Speed along an axis is fitted from its start, so that its least squares are not quite the same from the end.
    const auto rest = [](const MotionCode& c) {
      Eigen::VectorXd coefficients = c.coefficients;
      for (const Eigen::Index at : {layout::kHoldWay, layout::kPelvis + 3})
        coefficients.segment<kPathBasisCount>(at).setZero();
      return coefficients;
    };
    EXPECT_LT((rest(code) - rest(expected)).cwiseAbs().maxCoeff(), kRounding);
    for (const double t : {0.1, 0.3, 0.5, 0.8})
      EXPECT_NEAR(progress(path_of(code), t), progress(path_of(expected), t), 0.01) << t;
    EXPECT_EQ(code.phase, expected.phase);
    EXPECT_EQ(code.origin, expected.origin);
    EXPECT_LT(glm::distance(code.home, expected.home), kExact);
    EXPECT_LT(glm::distance(code.target, expected.target), kExact);
  }
}

TEST(EncodeReach, TheMirrorImageOfTheMirrorImageIsTheReach) {
  const Reach reach = made_lift(1.75, kHome, kTarget);
  EXPECT_EQ(encode_reach(mirrored(mirrored(reach))).coefficients, encode_reach(reach).coefficients);
  const MotionCode image = encode_reach(mirrored(reach));
  EXPECT_LT(glm::distance(image.target, kTarget * Vec3(-1, 1, 1)), kExact);
}

TEST(EncodeReach, RefusesWhatIsNoReachAndNamesItsOrigin) {
  const Reach good = made_lift(1.75, kHome, kTarget);
  const auto changed = [&](const std::function<void(Reach&)>& change) {
    Reach reach = good;
    reach.origin = "tape.csv:3-9";
    change(reach);
    return complaint(reach);
  };
  const std::string few = changed([](Reach& r) { r.postures.resize(3); });
  EXPECT_NE(few.find("tape.csv:3-9"), std::string::npos) << few;
  EXPECT_NE(few.find("3 postures"), std::string::npos) << few;
  EXPECT_NE(changed([](Reach& r) { r.postures.clear(); }).find("0 postures"), std::string::npos);
  const std::string lost = changed([](Reach& r) { r.postures[7][index(Joint::c7t1)].y = kMissing; });
  EXPECT_NE(lost.find("c7t1"), std::string::npos) << lost;
  EXPECT_NE(lost.find("posture 7"), std::string::npos) << lost;
  for (const double seconds : {0.0, -1.0, kMissing}) {
    const std::string timeless = changed([&](Reach& r) { r.duration_s = seconds; });
    EXPECT_NE(timeless.find("duration"), std::string::npos) << timeless;
  }
  const std::string still = changed([](Reach& r) { r.postures.back() = r.postures.front(); });
  EXPECT_NE(still.find("tape.csv:3-9: hold point"), std::string::npos) << still;
}

}  // namespace
}  // namespace reachcast
