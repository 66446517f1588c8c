// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/motion/mirror_code.hpp"

#include <array>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "reachcast/motion/code_layout.hpp"
#include "reachcast/motion/encode.hpp"
#include "reachcast/posture/whole_body.hpp"

namespace reachcast {
namespace {

/// Where each coefficient of an image comes from, and with which sign.
struct Origin {
  Eigen::Index from = 0;
  double sign = 1.0;
};

class Layout {
 public:
  Layout() {
    way(next_);
    separation();
    move(layout::kFeet + layout::kMoveLength);
    move(layout::kFeet);
    move(layout::kPelvis);
    run(next_, kBasisCount, 1.0);                              // the torso
    run(next_, static_cast<Eigen::Index>(kLengthCount), 1.0);  // lengths
    const Linkage& linkage = two_handed_linkage();
    const auto trunk = static_cast<Eigen::Index>(Chain::coordinate_count(linkage.primary.joints.size() - 1)) +
                       static_cast<Eigen::Index>(3 * kPartCount);
    curves(trunk, trunk);   // what the trunk has from its mirror image
    curves(-trunk, trunk);  // and the other way round
    const Eigen::Index pointers = next_;
    for (const PointerSpec& pointer : linkage.pointers) {
      std::size_t other = 0;
      while (linkage.pointers[other].to != mirrored(pointer.to)) ++other;
      vector(pointers + static_cast<Eigen::Index>(3 * other) * kBasisCount, {-1.0, 1.0, 1.0});
    }
    const Eigen::Index limbs = next_;
    for (std::size_t limb = 0; limb < kLimbCount; ++limb) {
      const Eigen::Index other = limbs + static_cast<Eigen::Index>(6 * (limb ^ 1U)) * kBasisCount;
      vector(other, {1.0, -1.0, -1.0});  // a normal turns as a cross product does
      vector(other + 3 * kBasisCount, {-1.0, 1.0, 1.0});
    }
  }

  [[nodiscard]] const std::vector<Origin>& origins() const { return origins_; }

 private:
  void run(Eigen::Index from, Eigen::Index count, double sign) {
    for (Eigen::Index i = 0; i < count; ++i) origins_.push_back({from + i, sign});
    next_ += count;
  }
  /// Runs of coefficients from `from` on, each with a sign.
  void runs(Eigen::Index from, std::initializer_list<std::pair<Eigen::Index, double>> parts) {
    for (const auto& [count, sign] : parts) run(from, count, sign), from += count;
  }
  void way(Eigen::Index from) {
    runs(from, {{kPathBasisCount, 1.0},   // speed along the line
                {kPathBasisCount, -1.0},  // deviation to the right
                {2 * kPathBasisCount, 1.0},
                {1, -1.0},  // offsets of the Bezier curve
                {2, 1.0},
                {1, -1.0},
                {2, 1.0},
                {2, 1.0}});  // its exponents of speed
  }
  void move(Eigen::Index from) {
    runs(from, {{1, -1.0}, {2, 1.0}});
    way(from + 3);
  }
  void separation() { vector(next_, {1.0, -1.0, -1.0}); }
  void curves(Eigen::Index shift, Eigen::Index count) { run(next_ + shift * kBasisCount, count * kBasisCount, 1.0); }
  void vector(Eigen::Index from, const std::array<double, 3>& signs) {
    for (int k = 0; k < 3; ++k) run(from + k * kBasisCount, kBasisCount, signs[static_cast<std::size_t>(k)]);
  }

  std::vector<Origin> origins_;
  Eigen::Index next_ = 0;
};

}  // namespace

Eigen::VectorXd mirror_image(const Eigen::VectorXd& coefficients) {
  static const Layout layout;
  if (coefficients.size() != code_length()) {
    throw std::invalid_argument("coefficients has " + std::to_string(coefficients.size()) + " values, expected " +
                                std::to_string(code_length()));
  }
  Eigen::VectorXd image(coefficients.size());
  Eigen::Index next = 0;
  for (const Origin& origin : layout.origins()) image[next++] = origin.sign * coefficients[origin.from];
  return image;
}

}  // namespace reachcast
