// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/performance.hpp"

#include <algorithm>
#include <cmath>

#include "reachcast/motion/encode.hpp"
#include "reachcast/posture/linkage.hpp"
#include "reachcast/posture/twist.hpp"
#include "reachcast/predict/body_curves.hpp"
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

double heading(const Vec3& v) {
  return std::atan2(v.y, v.x);
}

double smooth(double t) {
  return eased(0.0, 1.0, t);
}

}  // namespace

Performance::Performance(const Plan& plan, const std::vector<Blend>& blends, const std::vector<StageWay>& ways,
                         const Task& task, const Body& body, double body_mass_kg, double frame_rate)
    : plan_(plan),
      task_(task),
      body_(body),
      frame_rate_(frame_rate),
      stand_(anchors_of(body.posture())),
      between_ankles_(0.5 * (stand_.ankle[0] + stand_.ankle[1])),
      linkage_(two_handed_linkage(), body),
      holder_(two_handed_linkage(), body, body_mass_kg),
      ways_(ways) {
  task_.object = held_by(task.object, task.hands);
  for (std::size_t i = 0; i < plan.stages.size(); ++i) acts_.push_back(act_of(plan.stages[i], blends[i], ways[i]));
  for (std::size_t i = 0; i < acts_.size(); ++i) join(i);
  join_poses();
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

Performance::Act Performance::act_of(const Stage& stage, const Blend& blend, const StageWay& way) const {
  Act act{.stage = &stage,
          .blend = &blend,
          .hands = hand_ends(stage, task_, body_),
          .way = way,
          .from = place_pose(stage.object),
          .to = place_pose(other(stage.object)),
          .turning = {},
          .clearance = {},
          .shape = {},
          .is_bent = false,
          .half_first = Vec3(0.0),
          .half_last = Vec3(0.0),
          .opening_m = 0.0,
          .curves_from = body_curves(blend.from),
          .curves_to = body_curves(blend.to),
          .poses = PoseMean(blend)};
  if (is_loaded(stage.phase)) {
    act.turning = turning_of(act);
    return act;
  }
  const auto half = [](const Grips& grips) { return 0.5 * (grips[1] - grips[0]); };
  act.half_first = half(act.hands.first) - recorded_half(act, 0.0, hold_point(act.hands.first));
  act.half_last = half(act.hands.last) - recorded_half(act, 1.0, hold_point(act.hands.last));
  return act;
}

/// Coordinates where two stages meet are the mean of where the one ends and the other begins; where the hands hang they
/// are those of this body standing at ease. Basis functions add up to 1, so that to shift all control points is to
/// shift the curve.
void Performance::join(std::size_t i) {
  Act& act = acts_[i];
  const auto at_ease = [&] { return body_coordinates(standing_at_ease(body_), task_.hands); };
  if (act.stage->phase == Phase::reach) {
    const Eigen::VectorXd gap = at_ease() - act.curves_from.col(0);
    act.curves_from.colwise() += gap;
  } else if (i > 0) {
    Act& before = acts_[i - 1];
    const Eigen::VectorXd gap = act.curves_from.col(0) - before.curves_to.col(kBasisCount - 1);
    before.curves_to.colwise() += 0.5 * gap;
    act.curves_from.colwise() -= 0.5 * gap;
  }
  if (act.stage->phase == Phase::return_) {
    const Eigen::VectorXd gap = at_ease() - act.curves_to.col(kBasisCount - 1);
    act.curves_to.colwise() += gap;
  }
}

TrunkPose Performance::mean_pose(const Act& act, double moment) const {
  return act.poses.at(posture_time(*act.stage, moment), anchors(moment, grips(moment)), two_handed_linkage(), linkage_,
                      body_);
}

/// The same for means of poses: where two stages meet both have the pose that the joined coordinates give, which is
/// also what a stage without poses has there; so the mean of poses lacks nothing where it begins and ends by itself.
void Performance::join_poses() {
  for (std::size_t i = 0; i < acts_.size(); ++i) {
    Act& act = acts_[i];
    if (!act.poses.exists()) continue;
    const auto lack_at = [&](double moment, bool is_free, const Eigen::VectorXd& joined) {
      const TrunkPose own = mean_pose(act, moment);
      if (is_free) return lack_of(own, own);
      const Decoded wanted = linkage_.decode(joined.head(posture_rows()), anchors(moment, grips(moment)));
      return lack_of(own, trunk_pose_of(two_handed_linkage(), body_, wanted));
    };
    const bool first_free = i == 0 && act.stage->phase != Phase::reach;
    const bool last_free = i + 1 == acts_.size() && act.stage->phase != Phase::return_;
    const TrunkPose first = lack_at(act.stage->body_first, first_free, act.curves_from.col(0)),
                    last = lack_at(act.stage->body_last, last_free, act.curves_to.col(kBasisCount - 1));
    act.poses.meet(first, last);
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
    const Anchors reached = anchors(moment, empty_grips(open, at));
    HoldReport report;
    (void)holder_.hold(decoded(moment, reached), reached, load(moment, object(moment)), report);
    if (report.shortfall_m > 0.0) return 0.0;
  }
  return kOpening_m;
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

Performance::Turning Performance::turning_of(const Act& act) const {
  const Vec3 up(0.0, 0.0, task_.object.handle_height_m);
  const auto against_person = [&](const BoxPose& pose) {
    return pose.yaw_rad - facing_yaw(between_ankles_, pose.position + up, task_.hands);
  };
  Turning out;
  out.first = against_person(act.from);
  out.more = std::remainder(against_person(act.to) - out.first, 2.0 * kPi);
  if (task_.hands != Hands::both) return out;
  out.recorded = heading(separation_at(act.blend->whole, 0.0));
  out.recorded_more = std::remainder(heading(separation_at(act.blend->whole, 1.0)) - out.recorded, 2.0 * kPi);
  return out;
}

/// The box turns with the person who carries it, from its turn at the one place to its turn at the other, and as much
/// more as recorded hands, if there were two, have turned on their way.
BoxPose Performance::carried_object(const Act& act, double t) const {
  const double share = progress(act.way.way, t);
  const Vec3 &from = act.from.position, &to = act.to.position;
  const Vec3 learned = act.shape.is_straight() ? point_at(act.way.way, from, to, t, share) : point_of(act, from, to, t);
  const Vec3 position = learned + Vec3(0, 0, act.clearance.rise_m(t));
  const Turning& turning = act.turning;
  const bool is_known = task_.hands == Hands::both;
  const double recorded = is_known ? heading(separation_at(act.blend->whole, t)) - turning.recorded : 0.0;
  const double turn = std::remainder(recorded - share * turning.recorded_more, 2.0 * kPi);
  const Vec3 hold = position + Vec3(0.0, 0.0, task_.object.handle_height_m);
  const double facing = facing_yaw(between_ankles_, hold, task_.hands);
  return {position,
          facing + turning.first + share * turning.more + std::clamp(turn, -kMostBoxTurn_rad, kMostBoxTurn_rad)};
}

/// Half the way between the hands as recorded, on this body and turned to where it holds; nothing for one hand.
Vec3 Performance::recorded_half(const Act& act, double t, const Vec3& hold) const {
  if (task_.hands != Hands::both) return Vec3(0.0);
  return turned(body_.stature_m() * separation_at(act.blend->whole, t), facing_yaw(between_ankles_, hold));
}

/// The hold point goes along its path; the hands part from it as recorded, made to fit at both ends (2004, p. 549: the
/// hand that is empty has a trajectory of its own).
Grips Performance::empty_grips(const Act& act, double t) const {
  const Vec3 hold = point_of(act, hold_point(act.hands.first), hold_point(act.hands.last), t);
  const double share = smooth(t);
  Vec3 half = recorded_half(act, t, hold) + (1.0 - share) * act.half_first + share * act.half_last;
  const double away = act.stage->phase == Phase::return_ ? t : 1.0 - t;
  const double opening = act.opening_m * eased(0.0, kClosed, away) * (1.0 - eased(kClosed, kPast, away));
  if (const double size = glm::length(half); size > 1e-9) half *= 1.0 + opening / size;
  return {hold - half, hold + half};
}

/// On the object while the hands carry it; they open when the last stage is over.
Grips Performance::grips(double moment, const BoxPose& object) const {
  const Act& act = hands_act(moment);
  if (!is_loaded(act.stage->phase)) return empty_grips(act, time_in(act, moment));
  Box held = task_.object;
  if (&act == &acts_.back() && task_.hands == Hands::both) {
    const double share = eased(act.stage->body_last, static_cast<double>(plan_.end), moment);
    held.grip_distance_m += 2.0 * last_opening_m_ * share;
  }
  return {grip_of(held, object, true), grip_of(held, object, false)};
}

Performance::Tracks Performance::tracks() const {
  const double whole_s = static_cast<double>(plan_.end) / frame_rate_;
  const auto count = static_cast<std::size_t>(std::clamp(std::ceil(whole_s / kMoment_s), 8.0, 5000.0)) + 1;
  const double spacing_s = whole_s / static_cast<double>(count - 1);
  std::vector<Anchors> ends;
  std::vector<Decoded> learned;
  std::vector<Stance> stances;
  ends.reserve(count), learned.reserve(count), stances.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    // The hands' opening after the last release is left out: it moves no trunk that can help it.
    const double moment = static_cast<double>(i) * spacing_s * frame_rate_;
    const double held = is_loaded(acts_.back().stage->phase) ? std::min(moment, acts_.back().stage->body_last) : moment;
    const BoxPose box = object(moment);
    ends.push_back(anchors(moment, grips(held, box)));
    learned.push_back(decoded(moment, ends.back()));
    stances.push_back(holder_.settle(learned.back(), ends.back(), load(moment, box)));
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

Posture Performance::posture(double moment, const BoxPose& object, const Tracks& tracks, HoldReport& report) const {
  const double time_s = moment / frame_rate_;
  return holder_.hold(tracks.learned.at(time_s), tracks.stance.at(time_s), anchors(moment, grips(moment, object)),
                      load(moment, object), report);
}

HoldReport Performance::report_at(double moment) const {
  const Anchors at = anchors(moment, grips(moment));
  HoldReport report;
  (void)holder_.hold(decoded(moment, at), at, load(moment, object(moment)), report);
  return report;
}

Anchors Performance::anchors(double moment, const Grips& grips) const {
  Anchors out = stand_;
  out.grip = grips;
  out.hands = task_.hands;
  if (out.hands == Hands::both) return out;
  const Eigen::Vector3d hang = coordinates(moment).tail<3>();
  out.hang = hang_on(body_, out, {hang[0], hang[1], hang[2]});
  return out;
}

Decoded Performance::decoded(double moment, const Anchors& anchors) const {
  const Act& act = body_act(moment);
  if (act.poses.exists()) {
    const double t = posture_time(*act.stage, moment);
    return decoded_of(two_handed_linkage(), body_, act.poses.at(t, anchors, two_handed_linkage(), linkage_, body_));
  }
  return linkage_.decode(coordinates(moment).head(posture_rows()), anchors);
}

/// Those of body_curves at a moment.
Eigen::VectorXd Performance::coordinates(double moment) const {
  const Act& act = body_act(moment);
  const double t = posture_time(*act.stage, moment), share = smooth(t);
  const LocalBasis local = bspline_local(t);
  Eigen::VectorXd coordinates = Eigen::VectorXd::Zero(act.curves_from.rows());
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double weight = local.values[static_cast<std::size_t>(i)];
    coordinates += weight * (1.0 - share) * act.curves_from.col(local.first + i) +
                   weight * share * act.curves_to.col(local.first + i);
  }
  return coordinates;
}

Load Performance::load(double moment, const BoxPose& object) const {
  const Vec3 middle(0, 0, 0.5 * task_.object.height_m);
  return {object.position + middle, load_share(plan_, frame_rate_, moment) * task_.object.mass_kg};
}

}  // namespace reachcast
