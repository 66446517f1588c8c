// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/simulate/simulate_reach.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "reachcast/curves/bezier.hpp"
#include "reachcast/curves/normal_numbers.hpp"
#include "reachcast/posture/twist.hpp"
#include "reachcast/predict/plan.hpp"
#include "reachcast/predict/stand.hpp"
#include "reachcast/simulate/body_track.hpp"
#include "reachcast/simulate/hand_motion.hpp"
#include "reachcast/simulate/solve.hpp"

namespace reachcast::simulate {
namespace {

constexpr double kHalfGrip_m = 0.20;  // of the add-on's default box
constexpr double kBoxDown_m = 0.0;    // the box's centre is level with its handles
constexpr double kMostInward_m = 0.12, kBodyRadius_m = 0.11, kHalfDepth_m = 0.14;
constexpr double kLowestHold_m = 0.12;
constexpr int kDraws = 20;
constexpr std::array<double, 2> kPulls{0.1, 0.2};  // to the neighbouring moments, round by round
constexpr double kMood = 0.12;                     // how much a person's liking varies from motion to motion

/// Where and how the hands go.
class Hands {
 public:
  Hands(const Person& person, const Errand& errand, const PoseModel& model) : errand_(errand) {
    const Anchors rest = anchors_of(standing_at_ease(model.body()));
    rest_half_ = 0.5 * (rest.grip[1] - rest.grip[0]);
    const Vec3 at_rest = 0.5 * (rest.grip[0] + rest.grip[1]);
    const bool comes = errand.phase == Phase::reach, goes = errand.phase == Phase::return_;
    start_ = comes ? at_rest : errand.phase == Phase::transfer ? errand.home.hold : errand.target.hold;
    end_ = goes ? at_rest : errand.phase == Phase::retrieve ? errand.home.hold : errand.target.hold;
    path_ = clear_path(person);
  }

  [[nodiscard]] const Vec3& start() const { return start_; }
  [[nodiscard]] const Vec3& end() const { return end_; }

  [[nodiscard]] double progress(double time) const { return path_.speed.progress(time); }

  /// At a share of the path.
  [[nodiscard]] Holding at(double share, const PoseModel& model) const {
    const Vec3 hold = eval_bezier(path_.control, share);
    const double yaw = facing_yaw(Vec3(0.0), hold);
    double open = 0.0;  // 1 with the hands at the sides
    if (errand_.phase == Phase::reach) open = 1.0 - eased(0.0, 1.0, share);
    if (errand_.phase == Phase::return_) open = eased(0.0, 1.0, share);
    const Vec3 half = turned(glm::mix(Vec3(kHalfGrip_m, 0, 0), rest_half_, open), yaw);
    Holding out;
    out.anchors = model.anchors({hold - half, hold + half});
    const bool loaded = is_loaded(errand_.phase);
    const BoxPlace box = loaded ? BoxPlace{hold, yaw} : BoxPlace{errand_.target.hold, errand_.target.yaw_rad};
    out.load = {box.hold - Vec3(0, 0, kBoxDown_m), loaded ? errand_.load_kg : 0.0};
    out.box = box;
    // Eyes go to where the hands will be, and from what they leave ahead again.
    const Vec3 ahead(0.0, 3.0, 0.8 * model.body().stature_m());
    const double look = eased(0.0, 0.6, share);
    out.looked_at = errand_.phase == Phase::return_ ? glm::mix(start_, ahead, look)
                    : errand_.phase == Phase::reach ? glm::mix(ahead, end_, look)
                                                    : glm::mix(start_, end_, look);
    return out;
  }

 private:
  /// Paths that would lead the box through the body or the floor are drawn again; if all do, the
  /// straight line is taken.
  [[nodiscard]] HandPath clear_path(const Person& person) const {
    HandPath path;
    for (int draw = 0; draw < kDraws; ++draw) {
      path = draw_hand_path(person, start_, end_, derived_seed(errand_.seed, static_cast<std::uint64_t>(draw)));
      if (is_clear(path)) return path;
    }
    for (std::size_t i : {1u, 2u}) path.control[i] = glm::mix(start_, end_, static_cast<double>(i) / 3.0);
    return path;
  }

  [[nodiscard]] bool is_clear(const HandPath& path) const {
    const bool loaded = is_loaded(errand_.phase);
    const double least = loaded ? kHalfDepth_m + kBodyRadius_m : 0.0;
    const double allowed = std::min({least, level(start_) - 0.03, level(end_) - 0.03});
    const double low = std::min({kLowestHold_m, start_.z, end_.z});
    for (int i = 1; i < 20; ++i) {
      const Vec3 hold = eval_bezier(path.control, i / 20.0);
      if (level(hold) < allowed || hold.z < low - 0.01 || hold.y < -0.1) return false;
    }
    return true;
  }

  static double level(const Vec3& v) { return std::hypot(v.x, v.y); }

  const Errand& errand_;
  Vec3 start_{0.0}, end_{0.0}, rest_half_{0.0};
  HandPath path_;
};

/// The person as disposed for this motion.
Person in_mood(const Person& person, std::uint64_t seed) {
  Person out = person;
  const Eigen::VectorXd normal = normal_numbers(derived_seed(seed, 1000), 2);
  out.squatting += kMood * normal[0];
  out.tempo *= std::clamp(1.0 + 0.07 * normal[1], 0.8, 1.25);
  return out;
}

double share_at(std::size_t moment) {
  return static_cast<double>(moment) / static_cast<double>(kMoments - 1);
}

/// Unknowns of least effort at shares of the hands' path, found one from the other from the end that bends the body
/// more.
Eigen::MatrixXd sought(const Effort& effort, const Hands& hands) {
  Eigen::MatrixXd found(kMoments, kUnknowns);
  const bool backwards = hands.end().z < hands.start().z;
  Unknowns last;
  for (std::size_t i = 0; i < kMoments; ++i) {
    const std::size_t moment = backwards ? kMoments - 1 - i : i;
    const Holding holding = hands.at(share_at(moment), effort.model());
    last = (i == 0 ? least_effort(effort, holding) : least_effort(effort, holding, last)).x;
    found.row(static_cast<Eigen::Index>(moment)) = last.transpose();
  }
  return found;
}

/// A least effort may jump from one moment to the next where a body cannot: every moment is sought again near its
/// neighbours, a few times over.
void draw_together(const Effort& effort, const Hands& hands, Eigen::MatrixXd& found) {
  for (const double weight : kPulls) {
    for (Eigen::Index moment = 0; moment < found.rows(); ++moment) {
      const Eigen::Index before = std::max<Eigen::Index>(moment - 1, 0), after = std::min(moment + 1, found.rows() - 1);
      const Unknowns near = 0.5 * (found.row(before) + found.row(after)).transpose();
      const Holding holding = hands.at(share_at(static_cast<std::size_t>(moment)), effort.model());
      const Unknowns start = found.row(moment).transpose();
      found.row(moment) = least_effort(effort, holding, start, {near, weight}).x.transpose();
    }
  }
}

BodyTrack body_track(const Effort& effort, const Hands& hands) {
  Eigen::MatrixXd found = sought(effort, hands);
  draw_together(effort, hands, found);
  std::vector<Decoded> moments;
  for (std::size_t moment = 0; moment < kMoments; ++moment) {
    const Holding holding = hands.at(share_at(moment), effort.model());
    const Unknowns x = found.row(static_cast<Eigen::Index>(moment)).transpose();
    moments.push_back(effort.model().pose(x, holding.anchors, holding.load).decoded);
  }
  return {effort.model().body(), moments};
}

}  // namespace

Simulated simulate_reach(const Person& person, const Errand& errand) {
  const Person disposed = in_mood(person, errand.seed);
  const PoseModel model(person.body, *person.subject.mass_kg);
  const Effort effort(disposed, model);
  const Hands hands(disposed, errand, model);
  Simulated out;
  const BodyTrack track = body_track(effort, hands);
  out.reach.subject = person.subject;
  out.reach.phase = errand.phase;
  out.reach.origin = errand.origin;
  out.reach.duration_s = motion_seconds(disposed, errand.phase, hands.start(), hands.end(), errand.load_kg);
  for (std::size_t frame = 0; frame < kFrames; ++frame) {
    const double share = hands.progress(static_cast<double>(frame) / static_cast<double>(kFrames - 1));
    const Holding holding = hands.at(share, model);
    HoldReport held;
    out.reach.postures.push_back(model.held(track.at(share), holding.anchors, holding.load, held));
    out.held_m = std::max(out.held_m, held.trunk_shift_m);
    out.unbalanced_m = std::max(out.unbalanced_m, held.unbalanced_m);
    out.shortfall_m = std::max(out.shortfall_m, held.shortfall_m);
  }
  return out;
}

}  // namespace reachcast::simulate
