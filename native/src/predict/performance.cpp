// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/performance.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <stdexcept>

#include "reachcast/motion/encode.hpp"
#include "reachcast/posture/linkage.hpp"
#include "reachcast/posture/twist.hpp"
#include "reachcast/predict/stand.hpp"

namespace reachcast {
namespace {

constexpr double kMoment_s = 0.04;  // between the moments at which the trunk's correction is found
constexpr int kCompletions = 8;
constexpr double kBold = 1.3;     // of what is lacking is added, since smoothing lowers its peaks
constexpr double kTrunk_m = 0.5;  // how long the trunk is, to see a turn as a distance
constexpr double kUnseen_m = 1e-3;
constexpr double kOpening_m = 0.03;       // how far each hand keeps from the sides of what it leaves or comes to
constexpr double kClosed = 0.15;          // share of an empty hand's way over which it opens, next to the object
constexpr double kPast = 0.8;             // and by which the opening has gone
constexpr double kMostBoxTurn_rad = 0.5;  // that recorded hands may add to a box's turn on its way

constexpr int kLooks = 64;          // along a way, for obstacles
constexpr double kTouch_m = 0.004;  // what stands on a surface may seem to lie in it by so much
constexpr double kNear_m = 0.10;    // of its place, where the clearance shrinks to nothing
constexpr double kHand_m = 0.09;    // a closed hand

double heading(const Vec3& v) {
  return std::atan2(v.y, v.x);
}

double smooth(double t) {
  return eased(0.0, 1.0, t);
}

}  // namespace

Vec3 hold_point(const Grips& grips) {
  return 0.5 * (grips[0] + grips[1]);
}

Grips grips_on(const Task& task, Place place) {
  const BoxPose pose =
      place == Place::home ? BoxPose{task.home, task.home_yaw_rad} : BoxPose{task.target, task.target_yaw_rad};
  return {grip_of(task.object, pose, true), grip_of(task.object, pose, false)};
}

HandEnds hand_ends(const Stage& stage, const Task& task, const Body& body) {
  const Grips here = grips_on(task, stage.object);
  const Grips hanging = anchors_of(standing_at_ease(body)).grip;
  if (stage.phase == Phase::reach) return {hanging, here};
  if (stage.phase == Phase::return_) return {here, hanging};
  return {here, grips_on(task, other(stage.object))};
}

Performance::Performance(const Plan& plan, const std::vector<Blend>& blends, const Task& task, const Body& body,
                         double body_mass_kg, double frame_rate)
    : plan_(plan),
      task_(task),
      body_(body),
      frame_rate_(frame_rate),
      stand_(anchors_of(body.posture())),
      between_ankles_(0.5 * (stand_.ankle[0] + stand_.ankle[1])),
      linkage_(two_handed_linkage(), body),
      holder_(two_handed_linkage(), body, body_mass_kg) {
  for (std::size_t i = 0; i < plan.stages.size(); ++i) {
    const Stage& stage = plan.stages[i];
    acts_.push_back({&stage, &blends[i], hand_ends(stage, task, body), path_of(blends[i].whole), {}, {}, 0.0, {}, {}});
  }
  for (std::size_t i = 0; i < acts_.size(); ++i) join(i);
  find_openings();
}

/// Hands that cannot keep clear of the object because they are at the end of their reach stay close.
void Performance::find_openings() {
  for (Act& act : acts_) {
    if (!is_loaded(act.stage->phase)) act.opening_m = opening_of(act);
  }
  last_opening_m_ = kOpening_m;
  if (is_loaded(acts_.back().stage->phase) && report_at(static_cast<double>(plan_.end)).shortfall_m > 0.0) {
    last_opening_m_ = 0.0;
  }
}

void Performance::raise_over_edges() {
  for (Act& act : acts_) {
    if (!is_loaded(act.stage->phase)) continue;
    const Vec3 from = place_pose(act.stage->object).position, to = place_pose(other(act.stage->object)).position;
    act.clearance = EdgeClearance([&](double t) { return point_at(act.path, from, to, t); }, task_.object);
  }
}

std::vector<std::size_t> Performance::go_round(const Obstacles& obstacles, double clearance_m,
                                               const std::vector<std::size_t>& first_shapes) {
  for (const Act& act : acts_) {
    require_free_place(act.stage->object, obstacles);
    if (is_loaded(act.stage->phase)) require_free_place(other(act.stage->object), obstacles);
  }
  std::vector<std::size_t> taken = first_shapes;
  for (std::size_t i = 0; i < acts_.size(); ++i) {
    for (;; ++taken[i]) {
      if (taken[i] == path_shapes().size()) {
        throw std::invalid_argument("no way past the obstacles was found for the " +
                                    std::string(is_loaded(acts_[i].stage->phase) ? "box" : "hands") + " in phase " +
                                    std::string(phase_name(acts_[i].stage->phase)));
      }
      acts_[i].shape = path_shapes()[taken[i]];
      if (is_free(acts_[i], obstacles, clearance_m)) break;
    }
  }
  return taken;
}

void Performance::require_free_place(Place place, const Obstacles& obstacles) const {
  const Box& box = task_.object;
  const BoxPose pose = place_pose(place);
  const Vec3 size = Vec3(box.width_m, box.depth_m, box.height_m) - 2.0 * kTouch_m;
  if (!obstacles.meet({pose.position + Vec3(0, 0, 0.5 * box.height_m), glm::max(size, 0.001), pose.yaw_rad})) return;
  throw std::invalid_argument(std::string("the box would stand in an obstacle at the ") +
                              (place == Place::home ? "home" : "target") + ", by more than " +
                              std::to_string(std::lround(1000.0 * kTouch_m)) + " mm");
}

bool Performance::is_free(const Act& act, const Obstacles& obstacles, double clearance_m) const {
  const Box& box = task_.object;
  const bool loaded = is_loaded(act.stage->phase);
  const Vec3 first = hold_point(act.hands.first), last = hold_point(act.hands.last);
  for (int i = 1; i < kLooks; ++i) {
    const double t = static_cast<double>(i) / kLooks;
    const BoxPose pose = loaded ? carried_object(act, t) : BoxPose{};
    const Grips grips = loaded ? Grips{grip_of(box, pose, true), grip_of(box, pose, false)} : empty_grips(act, t);
    const Vec3 hold = hold_point(grips);
    const double away = std::min(glm::distance(hold, first), glm::distance(hold, last));
    const double keep = 2.0 * (clearance_m * std::min(1.0, away / kNear_m) - kTouch_m);
    const auto meets = [&](const Vec3& centre, const Vec3& size) {
      return obstacles.meet({centre, glm::max(size + keep, 0.001), pose.yaw_rad});
    };
    if (loaded && meets(pose.position + Vec3(0, 0, 0.5 * box.height_m), {box.width_m, box.depth_m, box.height_m}))
      return false;
    if (away > kNear_m && (meets(grips[0], Vec3(kHand_m)) || meets(grips[1], Vec3(kHand_m)))) return false;
  }
  return true;
}

Vec3 Performance::towards_person(const Vec3& from, const Vec3& to) const {
  const Vec3 middle = 0.5 * (from + to);
  const Vec3 level(between_ankles_.x - middle.x, between_ankles_.y - middle.y, 0.0);
  return glm::length(level) > 1e-6 ? glm::normalize(level) : Vec3(0, -1, 0);
}

Vec3 Performance::way(const Act& act, const Vec3& from, const Vec3& to, double t) const {
  return shaped_point_at(act.path, from, to, act.shape, towards_person(from, to), t);
}

double Performance::bent_m() const {
  double most = 0.0;
  for (const Act& act : acts_) {
    const Vec3 from = hold_point(act.hands.first), to = hold_point(act.hands.last);
    most = std::max(most, bend_of(act.path, from, to, act.shape, towards_person(from, to)));
  }
  return most;
}

/// Coordinates where two stages meet are the mean of where the one ends and the other begins; where the hands hang they
/// are those of this body standing at ease.
void Performance::join(std::size_t i) {
  const auto between = [&](const Blend& before, const Blend& after) {
    return Eigen::VectorXd(0.5 * (coordinates_at(before, 1.0) + coordinates_at(after, 0.0)));
  };
  const auto at_ease = [&] { return encode_posture(two_handed_linkage(), standing_at_ease(body_)); };
  Act& act = acts_[i];
  const Eigen::VectorXd first = coordinates_at(*act.blend, 0.0), last = coordinates_at(*act.blend, 1.0);
  act.first_shift = act.last_shift = Eigen::VectorXd::Zero(first.size());
  if (act.stage->phase == Phase::reach) {
    act.first_shift = at_ease() - first;
  } else if (i > 0) {
    act.first_shift = between(*acts_[i - 1].blend, *act.blend) - first;
  }
  if (act.stage->phase == Phase::return_) {
    act.last_shift = at_ease() - last;
  } else if (i + 1 < acts_.size()) {
    act.last_shift = between(*act.blend, *acts_[i + 1].blend) - last;
  }
}

/// Hands that cannot go round the object's corners because they are at the end of their reach go straight.
double Performance::opening_of(const Act& act) const {
  Act open = act;
  open.opening_m = kOpening_m;
  for (const double t : {0.5 * kClosed, kClosed, 0.5 * (kClosed + kPast)}) {
    const double at = act.stage->phase == Phase::return_ ? t : 1.0 - t;
    const auto first = static_cast<double>(act.stage->first), last = static_cast<double>(act.stage->last);
    const double moment = first + at * (last - first);
    const Anchors reached = anchors(empty_grips(open, at));
    HoldReport report;
    (void)holder_.hold(decoded(moment, reached), reached, load(moment), report);
    if (report.shortfall_m > 0.0) return 0.0;
  }
  return kOpening_m;
}

double Performance::raised_m() const {
  double most = 0.0;
  for (const Act& act : acts_) most = std::max(most, act.clearance.largest_m());
  return most;
}

const Performance::Act& Performance::hands_act(double moment) const {
  std::size_t i = acts_.size() - 1;
  while (i > 0 && static_cast<double>(acts_[i].stage->first) > moment) --i;
  return acts_[i];
}

const Performance::Act& Performance::body_act(double moment) const {
  std::size_t i = 0;
  while (i + 1 < acts_.size() && acts_[i].stage->body_last < moment) ++i;
  return acts_[i];
}

double Performance::time_in(const Act& act, double moment) const {
  const auto first = static_cast<double>(act.stage->first), last = static_cast<double>(act.stage->last);
  return std::clamp((moment - first) / (last - first), 0.0, 1.0);
}

BoxPose Performance::place_pose(Place place) const {
  return place == Place::home ? BoxPose{task_.home, task_.home_yaw_rad} : BoxPose{task_.target, task_.target_yaw_rad};
}

BoxPose Performance::object(double moment) const {
  const Act& act = hands_act(moment);
  return is_loaded(act.stage->phase) ? carried_object(act, time_in(act, moment)) : place_pose(act.stage->object);
}

/// The box turns with the person who carries it, from its turn at the one place to its turn at the other, and as much
/// more as recorded hands have turned on their way.
BoxPose Performance::carried_object(const Act& act, double t) const {
  const BoxPose from = place_pose(act.stage->object), to = place_pose(other(act.stage->object));
  const Vec3 up(0.0, 0.0, task_.object.handle_height_m);
  const Vec3 position = way(act, from.position, to.position, t) + Vec3(0, 0, act.clearance.rise_m(t));
  const auto facing = [&](const Vec3& place) { return facing_yaw(between_ankles_, place + up); };
  const double first = from.yaw_rad - facing(from.position);
  const double more = std::remainder(to.yaw_rad - facing(to.position) - first, 2.0 * kPi);
  const double share = progress(act.path, t);
  const auto recorded = [&](double at) { return heading(separation_at(act.blend->whole, at)); };
  const double begun = recorded(0.0), whole = std::remainder(recorded(1.0) - begun, 2.0 * kPi);
  const double turn = std::remainder(recorded(t) - begun - share * whole, 2.0 * kPi);
  return {position, facing(position) + first + share * more + std::clamp(turn, -kMostBoxTurn_rad, kMostBoxTurn_rad)};
}

/// The hold point goes along its path; the hands part from it as recorded, made to fit at both ends (2004, p. 549: the
/// hand that is empty has a trajectory of its own).
Grips Performance::empty_grips(const Act& act, double t) const {
  const Vec3 from = hold_point(act.hands.first), to = hold_point(act.hands.last);
  const Vec3 hold = way(act, from, to, t);
  const auto recorded = [&](double at, const Vec3& held) {
    return turned(body_.stature_m() * separation_at(act.blend->whole, at), facing_yaw(between_ankles_, held));
  };
  const Vec3 first = 0.5 * (act.hands.first[1] - act.hands.first[0]),
             last = 0.5 * (act.hands.last[1] - act.hands.last[0]);
  const double share = smooth(t);
  Vec3 half = recorded(t, hold) + (1.0 - share) * (first - recorded(0.0, from)) + share * (last - recorded(1.0, to));
  const double away = act.stage->phase == Phase::return_ ? t : 1.0 - t;
  const double opening = act.opening_m * eased(0.0, kClosed, away) * (1.0 - eased(kClosed, kPast, away));
  if (const double size = glm::length(half); size > 1e-9) half *= 1.0 + opening / size;
  return {hold - half, hold + half};
}

Grips Performance::grips_of_act(const Act& act, double moment) const {
  const double t = time_in(act, moment);
  if (!is_loaded(act.stage->phase)) return empty_grips(act, t);
  Box held = task_.object;
  const bool is_last = &act == &acts_.back();
  if (is_last) {
    const double share = eased(act.stage->body_last, static_cast<double>(plan_.end), moment);
    held.grip_distance_m += 2.0 * last_opening_m_ * share;
  }
  const BoxPose pose = carried_object(act, t);
  return {grip_of(held, pose, true), grip_of(held, pose, false)};
}

Grips Performance::grips(double moment) const {
  return grips_of_act(hands_act(moment), moment);
}

Performance::Tracks Performance::tracks() const {
  const double whole_s = static_cast<double>(plan_.end) / frame_rate_;
  const auto count = static_cast<std::size_t>(std::clamp(std::ceil(whole_s / kMoment_s), 8.0, 5000.0)) + 1;
  const double spacing_s = whole_s / static_cast<double>(count - 1);
  std::vector<Anchors> ends;
  std::vector<Decoded> learned;
  std::vector<Stance> stances;
  for (std::size_t i = 0; i < count; ++i) {
    // The hands' opening after the last release is left out: it moves no trunk that can help it.
    const double moment = static_cast<double>(i) * spacing_s * frame_rate_;
    const double held = is_loaded(acts_.back().stage->phase) ? std::min(moment, acts_.back().stage->body_last) : moment;
    ends.push_back(anchors(grips(held)));
    learned.push_back(decoded(moment, ends.back()));
    stances.push_back(holder_.settle(learned.back(), ends.back(), load(moment)));
  }
  Tracks tracks{{two_handed_linkage(), body_, learned, spacing_s}, {stances, spacing_s}};
  for (std::size_t i = 0; i < count; ++i) learned[i] = tracks.learned.at(static_cast<double>(i) * spacing_s);
  // Smoothing takes some limbs out of their reach again. What that lacks is smoothed and added in its turn, until too
  // little is left to be seen as a jerk when `hold` makes it up.
  for (int round = 0; round < kCompletions; ++round) {
    double most = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const Stance now = tracks.stance.at(static_cast<double>(i) * spacing_s);
      const Stance whole = holder_.completed(learned[i], now, ends[i]);
      stances[i] = {kBold * (whole.shift - now.shift), kBold * (whole.turn_rad - now.turn_rad), {}};
      most = std::max(most, glm::length(stances[i].shift) + kTrunk_m * glm::length(stances[i].turn_rad));
    }
    if (most < kUnseen_m) break;
    tracks.stance.add(stances);
  }
  return tracks;
}

Posture Performance::posture(double moment, const Tracks& tracks, HoldReport& report) const {
  const double time_s = moment / frame_rate_;
  return holder_.hold(tracks.learned.at(time_s), tracks.stance.at(time_s), anchors(grips(moment)), load(moment),
                      report);
}

HoldReport Performance::report_at(double moment) const {
  const Anchors at = anchors(grips(moment));
  HoldReport report;
  (void)holder_.hold(decoded(moment, at), at, load(moment), report);
  return report;
}

Anchors Performance::anchors(const Grips& grips) const {
  Anchors out = stand_;
  out.grip = grips;
  return out;
}

Decoded Performance::decoded(double moment, const Anchors& anchors) const {
  const Act& act = body_act(moment);
  const double t = posture_time(*act.stage, moment), share = smooth(t);
  const Eigen::VectorXd coordinates =
      coordinates_at(*act.blend, t) + (1.0 - share) * act.first_shift + share * act.last_shift;
  return linkage_.decode(coordinates, anchors);
}

Load Performance::load(double moment) const {
  const Vec3 middle(0, 0, 0.5 * task_.object.height_m);
  return {object(moment).position + middle, load_share(plan_, frame_rate_, moment) * task_.object.mass_kg};
}

}  // namespace reachcast
