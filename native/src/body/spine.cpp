// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/body/spine.hpp"

#include <algorithm>
#include <cmath>

namespace reachcast {
namespace {

constexpr double kSmallBend_rad = 1e-4;  // below, the series is exact to the last digit
constexpr int kNewtonSteps = 6;

/// Sideways axis about which the back turns forward: across the chord, to the left.
Vec3 bending_axis(const Vec3& chord, const Vec3& right) {
  const Vec3 along = glm::normalize(chord);
  return -glm::normalize(right - glm::dot(right, along) * along);
}

Mat3 turn_about(const Vec3& axis, double angle_rad) {
  return glm::mat3_cast(glm::angleAxis(angle_rad, axis));
}

/// What moves with the upper end of the back.
constexpr std::array kUpperJoints{Joint::suprasternale,    Joint::left_clavicle,  Joint::right_clavicle,
                                  Joint::left_shoulder,    Joint::right_shoulder, Joint::left_elbow,
                                  Joint::right_elbow,      Joint::left_wrist,     Joint::right_wrist,
                                  Joint::left_grip,        Joint::right_grip,     Joint::left_hand_front,
                                  Joint::right_hand_front, Joint::left_hand_back, Joint::right_hand_back,
                                  Joint::tragion,          Joint::nasion};

}  // namespace

double ratio_of_bend(double bend_rad) {
  const double half = 0.5 * bend_rad;
  return std::abs(half) < kSmallBend_rad ? 1.0 - half * half / 6.0 : std::sin(half) / half;
}

double bend_of_ratio(double ratio) {
  if (!(ratio < 1.0)) return 0.0;
  if (ratio <= ratio_of_bend(kMostBend_rad)) return kMostBend_rad;
  double half = std::sqrt(6.0 * (1.0 - ratio));  // from sin x / x = 1 - x^2 / 6 + ...
  for (int step = 0; step < kNewtonSteps && half > kSmallBend_rad; ++step) {
    const double sine = std::sin(half), cosine = std::cos(half);
    half -= (sine / half - ratio) * half * half / (half * cosine - sine);
  }
  return std::clamp(2.0 * half, 0.0, kMostBend_rad);
}

BentBack bent_arc(const Vec3& chord, const Vec3& right, double bend_rad) {
  return {chord * ratio_of_bend(bend_rad), {}, turn_about(bending_axis(chord, right), 0.5 * bend_rad)};
}

BentBack bent_back(std::span<const Vec3> pieces, const Vec3& right, double bend_rad) {
  Vec3 chord(0.0);
  double whole_m = 0.0;
  for (const Vec3& piece : pieces) chord += piece, whole_m += glm::length(piece);
  const Vec3 axis = bending_axis(chord, right), along = glm::normalize(chord);
  std::vector<double> angles;
  Vec3 end(0.0);
  double done_m = 0.0;
  for (const Vec3& piece : pieces) {
    const double length = glm::length(piece);
    angles.push_back(bend_rad * ((done_m + 0.5 * length) / whole_m - 0.5));
    end += turn_about(axis, angles.back()) * piece;
    done_m += length;
  }
  // Pieces of unequal lengths, or out of line, turn the chord as a whole; it is turned back.
  const double back = std::atan2(glm::dot(axis, glm::cross(end, along)), glm::dot(end, along));
  BentBack out{along * glm::length(end), {}, Mat3(1.0)};
  for (const double angle : angles) out.turns.push_back(turn_about(axis, angle + back));
  if (!out.turns.empty()) out.upper = out.turns.back();
  return out;
}

BentStand bent_stand(const Body& body, double bend_rad) {
  BentStand out{body.posture(), Mat3(1.0)};
  if (bend_rad == 0.0) return out;
  const Vec3 waist = body.at(Joint::l5s1), neck = body.at(Joint::c7t1), right(1, 0, 0);
  const BentBack back =
      body.spine() ? bent_back(*body.spine(), right, bend_rad) : bent_arc(neck - waist, right, bend_rad);
  out.upper = back.upper;
  const Vec3 moved = waist + back.end;
  for (const Joint j : kUpperJoints) out.posture[index(j)] = moved + back.upper * (body.at(j) - neck);
  out.posture[index(Joint::c7t1)] = moved;
  return out;
}

}  // namespace reachcast
