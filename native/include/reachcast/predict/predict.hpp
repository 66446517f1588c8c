// SPDX-License-Identifier: GPL-3.0-or-later
/// Subject + Task + corpus -> neighbours -> mean MotionCode -> Motion on this body (Faraway 2004, sections 3.3-5).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reachcast/body/body.hpp"
#include "reachcast/predict/neighbours.hpp"
#include "reachcast/predict/task.hpp"

namespace reachcast {

struct PredictOptions {
  double frame_rate = 24.0;          ///< frames per second of the result, 1 to 1000
  Scheme scheme;                     ///< which motions are averaged, and how
  std::optional<double> duration_s;  ///< of the transfer itself; else the neighbours' mean. 0.1 to 60
};

/// Frame numbers of what happens to the box. From lift_off to placed it moves; from grasp to release it is held; from
/// release to end the hands open beside it.
struct Events {
  std::size_t grasp = 0, lift_off = 0, placed = 0, release = 0, end = 0;
};

/// A change made after decoding, or what no change could mend; largest over the frames.
struct Correction {
  /// "trunk": moved as hold.hpp says; "edge": the path of the box raised as approach.hpp says; "unbalanced": the weight
  /// lies this far beyond the feet, a person would step or fall.
  std::string name;
  double amount_m = 0.0;
  double amount_rad = 0.0;
  std::size_t frames = 0;  ///< how many frames it touched
};

struct Motion {
  std::vector<Posture> postures;  ///< body frame
  std::vector<BoxPose> box;       ///< body frame, one per posture
  std::vector<double> times_s;    ///< frame / frame_rate
  Events events;
  double duration_s = 0.0;  ///< of the transfer, lift_off to placed
  std::vector<Neighbour> neighbours;
  std::vector<std::string> outside_data;  ///< why the task lies outside the corpus; empty when it lies inside
  std::vector<Correction> corrections;
};

/// The `transfer` phase: both hands take the box at home, bring it to the target and let go; the feet stay where the
/// body stands. Hands, feet and segment lengths are exact. Deterministic. Throws std::invalid_argument for bad input,
/// a corpus without transfers, and a box place that this body cannot hold, saying which, by how many centimetres and
/// from which joint.
[[nodiscard]] Motion predict_transfer(const Corpus& corpus, const Subject& subject, const Task& task, const Body& body,
                                      const PredictOptions& options = {});

}  // namespace reachcast
