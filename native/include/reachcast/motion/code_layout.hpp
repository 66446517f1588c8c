// SPDX-License-Identifier: GPL-3.0-or-later
/// Where in MotionCode::coefficients what is. A corpus whose codes are laid out otherwise has another schema version.
#pragma once

#include "reachcast/body/body.hpp"
#include "reachcast/curves/bspline.hpp"
#include "reachcast/curves/endpoint_path.hpp"

namespace reachcast::layout {

/// Speed along the line from start to end, deviation x, y, z (2004), then offsets of the inner control points and the
/// two exponents of speed (2007).
inline constexpr Eigen::Index kPathLength = 4 * kPathBasisCount;
inline constexpr Eigen::Index kCurveLength = 8;
inline constexpr Eigen::Index kWayLength = kPathLength + kCurveLength;

/// Of a joint that may move: displacement, then its way.
inline constexpr Eigen::Index kMoveLength = 3 + kWayLength;

inline constexpr Eigen::Index kHoldWay = 0;                           ///< of the hold point
inline constexpr Eigen::Index kSeparation = kHoldWay + kWayLength;    ///< x, y, z: eight splines each
inline constexpr Eigen::Index kFeet = kSeparation + 3 * kBasisCount;  ///< moves of the left and the right ankle
inline constexpr Eigen::Index kPelvis = kFeet + 2 * kMoveLength;      ///< move of l5s1
inline constexpr Eigen::Index kTorso = kPelvis + kMoveLength;         ///< eight splines
inline constexpr Eigen::Index kLengths = kTorso + kBasisCount;        ///< in the order of segment_names
inline constexpr Eigen::Index kPosture = kLengths + static_cast<Eigen::Index>(kLengthCount);  ///< eight splines each

}  // namespace reachcast::layout
