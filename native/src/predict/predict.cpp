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
#include "reachcast/predict/stance_track.hpp"

namespace reachcast {
namespace {

constexpr double kPause_s = 0.25;       // hands on the box before it leaves and after it stands
constexpr double kAfter_s = 0.4;        // letting go
constexpr double kMoment_s = 0.04;      // between the moments at which the trunk's correction is found
constexpr double kUnbalanced_m = 0.02;  // weight this far beyond the feet is reported
constexpr double kOpening_m = 0.03;     // how far each hand leaves the box
constexpr double kAnticipation = 0.2;   // share of the transfer over which the body gets going and comes to rest
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
  return subject.mass_kg.value_or(usual_mass_kg(subject.stature_m));
}

Vec3 hold_point(const Box& box, const Vec3& place) {
  return place + Vec3(0, 0, box.handle_height_m);
}

/// `recorded` holds at least one motion.
std::vector<std::string> why_outside(const PhaseColumns& recorded, const Query& query) {
  double target = 1e9, home = 1e9;
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    target = std::min(target, glm::distance(recorded.target[i], query.target));
    home = std::min(home, glm::distance(recorded.home[i], query.home));
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
  const std::vector<double>& statures = recorded.all.by(Trait::stature);
  const double shortest = statures.front(), tallest = statures.back();
  if (query.subject.stature_m < shortest - kStatureMargin_m || query.subject.stature_m > tallest + kStatureMargin_m) {
    add("stature ", query.subject.stature_m, " m lies outside the recorded ", shortest, " to ", tallest, " m");
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

/// 0 before `first`, 1 after `last`, evenly between. Moments are frame numbers with fractions.
double share_between(std::size_t first, std::size_t last, double moment) {
  return std::clamp((moment - static_cast<double>(first)) / static_cast<double>(last - first), 0.0, 1.0);
}

/// The same from rest to rest.
double eased(std::size_t first, std::size_t last, double moment) {
  const double t = share_between(first, last, moment);
  return t * t * (3.0 - 2.0 * t);
}

/// Scaled time of the posture: the body gathers way while the hands still grip and settles while they let go, so that
/// it neither starts nor stops with a jerk. Constant speed between two ramps.
double posture_time(const Events& e, double moment) {
  const double whole = static_cast<double>(e.release - e.grasp);
  const double ramp =
      static_cast<double>(e.lift_off - e.grasp) + kAnticipation * static_cast<double>(e.placed - e.lift_off);
  const double speed = 1.0 / (whole - ramp);
  const double t = whole * share_between(e.grasp, e.release, moment);
  if (t < ramp) return 0.5 * speed * t * t / ramp;
  if (t > whole - ramp) return 1.0 - 0.5 * speed * (whole - t) * (whole - t) / ramp;
  return speed * (t - 0.5 * ramp);
}

/// Everything that a performance needs to know of a moment, also between frames.
class Performance {
 public:
  Performance(const Blend& blend, const Task& task, const Body& body, double body_mass_kg, const Events& events,
              bool raised)
      : blend_(blend),
        task_(task),
        body_(body),
        events_(events),
        path_(path_of(blend.whole)),
        linkage_(two_handed_linkage(), body),
        holder_(two_handed_linkage(), body, body_mass_kg) {
    if (raised)
      clearance_ = EdgeClearance([&](double t) { return point_at(path_, task.home, task.target, t); }, task.object);
  }

  [[nodiscard]] double raised_m() const { return clearance_.largest_m(); }

  [[nodiscard]] BoxPose box(double moment) const {
    const double t = share_between(events_.lift_off, events_.placed, moment);
    const double whole_turn = std::remainder(task_.target_yaw_rad - task_.home_yaw_rad, 2.0 * kPi);
    return {point_at(path_, task_.home, task_.target, t) + Vec3(0, 0, clearance_.rise_m(t)),
            task_.home_yaw_rad + progress(path_, t) * whole_turn};
  }

  /// The correction of the trunk, found at moments that do not depend on the frame rate. The hands' opening after the
  /// release is left out: it moves no trunk that can help it.
  [[nodiscard]] StanceTrack track(double frame_rate) const {
    const double whole_s = static_cast<double>(events_.end) / frame_rate;
    const auto count = static_cast<std::size_t>(std::clamp(std::ceil(whole_s / kMoment_s), 8.0, 2000.0)) + 1;
    const double spacing_s = whole_s / static_cast<double>(count - 1);
    std::vector<Stance> moments;
    for (std::size_t i = 0; i < count; ++i) {
      const double moment = static_cast<double>(i) * spacing_s * frame_rate;
      const Anchors anchors = anchors_at(moment, 0.0);
      moments.push_back(holder_.settle(decoded_at(moment, anchors), anchors, load_at(moment)));
    }
    return {moments, spacing_s};
  }

  [[nodiscard]] Posture posture(double moment, const Stance& stance, double opening_m, HoldReport& report) const {
    const Anchors anchors = anchors_at(moment, opening_m * eased(events_.release, events_.end, moment));
    return holder_.hold(decoded_at(moment, anchors), stance, anchors, load_at(moment), report);
  }

 private:
  [[nodiscard]] Decoded decoded_at(double moment, const Anchors& anchors) const {
    return linkage_.decode(coordinates_at(blend_, posture_time(events_, moment)), anchors);
  }

  [[nodiscard]] Anchors anchors_at(double moment, double opening_m) const {
    Anchors anchors = anchors_of(body_.posture());
    Box opened = task_.object;
    opened.grip_distance_m += 2.0 * opening_m;
    const BoxPose pose = box(moment);
    anchors.grip = {grip_of(opened, pose, true), grip_of(opened, pose, false)};
    return anchors;
  }

  /// The hands take the weight between grasp and lift-off and give it up between placed and release.
  [[nodiscard]] Load load_at(double moment) const {
    const double share =
        eased(events_.grasp, events_.lift_off, moment) - eased(events_.placed, events_.release, moment);
    return {box(moment).position + Vec3(0, 0, 0.5 * task_.object.height_m), share * task_.object.mass_kg};
  }

  const Blend& blend_;
  const Task& task_;
  const Body& body_;
  const Events& events_;
  EndpointPath path_;
  EdgeClearance clearance_;
  BodyLinkage linkage_;
  Holder holder_;
};

std::string readable(Joint joint) {
  std::string name(joint_name(joint));
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

[[noreturn]] void fail_out_of_reach(const HoldReport& report, const Events& e, std::size_t frame, const BoxPose& pose) {
  const std::string place = frame <= e.lift_off ? "home" : frame >= e.placed ? "target" : "path of the box";
  fail("the ", place, " at (", std::setprecision(3), pose.position.x + 0.0, ", ", pose.position.y + 0.0, ", ",
       pose.position.z, ") m from the feet is ", std::fixed, std::setprecision(1),
       std::max(0.1, 100.0 * report.shortfall_m), " cm out of reach from the ", readable(report.shortfall_from));
}

/// What could not be held, and when.
struct Failure {
  std::size_t frame = 0;
  HoldReport report;
};

bool is_at_an_end(const Events& e, const Failure& failure) {
  return failure.frame <= e.lift_off || failure.frame >= e.placed;
}

/// A home or a target that cannot be held comes before the way between them.
bool is_worse(const Events& e, const Failure& a, const Failure& b) {
  if (is_at_an_end(e, a) != is_at_an_end(e, b)) return is_at_an_end(e, a);
  return a.report.shortfall_m > b.report.shortfall_m;
}

/// Fills in box, postures, times and corrections. Returns the worst failure, if any.
std::optional<Failure> perform(const Performance& performance, double frame_rate, Motion& motion) {
  motion.box.clear();
  motion.postures.clear();
  motion.times_s.clear();
  const StanceTrack track = performance.track(frame_rate);
  const auto end_s = static_cast<double>(motion.events.end) / frame_rate;
  HoldReport opened;
  (void)performance.posture(static_cast<double>(motion.events.end), track.at(end_s), kOpening_m, opened);
  const double opening_m = opened.shortfall_m > 0.0 ? 0.0 : kOpening_m;  // hands at the end of their reach stay
  Correction trunk{"trunk", 0.0, 0.0, 0}, unbalanced{"unbalanced", 0.0, 0.0, 0};
  std::optional<Failure> worst;
  for (std::size_t frame = 0; frame <= motion.events.end; ++frame) {
    const auto moment = static_cast<double>(frame);
    HoldReport report;
    motion.times_s.push_back(moment / frame_rate);
    motion.box.push_back(performance.box(moment));
    motion.postures.push_back(performance.posture(moment, track.at(motion.times_s.back()), opening_m, report));
    if (report.shortfall_m > 0.0 && (!worst || is_worse(motion.events, {frame, report}, *worst)))
      worst = Failure{frame, report};
    trunk.amount_m = std::max(trunk.amount_m, report.trunk_shift_m);
    trunk.amount_rad = std::max(trunk.amount_rad, report.trunk_turn_rad);
    trunk.frames += report.trunk_shift_m > 1e-3 ? 1 : 0;
    unbalanced.amount_m = std::max(unbalanced.amount_m, report.unbalanced_m);
    unbalanced.frames += report.unbalanced_m > kUnbalanced_m ? 1 : 0;
  }
  motion.corrections.clear();
  if (performance.raised_m() > 1e-3) {
    motion.corrections.push_back(
        {"edge", performance.raised_m(), 0.0, motion.events.placed - motion.events.lift_off - 1});
  }
  if (trunk.frames > 0) motion.corrections.push_back(trunk);
  if (unbalanced.frames > 0) motion.corrections.push_back(unbalanced);
  return worst;
}

}  // namespace

Motion predict_transfer(const Corpus& corpus, const Subject& subject, const Task& task, const Body& body,
                        const PredictOptions& options) {
  check(task);
  check(subject, options);
  const Query query{Phase::transfer, hold_point(task.object, task.home), hold_point(task.object, task.target), subject,
                    options.duration_s};
  for (const auto& [name, place] : {std::pair{"home", task.home}, {"target", task.target}}) {
    if (place.z < subject.stature_m && std::hypot(place.x, place.y) < 0.5 * task.object.depth_m) {
      fail("the ", name, " is ", std::hypot(place.x, place.y),
           " m from between the feet, inside the body; it must be at least ", 0.5 * task.object.depth_m,
           " m away, half the depth of the box");
    }
  }
  if (glm::distance(query.home, query.target) < 0.01) {
    fail("home and target are ", glm::distance(query.home, query.target),
         " m apart; they must be at least 0.01 m apart");
  }
  const std::shared_ptr<const MotionTable> table = corpus.table();
  if (table->motions().empty()) fail("the corpus ", corpus.path().string(), " holds no motions; import some first");
  Motion motion;
  const Blend blend = blend_neighbours(*table, query, options.scheme, [&](std::int64_t id) { return corpus.code(id); });
  motion.outside_data = why_outside(table->of(query.phase), query);
  motion.neighbours = blend.neighbours;
  if (!(blend.whole.duration_s >= 0.05 && blend.whole.duration_s <= 60.0)) {
    fail("the neighbours take ", blend.whole.duration_s, " s; a transfer takes 0.05 to 60 s");
  }
  motion.events = schedule(options.duration_s.value_or(blend.whole.duration_s), options.frame_rate);
  motion.duration_s = static_cast<double>(motion.events.placed - motion.events.lift_off) / options.frame_rate;
  // Raising the path over an edge is a courtesy: a path that can only be held as it was learned stays as it was.
  std::optional<Failure> failure;
  for (const bool raised : {true, false}) {
    const Performance performance(blend, task, body, body_mass(subject), motion.events, raised);
    failure = perform(performance, options.frame_rate, motion);
    if (!failure || is_at_an_end(motion.events, *failure)) break;
  }
  if (failure) fail_out_of_reach(failure->report, motion.events, failure->frame, motion.box[failure->frame]);
  return motion;
}

}  // namespace reachcast
