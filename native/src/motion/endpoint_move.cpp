// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/motion/endpoint_move.hpp"

#include "reachcast/motion/code_layout.hpp"
#include "reachcast/motion/code_ways.hpp"

namespace reachcast {
namespace {

EndpointMove move_of(const Reach& reach, Joint joint) {
  EndpointMove move;
  const Vec3 displacement = reach.postures.back()[index(joint)] - reach.postures.front()[index(joint)];
  if (glm::length(displacement) < kLeastMove_m) return move;
  Points points;
  for (const Posture& posture : reach.postures) points.push_back(posture[index(joint)]);
  move.displacement = displacement / reach.subject.stature_m;
  move.path = fit_endpoint_path(points);
  move.curve = fit_axis_curve(points);
  return move;
}

EndpointMove move_at(const MotionCode& code, Eigen::Index at) {
  EndpointMove move;
  for (int k = 0; k < 3; ++k) move.displacement[k] = code.coefficients[at + k];
  move.path = layout::path_at(code.coefficients, at + 3);
  move.curve = layout::curve_at(code.coefficients, at + 3 + layout::kPathLength);
  return move;
}

void put_move(const EndpointMove& move, MotionCode& code, Eigen::Index at) {
  for (int k = 0; k < 3; ++k) code.coefficients[at + k] = move.displacement[k];
  layout::put_path(move.path, code.coefficients, at + 3);
  layout::put_curve(move.curve, code.coefficients, at + 3 + layout::kPathLength);
}

}  // namespace

std::array<EndpointMove, 2> foot_moves_of(const Reach& reach) {
  return {move_of(reach, Joint::left_ankle), move_of(reach, Joint::right_ankle)};
}

std::array<EndpointMove, 2> foot_moves_of(const MotionCode& code) {
  return {move_at(code, layout::kFeet), move_at(code, layout::kFeet + layout::kMoveLength)};
}

void set_foot_moves(MotionCode& code, const std::array<EndpointMove, 2>& moves) {
  put_move(moves[0], code, layout::kFeet);
  put_move(moves[1], code, layout::kFeet + layout::kMoveLength);
}

EndpointMove pelvis_move_of(const Reach& reach) {
  return move_of(reach, Joint::l5s1);
}

EndpointMove pelvis_move_of(const MotionCode& code) {
  return move_at(code, layout::kPelvis);
}

void set_pelvis_move(MotionCode& code, const EndpointMove& move) {
  put_move(move, code, layout::kPelvis);
}

EndpointMove reversed(const EndpointMove& move) {
  EndpointMove back = move;
  back.displacement = -move.displacement;
  back.path.velocity = move.path.velocity.reverse();
  for (int k = 0; k < 3; ++k) back.path.deviation.col(k) = move.path.deviation.col(k).reverse();
  back.curve = {{move.curve.offsets[1], move.curve.offsets[0]}, {move.curve.speed.beta, move.curve.speed.alpha}};
  return back;
}

}  // namespace reachcast
