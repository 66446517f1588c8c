// SPDX-License-Identifier: GPL-3.0-or-later
/// Everything there is to know of a performance at a moment, also between frames: where the object and the hands are,
/// and the posture that holds on to them. Moments are frames with fractions.
#pragma once

#include <vector>

#include "reachcast/curves/endpoint_path.hpp"
#include "reachcast/posture/hold.hpp"
#include "reachcast/posture/trunk_pose.hpp"
#include "reachcast/predict/approach.hpp"
#include "reachcast/predict/blend.hpp"
#include "reachcast/predict/plan.hpp"
#include "reachcast/predict/stance_track.hpp"

namespace reachcast {

/// Centres of both grips, left and right.
using Grips = std::array<Vec3, 2>;

[[nodiscard]] Vec3 hold_point(const Grips& grips);

/// Where the hands of a person who stands at ease hang: beside the thighs, a little ahead, the elbows nearly straight.
[[nodiscard]] Grips hanging_grips(const Body& body);

/// The hands' grips on the object where it stands.
[[nodiscard]] Grips grips_on(const Task& task, Place place);

/// Hands at the start and the end of a stage.
struct HandEnds {
  Grips first, last;
};
[[nodiscard]] HandEnds hand_ends(const Stage& stage, const Task& task, const Body& body);

class Performance {
 public:
  /// One blend per stage of the plan. All references must outlive the performance. `raised`: the object's path is
  /// raised over the edges of what it stands on (approach.hpp).
  Performance(const Plan& plan, const std::vector<Blend>& blends, const Task& task, const Body& body,
              double body_mass_kg, double frame_rate, bool raised);

  /// How far the object's path is raised at most.
  [[nodiscard]] double raised_m() const;
  [[nodiscard]] BoxPose object(double moment) const;
  [[nodiscard]] Grips grips(double moment) const;

  /// The learned trunk and what must be changed about it, found at moments that do not depend on the frame rate.
  struct Tracks {
    TrunkTrack learned;
    StanceTrack stance;
  };
  [[nodiscard]] Tracks tracks() const;
  [[nodiscard]] Posture posture(double moment, const Tracks& tracks, HoldReport& report) const;

 private:
  struct Act {
    const Stage* stage = nullptr;
    const Blend* blend = nullptr;
    HandEnds hands;
    EndpointPath path;                        ///< of the hold point, or of the object's origin
    EdgeClearance clearance;                  ///< of a loaded stage
    double opening_m = 0.0;                   ///< how far empty hands stay clear of the object's sides
    Eigen::VectorXd first_shift, last_shift;  ///< of the posture's coordinates, so that stages meet
  };

  void join(std::size_t act);
  [[nodiscard]] double opening_of(const Act& act) const;
  [[nodiscard]] const Act& hands_act(double moment) const;
  [[nodiscard]] const Act& body_act(double moment) const;
  [[nodiscard]] double time_in(const Act& act, double moment) const;
  [[nodiscard]] BoxPose carried_object(const Act& act, double t) const;
  [[nodiscard]] Grips empty_grips(const Act& act, double t) const;
  [[nodiscard]] Grips grips_of_act(const Act& act, double moment) const;
  [[nodiscard]] Anchors anchors(const Grips& grips) const;
  [[nodiscard]] Decoded decoded(double moment, const Anchors& anchors) const;
  [[nodiscard]] Load load(double moment) const;
  [[nodiscard]] BoxPose place_pose(Place place) const;

  const Plan& plan_;
  const Task& task_;
  const Body& body_;
  double frame_rate_;
  Anchors stand_;
  Vec3 between_ankles_;
  BodyLinkage linkage_;
  Holder holder_;
  std::vector<Act> acts_;
  double last_opening_m_ = 0.0;  ///< after the object has been let go and nothing follows
};

}  // namespace reachcast
