// SPDX-License-Identifier: GPL-3.0-or-later
/// Which way the hold point takes in a stage, and who says so: the neighbours, the published model, or the user.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "reachcast/curves/endpoint_way.hpp"
#include "reachcast/predict/blend.hpp"

namespace reachcast {

enum class WayForm {
  deviation,  ///< learned, as in the 2004 paper (endpoint_path.hpp)
  bezier,     ///< learned, as in the 2007 paper (axis_curve.hpp)
  published,  ///< the means that the 2007 paper prints
  given,      ///< by the user
};
[[nodiscard]] std::string_view form_name(WayForm form);

/// From where the object, or empty hands, shall come to the place where a stage ends.
enum class Approach { above, front, side };  ///< front: from the person; side: the one that the stage begins on

/// Inner control points of a cubic Bezier curve of the hold point, body frame, metres; its ends are those of the stage.
using InnerPoints = std::array<Vec3, 2>;

struct StageWay {
  WayForm form = WayForm::deviation;
  EndpointWay way;               ///< of the hold point; the object's origin goes the same way, below it
  std::optional<Vec3> approach;  ///< unit vector from the end of the way to where it comes from, if asked for
};

/// The way that neighbours have learned, in the scheme's form.
[[nodiscard]] StageWay learned_way(const Blend& blend, PathForm form);

/// The published way from start to end.
[[nodiscard]] StageWay published_way(const Vec3& start, const Vec3& end);

/// A curve through these inner points, with the neighbours' timing. Throws std::invalid_argument for points that are
/// not finite or lie more than 3 m from both ends.
[[nodiscard]] StageWay given_way(const Blend& blend, const InnerPoints& inner, const Vec3& start, const Vec3& end);

/// The way made to end in the wanted direction: its last inner control point lies there, half the way's length but 0.12
/// to 0.4 m from the end. The rest is as learned. towards_person: level unit vector.
[[nodiscard]] StageWay approaching(const Blend& blend, Approach approach, const Vec3& start, const Vec3& end,
                                   const Vec3& towards_person);

/// Level unit vector from a point towards one above or below; forward to the body when they are one above the other.
[[nodiscard]] Vec3 level_direction(const Vec3& from, const Vec3& to);

}  // namespace reachcast
