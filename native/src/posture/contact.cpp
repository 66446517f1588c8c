// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/contact.hpp"

#include <algorithm>

namespace reachcast {
namespace {

constexpr std::array kArms{Mover::left_forearm, Mover::right_forearm, Mover::left_hand, Mover::right_hand};

template <class Shape>
void add(Mover mover, const Shape& shape, const BodyCapsules& body, double least_m, std::vector<Contact>& contacts) {
  for (std::size_t i = 0; i < kFirstArm; ++i) {
    if (are_far(shape, body[i])) continue;
    const Penetration found = penetration(shape, body[i]);
    if (found.depth_m > least_m) contacts.push_back({mover, static_cast<BodyPart>(i), found.depth_m, found.direction});
  }
}

}  // namespace

std::string_view mover_name(Mover mover) {
  static constexpr std::array<std::string_view, kMoverCount> names{"left forearm", "right forearm", "left hand",
                                                                   "right hand", "box"};
  return names[index(mover)];
}

const Capsule& capsule_of(Mover mover, const BodyCapsules& body) {
  static_assert(index(BodyPart::right_hand) - index(BodyPart::left_forearm) == index(Mover::right_hand));
  return body[index(BodyPart::left_forearm) + index(mover)];
}

void add_contacts(Mover mover, const Capsule& capsule, const BodyCapsules& body, double least_depth_m,
                  std::vector<Contact>& contacts) {
  add(mover, capsule, body, least_depth_m, contacts);
}

std::vector<Contact> contacts_of(const BodyCapsules& body, const OrientedBox& box, double least_depth_m) {
  std::vector<Contact> contacts;
  for (const Mover mover : kArms) add(mover, capsule_of(mover, body), body, least_depth_m, contacts);
  add(Mover::box, box, body, least_depth_m, contacts);
  return contacts;
}

Depths depths_of(const BodyCapsules& body, const OrientedBox& box) {
  Depths depths{};
  for (const Contact& contact : contacts_of(body, box)) {
    double& deepest = depths[index(contact.mover)];
    deepest = std::max(deepest, contact.depth_m);
  }
  return depths;
}

}  // namespace reachcast
