// SPDX-License-Identifier: GPL-3.0-or-later
/// The mirror image of a motion without going through its postures.
#pragma once

#include <Eigen/Core>

namespace reachcast {

/// Coefficients that encode_reach(mirrored(reach)) gives, from those of the reach: they change places and signs. Exact
/// for people whose clavicle roots lie alike on both sides; else the pointers on the rigid parts (head and shoulders)
/// differ, since the frames of parts are made of joints of one side. Throws std::invalid_argument unless there are
/// code_length() coefficients.
[[nodiscard]] Eigen::VectorXd mirror_image(const Eigen::VectorXd& coefficients);

}  // namespace reachcast
