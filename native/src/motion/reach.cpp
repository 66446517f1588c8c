// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/motion/reach.hpp"

#include <algorithm>
#include <utility>

namespace reachcast {
namespace {

constexpr std::array<std::pair<Phase, std::string_view>, 4> kPhaseNames{{{Phase::transfer, "transfer"},
                                                                         {Phase::return_, "return"},
                                                                         {Phase::reach, "reach"},
                                                                         {Phase::retrieve, "retrieve"}}};

constexpr std::array<std::pair<Hands, std::string_view>, 3> kHandsNames{
    {{Hands::both, "both"}, {Hands::left, "left"}, {Hands::right, "right"}}};

}  // namespace

bool is_loaded(Phase phase) {
  return phase == Phase::transfer || phase == Phase::retrieve;
}

Phase opposite(Phase phase) {
  switch (phase) {
    case Phase::transfer:
      return Phase::retrieve;
    case Phase::retrieve:
      return Phase::transfer;
    case Phase::reach:
      return Phase::return_;
    case Phase::return_:
      return Phase::reach;
  }
  return phase;
}

std::string_view phase_name(Phase phase) {
  const auto found =
      std::find_if(kPhaseNames.begin(), kPhaseNames.end(), [&](const auto& p) { return p.first == phase; });
  return found == kPhaseNames.end() ? std::string_view{} : found->second;
}

std::optional<Phase> find_phase(std::string_view name) {
  const auto found =
      std::find_if(kPhaseNames.begin(), kPhaseNames.end(), [&](const auto& p) { return p.second == name; });
  if (found == kPhaseNames.end()) return std::nullopt;
  return found->first;
}

std::string_view hands_name(Hands hands) {
  const auto found =
      std::find_if(kHandsNames.begin(), kHandsNames.end(), [&](const auto& h) { return h.first == hands; });
  return found == kHandsNames.end() ? std::string_view{} : found->second;
}

std::optional<Hands> find_hands(std::string_view name) {
  const auto found =
      std::find_if(kHandsNames.begin(), kHandsNames.end(), [&](const auto& h) { return h.second == name; });
  if (found == kHandsNames.end()) return std::nullopt;
  return found->first;
}

Hands mirrored(Hands hands) {
  if (hands == Hands::both) return hands;
  return hands == Hands::left ? Hands::right : Hands::left;
}

Vec3 Reach::hold_point(std::size_t frame) const {
  const Posture& posture = postures.at(frame);
  return (posture[index(Joint::left_grip)] + posture[index(Joint::right_grip)]) * 0.5;
}

Reach mirrored(const Reach& reach) {
  Reach image = reach;
  image.hands = mirrored(reach.hands);
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    image.derived[joint] = reach.derived[index(mirrored(static_cast<Joint>(joint)))];
  }
  for (Posture& posture : image.postures) posture = mirrored(posture);
  return image;
}

Reach reversed(const Reach& reach) {
  Reach back = reach;
  back.phase = opposite(reach.phase);
  back.origin += kBackwards;
  std::reverse(back.postures.begin(), back.postures.end());
  return back;
}

}  // namespace reachcast
