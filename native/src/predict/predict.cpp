// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/predict.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "reachcast/motion/encode.hpp"
#include "reachcast/posture/hold.hpp"
#include "reachcast/posture/linkage.hpp"
#include "reachcast/predict/approach.hpp"
#include "reachcast/predict/blend.hpp"

namespace reachcast {
namespace {

constexpr double kPause_s = 0.25;             // hands on the box before it leaves and after it stands
constexpr double kAfter_s = 0.4;              // held pose after letting go
constexpr double kOpening_m = 0.03;           // how far each hand leaves the box
constexpr double kAnticipation = 0.2;         // share of the transfer over which the body gets going and comes to rest
constexpr double kUsualBodyMassIndex = 24.0;  // kg/m^2, where the subject's mass is not known
constexpr double kFarFromData_m = 0.25;
constexpr double kStatureMargin_m = 0.03;

template <class... Parts>
[[noreturn]] void fail(const Parts&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  throw std::invalid_argument(out.str());
}

void check(const Subject& subject, const PredictOptions& options) {
  if (!(subject.stature_m >= 0.5 && subject.stature_m <= 2.6)) {
    fail("stature is ", subject.stature_m, " m; it must lie between 0.5 and 2.6 m");
  }
  if (!(options.frame_rate >= 1.0 && options.frame_rate <= 1000.0)) {
    fail("frame_rate is ", options.frame_rate, "; it must lie between 1 and 1000");
  }
  if (options.duration_s && !(*options.duration_s >= 0.1 && *options.duration_s <= 60.0)) {
    fail("duration is ", *options.duration_s, " s; it must lie between 0.1 and 60 s");
  }
}

double body_mass(const Subject& subject) {
  return subject.mass_kg.value_or(kUsualBodyMassIndex * subject.stature_m * subject.stature_m);
}

Vec3 hold_point(const Box& box, const Vec3& place) {
  return place + Vec3(0, 0, box.handle_height_m);
}

std::vector<std::string> why_outside(const std::vector<MotionSummary>& motions, const Query& query) {
  double target = 1e9, home = 1e9, shortest = 1e9, tallest = 0.0;
  for (const MotionSummary& m : motions) {
    if (m.phase != query.phase) continue;
    target = std::min(target, glm::distance(m.target, query.target));
    home = std::min(home, glm::distance(m.home, query.home));
    shortest = std::min(shortest, m.subject.stature_m);
    tallest = std::max(tallest, m.subject.stature_m);
  }
  std::vector<std::string> reasons;
  const auto add = [&](const auto&... parts) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(2);
    (out << ... << parts);
    reasons.push_back(out.str());
  };
  if (target > kFarFromData_m) add("the nearest recorded target is ", target, " m away");
  if (home > kFarFromData_m) add("the nearest recorded home is ", home, " m away");
  if (query.stature_m < shortest - kStatureMargin_m || query.stature_m > tallest + kStatureMargin_m) {
    add("stature ", query.stature_m, " m lies outside the recorded ", shortest, " to ", tallest, " m");
  }
  return reasons;
}

Events schedule(double duration_s, double rate) {
  const auto frames = [&](double seconds) {
    return static_cast<std::size_t>(std::max(1L, std::lround(seconds * rate)));
  };
  Events e;
  e.lift_off = e.grasp + frames(kPause_s);
  e.placed = e.lift_off + std::max<std::size_t>(4, frames(duration_s));
  e.release = e.placed + frames(kPause_s);
  e.end = e.release + frames(kAfter_s);
  return e;
}

/// Scaled time of the hands: 0 until lift-off, 1 from placed on.
double path_time(const Events& e, std::size_t frame) {
  const double t =
      (static_cast<double>(frame) - static_cast<double>(e.lift_off)) / static_cast<double>(e.placed - e.lift_off);
  return std::clamp(t, 0.0, 1.0);
}

/// Scaled time of the posture: the body gathers way while the hands still grip and settles while they let go, so that
/// it neither starts nor stops with a jerk. Constant speed between two ramps.
double posture_time(const Events& e, std::size_t frame) {
  const double whole = static_cast<double>(e.release - e.grasp);
  const double ramp =
      static_cast<double>(e.lift_off - e.grasp) + kAnticipation * static_cast<double>(e.placed - e.lift_off);
  const double speed = 1.0 / (whole - ramp);
  const double t = std::clamp(static_cast<double>(frame) - static_cast<double>(e.grasp), 0.0, whole);
  if (t < ramp) return 0.5 * speed * t * t / ramp;
  if (t > whole - ramp) return 1.0 - 0.5 * speed * (whole - t) * (whole - t) / ramp;
  return speed * (t - 0.5 * ramp);
}

BoxPose box_at(const Task& task, const EndpointPath& path, double t) {
  const double whole_turn = std::remainder(task.target_yaw_rad - task.home_yaw_rad, 2.0 * kPi);
  return {point_at(path, task.home, task.target, t), task.home_yaw_rad + progress(path, t) * whole_turn};
}

/// The box frame by frame; reports how far its path was raised over the edges of what it stands on.
std::vector<BoxPose> box_path(const Task& task, const EndpointPath& path, const Events& e, double& raised_m) {
  std::vector<BoxPose> poses;
  for (std::size_t frame = 0; frame <= e.end; ++frame) poses.push_back(box_at(task, path, path_time(e, frame)));
  raised_m = clear_edges(std::span(poses).subspan(e.lift_off, e.placed - e.lift_off + 1), task.object);
  return poses;
}

/// 0 before `first`, 1 after `last`, from rest to rest between.
double eased(std::size_t first, std::size_t last, std::size_t frame) {
  const double t = (static_cast<double>(frame) - static_cast<double>(first)) / static_cast<double>(last - first);
  const double clamped = std::clamp(t, 0.0, 1.0);
  return clamped * clamped * (3.0 - 2.0 * clamped);
}

/// The hands take the weight between grasp and lift-off and give it up between placed and release.
Load load_at(const Box& box, const BoxPose& pose, const Events& e, std::size_t frame) {
  const double share = eased(e.grasp, e.lift_off, frame) - eased(e.placed, e.release, frame);
  return {pose.position + Vec3(0, 0, 0.5 * box.height_m), share * box.mass_kg};
}

Anchors anchors_for(const Body& body, const Box& box, const BoxPose& pose, double opening_m) {
  Anchors anchors = anchors_of(body.posture());
  Box opened = box;
  opened.grip_distance_m += 2.0 * opening_m;
  anchors.grip = {grip_of(opened, pose, true), grip_of(opened, pose, false)};
  return anchors;
}

std::string readable(Joint joint) {
  std::string name(joint_name(joint));
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

[[noreturn]] void fail_out_of_reach(const HoldReport& report, const Events& e, std::size_t frame, const BoxPose& pose) {
  const std::string place = frame <= e.lift_off ? "home" : frame >= e.placed ? "target" : "path of the box";
  fail("the ", place, " at (", std::setprecision(3), pose.position.x + 0.0, ", ", pose.position.y + 0.0, ", ",
       pose.position.z, ") m from the feet is ", std::fixed, std::setprecision(1), 100.0 * report.shortfall_m,
       " cm out of reach from the ", readable(report.shortfall_from));
}

/// Fills in postures and times for the box's path and the schedule that `motion` has. Throws where a box place is out
/// of reach.
void perform(Motion& motion, const Blend& blend, const Box& box, const Subject& subject, const Body& body,
             double frame_rate) {
  const BodyLinkage linkage(two_handed_linkage(), body);
  const Holder holder(two_handed_linkage(), body, body_mass(subject));
  const auto posture_at = [&](std::size_t frame, double opening_m, HoldReport& report) {
    const BoxPose& pose = motion.box[frame];
    const Anchors anchors = anchors_for(body, box, pose, opening_m);
    const Decoded decoded = linkage.decode(coordinates_at(blend, posture_time(motion.events, frame)), anchors);
    return holder.hold(decoded, anchors, load_at(box, pose, motion.events, frame), report);
  };
  HoldReport opened;
  (void)posture_at(motion.events.end, kOpening_m, opened);
  const double opening_m = opened.shortfall_m > 0.0 ? 0.0 : kOpening_m;  // hands at the end of their reach stay
  Correction trunk{"trunk", 0.0, 0.0, 0};
  std::optional<std::pair<std::size_t, HoldReport>> worst;
  for (std::size_t frame = 0; frame <= motion.events.end; ++frame) {
    HoldReport report;
    motion.postures.push_back(
        posture_at(frame, opening_m * eased(motion.events.release, motion.events.end, frame), report));
    if (report.shortfall_m > 0.0 && (!worst || report.shortfall_m > worst->second.shortfall_m)) worst = {frame, report};
    trunk.amount_m = std::max(trunk.amount_m, report.trunk_shift_m);
    trunk.amount_rad = std::max(trunk.amount_rad, report.trunk_turn_rad);
    trunk.frames += report.trunk_shift_m > 1e-3 ? 1 : 0;
    motion.times_s.push_back(static_cast<double>(frame) / frame_rate);
  }
  if (worst) fail_out_of_reach(worst->second, motion.events, worst->first, motion.box[worst->first]);
  if (trunk.frames > 0) motion.corrections.push_back(trunk);
}

}  // namespace

Motion predict_transfer(const Corpus& corpus, const Subject& subject, const Task& task, const Body& body,
                        const PredictOptions& options) {
  check(task);
  check(subject, options);
  const Query query{Phase::transfer, hold_point(task.object, task.home), hold_point(task.object, task.target),
                    subject.stature_m};
  if (glm::distance(query.home, query.target) < 0.01) {
    fail("home and target are ", glm::distance(query.home, query.target),
         " m apart; they must be at least 0.01 m apart");
  }
  const std::vector<MotionSummary> summaries = corpus.summaries();
  if (summaries.empty()) fail("the corpus ", corpus.path().string(), " holds no motions; import some first");
  Motion motion;
  motion.outside_data = why_outside(summaries, query);
  const Blend blend = blend_neighbours(summaries, query, options.neighbours,
                                       [&](std::int64_t id) { return corpus.load(std::span(&id, 1)).front().code; });
  motion.neighbours = blend.neighbours;
  motion.duration_s = options.duration_s.value_or(blend.whole.duration_s);
  motion.events = schedule(motion.duration_s, options.frame_rate);
  double raised_m = 0.0;
  motion.box = box_path(task, path_of(blend.whole), motion.events, raised_m);
  if (raised_m > 1e-3)
    motion.corrections.push_back({"edge", raised_m, 0.0, motion.events.placed - motion.events.lift_off - 1});
  perform(motion, blend, task.object, subject, body, options.frame_rate);
  return motion;
}

}  // namespace reachcast
