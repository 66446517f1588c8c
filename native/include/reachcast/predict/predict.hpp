// SPDX-License-Identifier: GPL-3.0-or-later
/// Subject + Task + corpus -> neighbours -> mean MotionCode -> Motion on this body (Faraway 2004, sections 3.3-5).
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "reachcast/body/body.hpp"
#include "reachcast/predict/learned_stage.hpp"
#include "reachcast/predict/neighbours.hpp"
#include "reachcast/predict/obstacles.hpp"
#include "reachcast/predict/plan.hpp"
#include "reachcast/predict/stage_way.hpp"
#include "reachcast/predict/task.hpp"

namespace reachcast {

struct PredictOptions {
  double frame_rate = 24.0;  ///< frames per second of the result, 1 to 1000
  Scheme scheme{};           ///< which motions are averaged, and how; one that compares durations needs durations_s
  /// In this order. The object stands where the first loaded phase takes it from, at the target when none is loaded.
  std::vector<Phase> phases{Phase::transfer};
  std::map<Phase, double> durations_s{};  ///< of a phase's own motion, 0.1 to 60; else the neighbours' mean
  /// What the object and the hands keep clear of, body frame; none when empty. Arms and body are not looked at.
  std::shared_ptr<const Obstacles> obstacles{};
  double clearance_m = 0.02;  ///< 0 to 0.5
  /// By number of the phase, from 0: inner control points of the hold point's path. Such a path is neither raised over
  /// edges nor bent round obstacles; a correction says in how many frames it meets one.
  std::map<std::size_t, InnerPoints> hand_paths{};
  /// From where the hands, or the object in them, come to the target.
  std::optional<Approach> approach{};
  /// Only this stored motion, carried onto this body and task (Faraway 2004, section 3.3: retargeting); no scheme is
  /// used, and no path is raised over edges. It must be of the one phase that is asked for, and cannot be varied.
  std::optional<std::int64_t> motion{};
  /// Another motion than the mean.
  std::optional<Variation> variation{};
};

/// The motions that a phase rests on, heaviest first.
struct PhaseNeighbours {
  Phase phase = Phase::transfer;
  std::vector<Neighbour> neighbours;
};

/// A change made after decoding, or what no change could mend; largest over the frames.
struct Correction {
  /// "trunk": moved as hold.hpp says; "edge": the path of the box raised as approach.hpp says (when no obstacles are
  /// given); "obstacles": a path bent as path_around.hpp says; "obstacle on the given hand path": how often the path
  /// that the user gave meets one; "unbalanced": the weight lies this far beyond the feet, a person would step or fall.
  std::string name;
  double amount_m = 0.0;
  double amount_rad = 0.0;
  std::size_t frames = 0;  ///< how many frames it touched
};

struct Motion {
  std::vector<Posture> postures;  ///< body frame
  std::vector<double> bends_rad;  ///< of the back (spine.hpp), one per posture
  std::vector<BoxPose> box;       ///< body frame, one per posture
  std::vector<double> times_s;    ///< frame / frame_rate
  Plan plan;
  std::vector<PhaseNeighbours> neighbours;  ///< one per phase
  std::vector<WayForm> ways;                ///< one per phase: what its path of the hands comes from
  /// One per phase: control points of the hold point's path, body frame, where it is a Bezier curve.
  std::vector<std::optional<std::array<Vec3, 4>>> curves;
  std::vector<std::string> outside_data;  ///< why the task lies outside the corpus; empty when it lies inside
  std::vector<Correction> corrections;
};

/// Both hands take the object at home, bring it to the target and let go (`transfer`), go back to hang at the sides
/// (`return_`), come for it again (`reach`) and bring it home (`retrieve`), in any order that can be performed; the
/// feet stay where the body stands. Hands, feet and segment lengths are exact; positions and velocities are continuous
/// where phases meet. Deterministic. Throws std::invalid_argument for bad input, phases that cannot follow one another,
/// an empty corpus, and a place of the object that this body cannot hold, saying which, by how many
/// centimetres and from which joint.
[[nodiscard]] Motion predict(const Corpus& corpus, const Subject& subject, const Task& task, const Body& body,
                             const PredictOptions& options = {});

}  // namespace reachcast
