// SPDX-License-Identifier: GPL-3.0-or-later
/// A learned path bent round what is in its way. People lift a box in front of a shelf and then push it in, and pull it
/// out before they lower it: up and across come one after the other instead of together. So a path is not pushed off
/// surfaces, which would leave it on either side of a board, but chosen from such ways round, the least bent first.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "reachcast/curves/endpoint_path.hpp"

namespace reachcast {

struct PathShape {
  double lead = 0.0;       ///< -1 to 1: > 0 the way up or down is gone before the level way, < 0 after it
  double rise_m = 0.0;     ///< above its place, near both ends of the way
  double retreat_m = 0.0;  ///< towards the person, in the middle of the way

  [[nodiscard]] bool is_straight() const { return lead == 0.0 && rise_m == 0.0 && retreat_m == 0.0; }
};

/// point_at, bent. `towards_person`: level unit vector. Start, end and the rest at both ends stay.
[[nodiscard]] Vec3 shaped_point_at(const EndpointPath& path, const Vec3& start, const Vec3& end, const PathShape& shape,
                                   const Vec3& towards_person, double t);

/// All shapes that are tried, the straight one first, then by how much they bend.
[[nodiscard]] const std::vector<PathShape>& path_shapes();

/// A Bezier curve is bent by its inner control points, so that it stays one: how far each is moved.
using CurveBend = std::array<Vec3, 2>;

/// All bends that are tried, none first, then by how far they move the points: up and towards the person, over 0.5 m;
/// the second point only along `approach` where that is asked for.
[[nodiscard]] std::vector<CurveBend> curve_bends(const Vec3& towards_person, const std::optional<Vec3>& approach);

/// How far one way goes from the line of another, whenever it is there; metres, to within 1 cm. Both: point at scaled
/// time.
[[nodiscard]] double bend_of(const std::function<Vec3(double)>& bent, const std::function<Vec3(double)>& learned);

}  // namespace reachcast
