// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/rig/limbs.hpp"

#include <algorithm>
#include <cmath>

#include "reachcast/rig/turns.hpp"

namespace reachcast {
namespace {

constexpr double kNoBend = 1e-9;  // sine of the bend below which a limb has no plane at all

/// The normal of frame `from`, which is bent, carried to the axis of frame `to` by the smallest turn.
Vec3 carried(std::span<const Vec3> raw, std::span<const Vec3> axes, std::size_t from, std::size_t to) {
  return smallest_turn(axes[from], axes[to]) * glm::normalize(raw[from]);
}

std::size_t next_bent(std::span<const Vec3> raw, std::size_t from) {
  while (from < raw.size() && glm::length(raw[from]) < kFullBend) ++from;
  return from;
}

/// Between the bent frames `before` and `after` by time; raw.size() says that there is none.
Vec3 between(std::span<const Vec3> raw, std::span<const Vec3> axes, std::size_t before, std::size_t after,
             std::size_t f) {
  if (before == raw.size()) return across(carried(raw, axes, after, f), axes[f]);
  const Vec3 first = carried(raw, axes, before, f);
  if (after == raw.size()) return across(first, axes[f]);
  const double share = static_cast<double>(f - before) / static_cast<double>(after - before);
  return turned_towards(first, carried(raw, axes, after, f), axes[f], share);
}

/// The palm over time from where the forearm would bring it, as angles about the hand.
std::vector<double> hand_twists(std::span<const Vec3> towards, std::span<const Vec3> hands,
                                std::span<const Vec3> neutral) {
  const Points palms = carried_normals(towards, hands, neutral);
  std::vector<double> twists(hands.size());
  double sum = 0.0;
  for (std::size_t f = 0; f < hands.size(); ++f) twists[f] = signed_angle(neutral[f], palms[f], hands[f]);
  unwrap(twists);
  for (const double twist : twists) sum += twist;
  const double turns = 2.0 * kPi * std::nearbyint(sum / static_cast<double>(hands.size()) / (2.0 * kPi));
  for (double& twist : twists) twist = std::clamp(twist - turns, -kMaxHandTwist_rad, kMaxHandTwist_rad);
  return twists;
}

}  // namespace

Points carried_normals(std::span<const Vec3> raw, std::span<const Vec3> axes, std::span<const Vec3> fallback) {
  const std::size_t frames = raw.size();
  Points normals(frames);
  std::size_t before = frames, after = next_bent(raw, 0);
  for (std::size_t f = 0; f < frames; ++f) {
    const double sine = glm::length(raw[f]);
    if (sine >= kFullBend) {
      before = f;
      normals[f] = unit_or_same(across(raw[f] / sine, axes[f]));
      continue;
    }
    if (after < f) after = next_bent(raw, f);
    const Vec3 safe = frame_towards(axes[f], fallback[f])[1];
    const Vec3 own = sine > kNoBend ? raw[f] / sine : safe;
    const bool is_ever_bent = before != frames || after != frames;
    normals[f] = turned_towards(is_ever_bent ? between(raw, axes, before, after, f) : safe, own, axes[f],
                                smooth_step(sine / kFullBend));
  }
  return normals;
}

void unwrap(std::span<double> angles_rad) {
  double previous = angles_rad.empty() ? 0.0 : angles_rad[0], added = 0.0;
  for (double& angle : angles_rad) {
    const double step = angle - previous;
    previous = angle;
    if (std::abs(step) >= kPi) {
      double least = std::remainder(step, 2.0 * kPi);  // in [-pi, pi]; half a turn keeps its sign
      if (std::abs(least) == kPi) least = std::copysign(kPi, step);
      added += least - step;
    }
    angle += added;
  }
}

void turn_hinge(const HingeRest& rest, const HingeJoints& joints, Postures postures, Turns above, std::span<Mat3> upper,
                std::span<Mat3> lower) {
  const std::size_t frames = postures.size();
  Points first(frames), second(frames), raw(frames), fallback(frames);
  for (std::size_t f = 0; f < frames; ++f) {
    const Vec3& hinge = postures[f][index(joints.hinge)];
    first[f] = unit_or_same(hinge - postures[f][index(joints.root)]);
    second[f] = unit_or_same(postures[f][index(joints.end)] - hinge);
    raw[f] = glm::cross(first[f], second[f]);
    fallback[f] = smallest_turn(above[f] * rest.upper, first[f]) * (above[f] * rest.normal);
  }
  const Points normals = carried_normals(raw, first, fallback);
  const Mat3 upper_rest = glm::transpose(frame_towards(rest.upper, rest.normal));
  const Mat3 lower_rest = glm::transpose(frame_towards(rest.lower, rest.normal));
  for (std::size_t f = 0; f < frames; ++f) {
    upper[f] = frame_towards(first[f], normals[f]) * upper_rest;
    // the lower link's normal: the hinge's own, brought across it where the limb is too straight to be its plane
    lower[f] = frame_towards(second[f], normals[f]) * lower_rest;
  }
}

void turn_hand(const HandRest& rest, const ArmNames& arm, Postures postures, std::span<Mat3> forearm,
               std::span<Mat3> hand) {
  const std::size_t frames = postures.size();
  Points along(frames), hands(frames), towards(frames), neutral(frames);
  for (std::size_t f = 0; f < frames; ++f) {
    const Posture& at = postures[f];
    const Vec3 &wrist = at[index(arm.wrist)], &grip = at[index(arm.grip)];
    along[f] = unit_or_same(wrist - at[index(arm.elbow)]);
    hands[f] = unit_or_same(grip - wrist);
    towards[f] = across(unit_or_same(at[index(arm.other_grip)] - grip), hands[f]);
    const Mat3 bent = smallest_turn(forearm[f] * rest.hand, hands[f]);
    neutral[f] = bent * (forearm[f] * rest.palm);
    hand[f] = bent * forearm[f];
  }
  const std::vector<double> twists = hand_twists(towards, hands, neutral);
  for (std::size_t f = 0; f < frames; ++f) {
    hand[f] = turn_about(hands[f], twists[f]) * hand[f];
    forearm[f] = turn_about(along[f], 0.5 * twists[f]) * forearm[f];
  }
}

}  // namespace reachcast
