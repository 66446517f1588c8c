// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/predict.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "reachcast/predict/performance.hpp"

namespace reachcast {
namespace {

constexpr double kUnbalanced_m = 0.02;  // weight this far beyond the feet is reported
constexpr int kMostWaysRound = 12;

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
  if (!(options.clearance_m >= 0.0 && options.clearance_m <= 0.5)) {
    fail("clearance is ", options.clearance_m, " m; it must lie between 0 and 0.5 m");
  }
  if (options.variation && !(options.variation->amount >= 0.0 && options.variation->amount <= 2.0)) {
    fail("amount of the variation is ", options.variation->amount, "; it must lie between 0 and 2");
  }
  if (!options.hand_paths.empty() && options.hand_paths.rbegin()->first >= options.phases.size()) {
    fail("a hand path is given for phase number ", options.hand_paths.rbegin()->first, ", but there are ",
         options.phases.size(), ", counted from 0");
  }
  if (options.motion && (options.variation || options.phases.size() != 1)) {
    fail("motion ", *options.motion, " is asked for alone; then there must be one phase, not ", options.phases.size(),
         ", and no variation");
  }
  for (const auto& [phase, seconds] : options.durations_s) {
    if (!(seconds >= 0.1 && seconds <= 60.0)) {
      fail("duration of ", phase_name(phase), " is ", seconds, " s; it must lie between 0.1 and 60 s");
    }
    if (std::find(options.phases.begin(), options.phases.end(), phase) == options.phases.end())
      fail("duration of ", phase_name(phase), " is given, but the phases do not include it");
  }
}

double body_mass(const Subject& subject) {
  return subject.mass_kg.value_or(usual_mass_kg(subject.stature_m));
}

std::string readable(Joint joint) {
  std::string name(joint_name(joint));
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// What could not be held, and when.
struct Failure {
  std::size_t frame = 0;
  HoldReport report;
};

/// Where the object stands at a frame at which it does not move and the hands are on it.
std::optional<Place> standing_place(const Plan& plan, std::size_t frame) {
  for (const Stage& stage : plan.stages) {
    const Place other = stage.object == Place::home ? Place::target : Place::home;
    if (frame <= stage.first && stage.phase != Phase::reach) return stage.object;
    if (frame < stage.last) return std::nullopt;
    if (frame == stage.last && stage.phase == Phase::return_) return std::nullopt;
    if (&stage == &plan.stages.back()) return is_loaded(stage.phase) ? other : stage.object;
  }
  return std::nullopt;
}

[[noreturn]] void fail_out_of_reach(const Failure& failure, const Motion& motion, const Vec3& hands) {
  const std::optional<Place> place = standing_place(motion.plan, failure.frame);
  const Stage& stage = *std::find_if(motion.plan.stages.begin(), motion.plan.stages.end() - 1,
                                     [&](const Stage& s) { return failure.frame <= s.last; });
  const bool loaded = is_loaded(stage.phase);
  const std::string name = place    ? *place == Place::home ? "home" : "target"
                           : loaded ? "path of the box"
                                    : "path of the hands";
  const Vec3 at = place || loaded ? motion.box[failure.frame].position : hands;
  fail("the ", name, " at (", std::setprecision(3), at.x + 0.0, ", ", at.y + 0.0, ", ", at.z, ") m from the feet is ",
       std::fixed, std::setprecision(1), std::max(0.1, 100.0 * failure.report.shortfall_m),
       " cm out of reach from the ", readable(failure.report.shortfall_from));
}

/// A home or a target that cannot be held comes before the way between them.
bool is_worse(const Plan& plan, const Failure& a, const Failure& b) {
  const bool a_stands = standing_place(plan, a.frame).has_value();
  if (a_stands != standing_place(plan, b.frame).has_value()) return a_stands;
  return a.report.shortfall_m > b.report.shortfall_m;
}

std::size_t carried_frames(const Plan& plan) {
  std::size_t frames = 0;
  for (const Stage& stage : plan.stages) frames += is_loaded(stage.phase) ? stage.last - stage.first - 1 : 0;
  return frames;
}

/// Fills in box, postures, times and corrections. Returns the worst failure, if any.
std::optional<Failure> perform(const Performance& performance, double frame_rate, Motion& motion) {
  motion.box.clear();
  motion.postures.clear();
  motion.bends_rad.clear();
  motion.times_s.clear();
  motion.box.reserve(motion.plan.end + 1);
  motion.postures.reserve(motion.plan.end + 1);
  motion.times_s.reserve(motion.plan.end + 1);
  const Performance::Tracks tracks = performance.tracks();
  Correction trunk{"trunk", 0.0, 0.0, 0}, unbalanced{"unbalanced", 0.0, 0.0, 0};
  std::optional<Failure> worst;
  for (std::size_t frame = 0; frame <= motion.plan.end; ++frame) {
    const auto moment = static_cast<double>(frame);
    HoldReport report;
    motion.times_s.push_back(moment / frame_rate);
    motion.box.push_back(performance.object(moment));
    motion.postures.push_back(performance.posture(moment, motion.box.back(), tracks, report));
    motion.bends_rad.push_back(tracks.learned.at(motion.times_s.back()).bend_rad);
    if (report.shortfall_m > 0.0 && (!worst || is_worse(motion.plan, {frame, report}, *worst)))
      worst = Failure{frame, report};
    trunk.amount_m = std::max(trunk.amount_m, report.trunk_shift_m);
    trunk.amount_rad = std::max(trunk.amount_rad, report.trunk_turn_rad);
    trunk.frames += report.trunk_shift_m > 1e-3 ? 1 : 0;
    unbalanced.amount_m = std::max(unbalanced.amount_m, report.unbalanced_m);
    unbalanced.frames += report.unbalanced_m > kUnbalanced_m ? 1 : 0;
  }
  motion.curves = performance.curves();
  motion.corrections.clear();
  if (performance.raised_m() > 1e-3)
    motion.corrections.push_back({"edge", performance.raised_m(), 0.0, carried_frames(motion.plan)});
  if (performance.bent_m() > 1e-3)
    motion.corrections.push_back({"obstacles", performance.bent_m(), 0.0, carried_frames(motion.plan)});
  if (trunk.frames > 0) motion.corrections.push_back(trunk);
  if (unbalanced.frames > 0) motion.corrections.push_back(unbalanced);
  return worst;
}

void check_places(const Task& task, const Subject& subject, std::span<const Phase> phases) {
  for (const auto& [name, place] : {std::pair{"home", task.home}, {"target", task.target}}) {
    if (place.z < subject.stature_m && std::hypot(place.x, place.y) < 0.5 * task.object.depth_m) {
      fail("the ", name, " is ", std::hypot(place.x, place.y),
           " m from between the feet, inside the body; it must be at least ", 0.5 * task.object.depth_m,
           " m away, half the depth of the box");
    }
  }
  if (std::any_of(phases.begin(), phases.end(), is_loaded) && glm::distance(task.home, task.target) < 0.01) {
    fail("home and target are ", glm::distance(task.home, task.target), " m apart; they must be at least 0.01 m apart");
  }
}

std::optional<double> given_seconds(Phase phase, const PredictOptions& options) {
  const auto given = options.durations_s.find(phase);
  return given == options.durations_s.end() ? std::nullopt : std::optional(given->second);
}

/// What the corpus says of one stage; what is outside the data is added to the motion.
LearnedStage learned_for(const Corpus& corpus, const MotionTable& table, const Stage& stage, const Task& task,
                         const HandEnds& hands, const Subject& subject, const PredictOptions& options, Motion& motion) {
  const Query query{
      stage.phase, hold_point(hands.first), hold_point(hands.last), subject, given_seconds(stage.phase, options),
      task.hands};
  LearnedStage learned =
      options.motion ? retargeted_stage(corpus, table, query, *options.motion)
                     : learn_stage(corpus, table, query, options.scheme, options.variation, motion.neighbours.size());
  for (const std::string& reason : learned.outside) {
    const std::string said = options.phases.size() > 1 ? std::string(phase_name(stage.phase)) + ": " + reason : reason;
    if (std::find(motion.outside_data.begin(), motion.outside_data.end(), said) == motion.outside_data.end())
      motion.outside_data.push_back(said);
  }
  if (const double seconds = learned.blend.whole.duration_s; !(seconds >= 0.05 && seconds <= 60.0)) {
    fail("the neighbours take ", seconds, " s; a phase takes 0.05 to 60 s");
  }
  motion.neighbours.push_back({stage.phase, learned.blend.neighbours});
  return learned;
}

bool ends_at_target(const Stage& stage) {
  if (stage.phase == Phase::reach) return stage.object == Place::target;
  return is_loaded(stage.phase) && other(stage.object) == Place::target;
}

/// What the user gave; else how the target shall be come to; else what the neighbours know, or the published model.
StageWay way_for(std::size_t number, const Stage& stage, const LearnedStage& learned, const HandEnds& hands,
                 const PredictOptions& options) {
  const Vec3 start = hold_point(hands.first), end = hold_point(hands.last);
  const auto given = options.hand_paths.find(number);
  if (given != options.hand_paths.end()) return given_way(learned.blend, given->second, start, end);
  if (options.approach && ends_at_target(stage)) {
    return approaching(learned.blend, *options.approach, start, end, level_direction(end, Vec3(0.0)));
  }
  return learned.borrowed ? published_way(start, end) : learned_way(learned.blend, options.scheme.paths);
}

/// What the stages rest on.
struct Acting {
  std::vector<Blend> blends;
  std::vector<StageWay> ways;
};

double seconds_of(Phase phase, const Blend& blend, const PredictOptions& options) {
  return given_seconds(phase, options).value_or(blend.whole.duration_s);
}

/// Raising the path over an edge is a courtesy: a path that can only be held as it was learned stays as it was, and so
/// does a single motion, which knew its own edges.
void perform_freely(const Acting& acting, const Subject& subject, const Task& task, const Body& body,
                    const PredictOptions& options, Motion& motion) {
  for (const bool raised : {!options.motion.has_value(), false}) {
    Performance performance(motion.plan, acting.blends, acting.ways, task, body, body_mass(subject),
                            options.frame_rate);
    if (raised) performance.raise_over_edges();
    const std::optional<Failure> failure = perform(performance, options.frame_rate, motion);
    if (!failure) return;
    if (!raised || standing_place(motion.plan, failure->frame)) {
      fail_out_of_reach(*failure, motion, hold_point(performance.grips(static_cast<double>(failure->frame))));
    }
  }
}

/// That a place is out of reach is said before anything about the way to it.
void require_places_in_reach(const Performance& performance, Motion& motion) {
  for (const Stage& stage : motion.plan.stages) {
    for (const std::size_t frame : {stage.first, stage.last}) {
      const HoldReport report = performance.report_at(static_cast<double>(frame));
      if (report.shortfall_m == 0.0) continue;
      motion.box.resize(frame + 1);
      motion.box[frame] = performance.object(static_cast<double>(frame));
      fail_out_of_reach({frame, report}, motion, hold_point(performance.grips(static_cast<double>(frame))));
    }
  }
}

/// Ways round the obstacles that this body cannot hold give way to the next.
void perform_past(const Obstacles& obstacles, const Acting& acting, const Subject& subject, const Task& task,
                  const Body& body, const PredictOptions& options, Motion& motion) {
  std::vector<std::size_t> manners(acting.blends.size(), 0);
  for (int attempt = 1;; ++attempt) {
    Performance performance(motion.plan, acting.blends, acting.ways, task, body, body_mass(subject),
                            options.frame_rate);
    if (attempt == 1) require_places_in_reach(performance, motion);
    manners = performance.go_round(obstacles, options.clearance_m, manners);
    const std::optional<Failure> failure = perform(performance, options.frame_rate, motion);
    if (!failure) {
      const std::size_t touching = performance.frames_touching(obstacles, options.clearance_m);
      if (touching > 0) motion.corrections.push_back({"obstacle on the given hand path", 0.0, 0.0, touching});
      return;
    }
    if (attempt == kMostWaysRound || standing_place(motion.plan, failure->frame)) {
      fail_out_of_reach(*failure, motion, hold_point(performance.grips(static_cast<double>(failure->frame))));
    }
    const auto& stages = motion.plan.stages;
    const auto stage =
        std::find_if(stages.begin(), stages.end() - 1, [&](const Stage& s) { return failure->frame <= s.last; });
    ++manners[static_cast<std::size_t>(stage - stages.begin())];
  }
}

}  // namespace

Motion predict(const Corpus& corpus, const Subject& subject, const Task& task, const Body& body,
               const PredictOptions& options) {
  check(task);
  check(subject, options);
  check_places(task, subject, options.phases);
  const std::shared_ptr<const MotionTable> table = corpus.table();
  if (table->motions().empty()) fail("the corpus ", corpus.path().string(), " holds no motions; import some first");
  Motion motion;
  std::vector<double> seconds(options.phases.size(), 1.0);
  Acting acting;
  for (const Stage& stage : plan_phases(options.phases, seconds, options.frame_rate).stages) {
    const std::size_t number = acting.blends.size();
    const HandEnds hands = hand_ends(stage, task, body);
    LearnedStage learned = learned_for(corpus, *table, stage, task, hands, subject, options, motion);
    acting.ways.push_back(way_for(number, stage, learned, hands, options));
    motion.ways.push_back(acting.ways.back().form);
    seconds[number] = seconds_of(stage.phase, learned.blend, options);
    acting.blends.push_back(std::move(learned.blend));
  }
  motion.plan = plan_phases(options.phases, seconds, options.frame_rate);
  if (options.obstacles && !options.obstacles->empty()) {
    perform_past(*options.obstacles, acting, subject, task, body, options, motion);
  } else {
    perform_freely(acting, subject, task, body, options, motion);
  }
  return motion;
}

}  // namespace reachcast
