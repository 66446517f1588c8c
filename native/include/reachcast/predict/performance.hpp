// SPDX-License-Identifier: GPL-3.0-or-later
/// Everything there is to know of a performance at a moment, also between frames: where the object and the hands are,
/// and the posture that holds on to them. Moments are frames with fractions.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "reachcast/motion/encode.hpp"
#include "reachcast/posture/hold.hpp"
#include "reachcast/posture/trunk_pose.hpp"
#include "reachcast/predict/approach.hpp"
#include "reachcast/predict/blend.hpp"
#include "reachcast/predict/obstacles.hpp"
#include "reachcast/predict/path_around.hpp"
#include "reachcast/predict/plan.hpp"
#include "reachcast/predict/pose_mean.hpp"
#include "reachcast/predict/stage_way.hpp"
#include "reachcast/predict/stance_track.hpp"

namespace reachcast {

/// Centres of both grips, left and right. Where one hand works both are its grip: the other has none on anything.
using Grips = std::array<Vec3, 2>;

[[nodiscard]] Vec3 hold_point(const Grips& grips);

/// The hands' grips on the object where it stands.
[[nodiscard]] Grips grips_on(const Task& task, Place place);

/// Working hands at the start and the end of a stage. Empty ones come from, and go back to, where they hang
/// (stand.hpp).
struct HandEnds {
  Grips first, last;
};
[[nodiscard]] HandEnds hand_ends(const Stage& stage, const Task& task, const Body& body);

class Performance {
 public:
  /// One blend and one way per stage of the plan. All references must outlive the performance.
  Performance(const Plan& plan, const std::vector<Blend>& blends, const std::vector<StageWay>& ways, const Task& task,
              const Body& body, double body_mass_kg, double frame_rate);

  /// Raises the object's path over the edges of what it may stand on (approach.hpp). Where the way comes to its end
  /// from a direction that was asked for it is not raised there, and a way that the user gave is left as it is.
  void raise_over_edges();
  /// Bends the ways of object and hands round the obstacles, each in the first manner (of path_shapes() or
  /// curve_bends()) from the one given for its stage on that keeps `clearance_m`, less and less over the last 10 cm
  /// before a place. Returns the manners taken. A way that the user gave is left as it is.
  /// Throws std::invalid_argument when the object would stand in an obstacle, or none is left for a stage.
  std::vector<std::size_t> go_round(const Obstacles& obstacles, double clearance_m,
                                    const std::vector<std::size_t>& first_manners);
  /// In how many frames the object or the hands come nearer than `clearance_m` to an obstacle on a way that the user
  /// gave.
  [[nodiscard]] std::size_t frames_touching(const Obstacles& obstacles, double clearance_m) const;

  /// Control points of the hold point's path in each stage whose way is a Bezier curve, bent as it is; edges, which
  /// raise the object, left out.
  [[nodiscard]] std::vector<std::optional<std::array<Vec3, 4>>> curves() const;

  /// How far the object's path is raised over edges at most, and how far a path is bent round obstacles.
  [[nodiscard]] double raised_m() const;
  [[nodiscard]] double bent_m() const;
  [[nodiscard]] BoxPose object(double moment) const;
  [[nodiscard]] Grips grips(double moment) const { return grips(moment, object(moment)); }

  /// How the posture of this moment can be held, by itself.
  [[nodiscard]] HoldReport report_at(double moment) const;

  /// The learned trunk and what must be changed about it, found at moments that do not depend on the frame rate.
  struct Tracks {
    TrunkTrack learned;
    StanceTrack stance;
  };
  [[nodiscard]] Tracks tracks() const;
  /// `object`: object(moment).
  [[nodiscard]] Posture posture(double moment, const BoxPose& object, const Tracks& tracks, HoldReport& report) const;

 private:
  /// How the object turns in a loaded stage, radians.
  struct Turning {
    double first = 0.0, more = 0.0;            ///< against the person who carries it: at the start, and over the way
    double recorded = 0.0, recorded_more = 0;  ///< the same of the recorded hands
  };
  struct Act {
    const Stage* stage = nullptr;
    const Blend* blend = nullptr;
    HandEnds hands;
    StageWay way;                ///< of the hold point, or of the object's origin; bent round obstacles
    BoxPose from, to;            ///< of the object
    Turning turning;             ///< of a loaded stage
    EdgeClearance clearance;     ///< of a loaded stage
    PathShape shape;             ///< round obstacles, if the way is an EndpointPath
    bool is_bent = false;        ///< in either manner
    Vec3 half_first, half_last;  ///< of an empty stage: what its ends lack of half the recorded way between the hands
    double opening_m = 0.0;      ///< how far empty hands stay clear of the object's sides
    PostureCurves curves_from, curves_to;  ///< body_curves of the blend, shifted so that stages meet
    PoseMean poses;                        ///< instead of them where poses are averaged
  };

  [[nodiscard]] Act act_of(const Stage& stage, const Blend& blend, const StageWay& way) const;
  [[nodiscard]] Turning turning_of(const Act& act) const;
  void join(std::size_t act);
  void join_poses();
  [[nodiscard]] TrunkPose mean_pose(const Act& act, double moment) const;
  void find_openings();
  [[nodiscard]] bool is_free(const Act& act, const Obstacles& obstacles, double clearance_m) const;
  [[nodiscard]] bool is_free_at(const Act& act, double t, const Obstacles& obstacles, double clearance_m) const;
  [[nodiscard]] std::vector<CurveBend> bends_of(const Act& act) const;
  void require_free_place(Place place, const Obstacles& obstacles) const;
  [[nodiscard]] Vec3 point_of(const Act& act, const Vec3& from, const Vec3& to, double t) const;
  [[nodiscard]] Vec3 towards_person(const Vec3& from, const Vec3& to) const;
  [[nodiscard]] double opening_of(const Act& act) const;
  [[nodiscard]] const Act& hands_act(double moment) const;
  [[nodiscard]] const Act& body_act(double moment) const;
  [[nodiscard]] double time_in(const Act& act, double moment) const;
  [[nodiscard]] BoxPose carried_object(const Act& act, double t) const;
  [[nodiscard]] Grips empty_grips(const Act& act, double t) const;
  [[nodiscard]] Vec3 recorded_half(const Act& act, double t, const Vec3& hold) const;
  [[nodiscard]] Grips grips(double moment, const BoxPose& object) const;
  [[nodiscard]] Anchors anchors(double moment, const Grips& grips) const;
  [[nodiscard]] Eigen::VectorXd coordinates(double moment) const;
  [[nodiscard]] Decoded decoded(double moment, const Anchors& anchors) const;
  [[nodiscard]] Load load(double moment, const BoxPose& object) const;
  [[nodiscard]] BoxPose place_pose(Place place) const;

  const Plan& plan_;
  Task task_;  ///< of one hand: with the object as it holds it
  const Body& body_;
  double frame_rate_;
  Anchors stand_;
  Vec3 between_ankles_;
  BodyLinkage linkage_;
  Holder holder_;
  std::vector<Act> acts_;
  const std::vector<StageWay>& ways_;  ///< as they were before any bending
  double last_opening_m_ = 0.0;        ///< after the object has been let go and nothing follows
};

}  // namespace reachcast
