// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/mocap/gaps.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "units.hpp"

namespace reachcast {
namespace {

constexpr double kLongestLimit_s = 2.0;
constexpr std::size_t kFewestForSlope = 3;
constexpr std::size_t kMostForSlope = 9;

/// Slope per frame at the last of `points`, recorded one frame after the other: that of the parabola fitted to them; of
/// the straight line through two; empty for one alone.
std::optional<Vec3> slope_at_end(const Points& points) {
  if (points.size() < 2) return std::nullopt;
  const std::size_t count = points.size();
  if (count < kFewestForSlope) return points[count - 1] - points[count - 2];
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d right = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) - static_cast<double>(count - 1);
    const Eigen::Vector3d powers(1.0, t, t * t);
    normal += powers * powers.transpose();
    right += powers * to_eigen(points[i]).transpose();
  }
  const Eigen::Matrix3d coefficients = normal.ldlt().solve(right);
  return to_glm(Eigen::Vector3d(coefficients.row(1).transpose()));
}

/// One gap of one point: frames first to last are missing, those beside them are recorded.
class Gap {
 public:
  Gap(Clip& clip, std::size_t joint, std::size_t first, std::size_t last)
      : clip_(clip), joint_(joint), first_(first), last_(last) {}

  void fill() {
    const Vec3 before = clip_.at(first_ - 1, joint_), after = clip_.at(last_ + 1, joint_);
    const auto steps = static_cast<double>(last_ + 2 - first_);
    const Vec3 chord = after - before;
    const Vec3 leaving = slope_at_end(recorded_before()).value_or(chord / steps) * steps;
    const std::optional<Vec3> backwards = slope_at_end(recorded_after());
    const Vec3 arriving = backwards ? *backwards * -steps : chord;
    for (std::size_t frame = first_; frame <= last_; ++frame) {
      const double t = static_cast<double>(frame + 1 - first_) / steps;
      const double u = 1.0 - t;
      // Hermite's cubic.
      clip_.at(frame, joint_) = before * ((1.0 + 2.0 * t) * u * u) + leaving * (t * u * u) +
                                after * (t * t * (3.0 - 2.0 * t)) - arriving * (t * t * u);
      clip_.filled[frame * clip_.joints() + joint_] = 1;
    }
  }

 private:
  /// As many frames as the gap has, within limits, in the order of time; filled ones are not recorded.
  Points recorded_before() const {
    Points points;
    for (std::size_t frame = first_; frame-- > 0 && points.size() < wanted() && is_recorded(frame);) {
      points.push_back(clip_.at(frame, joint_));
    }
    std::reverse(points.begin(), points.end());
    return points;
  }
  /// The same after the gap, against the order of time.
  Points recorded_after() const {
    Points points;
    for (std::size_t frame = last_ + 1; frame < clip_.frames() && points.size() < wanted() && is_recorded(frame);
         ++frame) {
      points.push_back(clip_.at(frame, joint_));
    }
    std::reverse(points.begin(), points.end());
    return points;
  }
  bool is_recorded(std::size_t frame) const {
    return is_finite(clip_.at(frame, joint_)) && clip_.filled[frame * clip_.joints() + joint_] == 0;
  }
  std::size_t wanted() const { return std::clamp(last_ + 1 - first_, kFewestForSlope, kMostForSlope); }

  Clip& clip_;
  std::size_t joint_, first_, last_;
};

}  // namespace

Clip fill_gaps(const Clip& clip, double limit_s) {
  if (!(limit_s >= 0.0 && limit_s <= kLongestLimit_s)) {
    throw std::invalid_argument("limit_s must be 0 to " + show(kLongestLimit_s) + " s, not " + show(limit_s));
  }
  Clip result = clip;
  result.filled.resize(clip.positions.size(), 0);
  // A hundredth of a frame of slack: 0.2 s at 29.97 Hz is 6 frames.
  const double most_frames = limit_s * clip.rate_hz * 1.002 + 0.01;
  for (std::size_t joint = 0; joint < clip.joints(); ++joint) {
    for (std::size_t frame = 0; frame < clip.frames(); ++frame) {
      if (is_finite(clip.at(frame, joint))) continue;
      const std::size_t first = frame;
      while (frame < clip.frames() && !is_finite(clip.at(frame, joint))) ++frame;
      const bool has_ends = first > 0 && frame < clip.frames();
      if (has_ends && static_cast<double>(frame - first) <= most_frames) Gap(result, joint, first, frame - 1).fill();
    }
  }
  return result;
}

}  // namespace reachcast
