// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/whole_body.hpp"

#include <algorithm>
#include <span>

#include "reachcast/posture/straight_chest.hpp"
#include "reachcast/posture/twist.hpp"

namespace reachcast {
namespace {

constexpr double kLargestLogit = 5.0;  // q within 0.7 % of its bounds

std::size_t position_in(const ChainSpec& spec, Joint joint) {
  return static_cast<std::size_t>(std::find(spec.joints.begin(), spec.joints.end(), joint) - spec.joints.begin());
}

/// `end` moved along the line from `start` to where the chain can just reach.
Vec3 within_reach(const Chain& chain, const Vec3& start, const Vec3& end) {
  const double across = glm::distance(start, end), wanted = std::clamp(across, chain.reach().lo, chain.reach().hi);
  if (across == wanted) return end;
  const Vec3 away = across > 1e-9 ? (end - start) / across : Vec3(0, 0, -1);
  return start + away * wanted;
}

void encode_chain(const ChainSpec& spec, const Posture& posture, double* out) {
  const Chain chain = chain_of(spec, posture, false);
  Points points;
  for (const Joint joint : spec.joints) points.push_back(posture[index(joint)]);
  const std::span coordinates(out, chain.coordinate_count());
  chain.encode(points, coordinates);
  for (double& x : coordinates) x = std::clamp(x, -kLargestLogit, kLargestLogit);
}

std::size_t coordinates_of(const ChainSpec& spec) {
  return Chain::coordinate_count(spec.joints.size() - 1);
}

/// Primary chain and parts; returns where the next coordinates go. `straight`: the posture with a straight chest.
double* encode_trunk(const Linkage& linkage, const Posture& posture, const Posture& straight, double* out) {
  encode_chain(linkage.primary, posture, out);
  out += coordinates_of(linkage.primary);
  for (const RigidSpec& part : linkage.parts) {
    const Vec3 base = straight[index(part.b)] - straight[index(part.a)],
               apex = straight[index(part.apex)] - straight[index(part.a)];
    const double size = glm::length(base) * glm::length(apex);
    const Vec3 normal = size > 0.0 ? glm::cross(base, apex) / size : Vec3(0.0);
    for (int i = 0; i < 3; ++i) *out++ = normal[i];
  }
  return out;
}

Mat3 frame_of(const RigidSpec& part, const Posture& posture) {
  return triangle_frame(posture[index(part.a)], posture[index(part.b)], posture[index(part.apex)]);
}

/// How a part is turned in `posture` against a stand.
Mat3 turn_of(const RigidSpec& part, const Posture& stand, const Posture& posture) {
  return frame_of(part, posture) * glm::transpose(frame_of(part, stand));
}

/// Level axes of the held object: x from the left grip to the right one; those of the person who faces it where one
/// hand holds it.
Mat3 object_frame(const std::array<Vec3, 2>& grips, Hands hands) {
  if (hands != Hands::both) return Mat3(1.0);
  const Vec3 across = grips[1] - grips[0];
  const double size = std::hypot(across.x, across.y);
  const Vec3 x = size > 1e-6 ? Vec3(across.x / size, across.y / size, 0.0) : Vec3(1, 0, 0);
  return {x, Vec3(-x.y, x.x, 0.0), Vec3(0, 0, 1)};
}

/// The stand against which recordings are measured: they bring none of their own, and their trunk landmarks follow
/// the same proportions.
const Body& upright() {
  static const Body stand = Body::from_stature(1.7);
  return stand;
}

/// The frame of a part whose a and b are there: its apex lies on a circle about them, in the direction whose triangle
/// has the stored normal.
Mat3 frame_about(const Vec3& a, const Vec3& b, const Vec3& normal) {
  const Vec3 axis = glm::normalize(b - a);
  const Vec3 across = glm::cross(normal, axis);
  const double size = glm::length(across);
  const Vec3 toward = size > 1e-9 ? across / size : glm::normalize(glm::cross(axis, Vec3(axis.y, axis.z, -axis.x)));
  return {axis, toward, glm::cross(axis, toward)};
}

/// A turn as seen in a mirror that exchanges left and right.
Quat mirrored_turn(const Quat& turn) {
  return {turn.w, turn.x, -turn.y, -turn.z};
}

Quat middle_turn(const Quat& one, const Quat& other) {
  return glm::normalize(glm::dot(one, other) < 0.0 ? one - other : one + other);
}

Vec3 mirrored_point(const Vec3& p) {
  return {-p.x, p.y, p.z};
}

Vec3 direction(const double* stored, const Vec3& otherwise) {
  const Vec3 local(stored[0], stored[1], stored[2]);
  const double size = glm::length(local);
  return size > 1e-9 ? local / size : glm::normalize(otherwise);
}

/// How a part is turned against the stand: the middle of what the two sides say, as decoding has it. They differ where
/// a recording has both clavicle roots in one point and the stand has not.
Mat3 turn_of_both_sides(const RigidSpec& part, const Posture& stand, const Posture& posture) {
  const Quat one = glm::quat_cast(turn_of(part, stand, posture)),
             other = mirrored_turn(glm::quat_cast(turn_of(part, mirrored(stand), mirrored(posture))));
  return glm::mat3_cast(middle_turn(one, other));
}

}  // namespace

Mat3 triangle_frame(const Vec3& a, const Vec3& b, const Vec3& apex) {
  const Vec3 x = glm::normalize(b - a);
  const Vec3 z = glm::normalize(glm::cross(x, apex - a));
  return {x, glm::cross(z, x), z};
}

Eigen::Index posture_coordinate_count(const Linkage& linkage) {
  const std::size_t trunk = coordinates_of(linkage.primary) + 3 * linkage.parts.size();
  const std::size_t count = 2 * trunk + 3 * linkage.pointers.size();
  return static_cast<Eigen::Index>(count + 6 * kLimbCount);
}

Chain chain_of(const ChainSpec& spec, const Posture& posture, bool limited) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i + 1 < spec.joints.size(); ++i) {
    lengths.push_back(glm::distance(posture[index(spec.joints[i])], posture[index(spec.joints[i + 1])]));
  }
  std::vector<std::size_t> pivots;
  for (const Joint joint : spec.pivots) pivots.push_back(position_in(spec, joint));
  std::map<std::size_t, FlexionLimit> limits;
  if (limited) {
    for (const auto& [joint, limit] : spec.limits) limits.emplace(position_in(spec, joint), limit);
  }
  return {std::move(lengths), std::move(pivots), std::move(limits)};
}

Eigen::VectorXd encode_posture(const Linkage& linkage, const Posture& recorded, double bend_rad, Hands hands) {
  const Posture posture = twisted(recorded, -facing_yaw(anchors_of(recorded, hands)), hands);
  const Posture straight = straight_chest(posture, bend_rad);
  const Posture& stand = upright().posture();
  const Mat3 upper = bent_stand(upright(), bend_rad).upper;
  const Mat3 object = object_frame(anchors_of(posture).grip, hands);
  Eigen::VectorXd out(posture_coordinate_count(linkage));
  double* next = encode_trunk(linkage, posture, straight, out.data());
  next = encode_trunk(linkage, mirrored(posture), mirrored(straight), next);
  for (const PointerSpec& pointer : linkage.pointers) {
    Mat3 turn = object;
    if (pointer.part != PointerSpec::kObject) turn = turn_of_both_sides(linkage.parts[pointer.part], stand, straight);
    if (pointer.part == kChest) turn = turn * upper;
    const Vec3 local = glm::transpose(turn) * glm::normalize(posture[index(pointer.to)] - posture[index(pointer.from)]);
    for (int i = 0; i < 3; ++i) *next++ = local[i];
  }
  for (const LimbSpec& limb : linkage.limbs) {
    const LimbPlane plane = plane_of(limb, posture);
    for (int i = 0; i < 3; ++i) *next++ = plane.normal[i];
    for (int i = 0; i < 3; ++i) *next++ = plane.axis[i];
  }
  return out;
}

BodyLinkage::BodyLinkage(const Linkage& linkage, const Body& body)
    : linkage_(linkage),
      body_(body),
      sides_{side_of(body.posture(), body.posture()), side_of(mirrored(body.posture()), mirrored(body.posture()))},
      waist_(position_in(linkage.primary, Joint::l5s1)) {
  for (const PointerSpec& pointer : linkage.pointers)
    pointer_lengths_.push_back(body.distance(pointer.from, pointer.to));
}

BodyLinkage::Side BodyLinkage::side_of(const Posture& stand, const Posture& straight) const {
  std::vector<std::size_t> joints{position_in(linkage_.primary, Joint::l5s1)};
  for (const RigidSpec& part : linkage_.parts) {
    for (const Joint joint : {part.a, part.b}) joints.push_back(position_in(linkage_.primary, joint));
  }
  Side side{chain_of(linkage_.primary, stand, true), {}, {}};
  side.steps = side.primary.steps_to(joints);
  for (std::size_t i = 0; i < kPartCount; ++i) {
    const RigidSpec& part = linkage_.parts[i];
    const Vec3 base = straight[index(part.b)] - straight[index(part.a)];
    const Vec3 normal = glm::cross(base, straight[index(part.apex)] - straight[index(part.a)]);
    side.to_own_frame[i] = glm::transpose(frame_about(stand[index(part.a)], stand[index(part.b)], normal));
  }
  return side;
}

Decoded BodyLinkage::decode(const Eigen::Ref<const Eigen::VectorXd>& coordinates, const Anchors& wanted,
                            double bend_rad) const {
  const double yaw = facing_yaw(wanted);
  const Anchors anchors = with_grips_turned(wanted, -yaw);
  const double* next = coordinates.data();
  const std::size_t trunk_count = sides_[0].primary.coordinate_count() + 3 * kPartCount;
  const BentStand stand = bent_stand(body_, bend_rad);
  const Trunk trunk = bend_rad == 0.0 ? trunk_of(sides_, next, anchors)
                                      : trunk_of({side_of(stand.posture, body_.posture()),
                                                  side_of(mirrored(stand.posture), mirrored(body_.posture()))},
                                                 next, anchors);
  next += 2 * trunk_count;
  Posture posture{};
  for (const std::size_t side : {0u, 1u}) {
    posture[index(side == 0 ? Joint::left_grip : Joint::right_grip)] = anchors.grip[side];
    posture[index(side == 0 ? Joint::left_ankle : Joint::right_ankle)] = anchors.ankle[side];
  }
  place_trunk(trunk, stand, next, object_frame(anchors.grip, anchors.hands), posture);
  next += 3 * linkage_.pointers.size();
  Decoded decoded;
  decoded.bend_rad = bend_rad;
  for (std::size_t i = 0; i < kLimbCount; ++i) {
    const Yaw turn(linkage_.limbs[i].turn * yaw);
    decoded.planes[i] = {turn({next[0], next[1], next[2]}), turn({next[3], next[4], next[5]})};
    next += 6;
  }
  for (const std::size_t side : {0u, 1u}) {
    const Joint wrist = side == 0 ? Joint::left_wrist : Joint::right_wrist;
    decoded.wrist_from_grip[side] = turned(posture[index(wrist)] - anchors.grip[side], yaw);
  }
  decoded.trunk = turned_trunk(posture, yaw);
  return decoded;
}

BodyLinkage::Trunk BodyLinkage::trunk_of(const std::array<Side, 2>& sides, const double* stored,
                                         const Anchors& anchors) const {
  if (anchors.hands == Hands::right) return trunk_of(sides[0], stored, anchors);
  const std::size_t count = sides[0].primary.coordinate_count() + 3 * kPartCount;
  Trunk image = trunk_of(sides[1], stored + count, mirrored(anchors));
  image.waist = mirrored_point(image.waist);
  for (Quat& turn : image.turns) turn = mirrored_turn(turn);
  if (anchors.hands == Hands::left) return image;
  Trunk trunk = trunk_of(sides[0], stored, anchors);
  trunk.waist = 0.5 * (trunk.waist + image.waist);
  for (std::size_t i = 0; i < kPartCount; ++i) trunk.turns[i] = middle_turn(trunk.turns[i], image.turns[i]);
  return trunk;
}

BodyLinkage::Trunk BodyLinkage::trunk_of(const Side& side, const double* stored, const Anchors& anchors) const {
  std::array<Vec3, kJointCount> points;
  const Vec3 start = anchors.ball[0];
  side.primary.decode(start, within_reach(side.primary, start, anchors.grip[1]),
                      {stored, side.primary.coordinate_count()}, side.steps, points);
  stored += side.primary.coordinate_count();
  Trunk trunk;
  trunk.waist = points[waist_];
  for (std::size_t i = 0; i < kPartCount; ++i, stored += 3) {
    const RigidSpec& part = linkage_.parts[i];
    const Vec3 a = points[position_in(linkage_.primary, part.a)], b = points[position_in(linkage_.primary, part.b)];
    const Vec3 normal(stored[0], stored[1], stored[2]);
    trunk.turns[i] = glm::quat_cast(frame_about(a, b, normal) * side.to_own_frame[i]);
  }
  return trunk;
}

void BodyLinkage::place_trunk(const Trunk& trunk, const BentStand& stand, const double* pointers, const Mat3& object,
                              Posture& posture) const {
  std::array<Mat3, kPartCount> turns;
  const Vec3 waist = body_.at(Joint::l5s1);
  for (std::size_t i = 0; i < kPartCount; ++i) {
    const RigidSpec& part = linkage_.parts[i];
    turns[i] = glm::mat3_cast(trunk.turns[i]);
    const auto place = [&](Joint j) { posture[index(j)] = trunk.waist + turns[i] * (stand.posture[index(j)] - waist); };
    for (const Joint j : {part.a, part.b, part.apex}) place(j);
    for (const Joint j : part.riders) place(j);
  }
  turns[kChest] = turns[kChest] * stand.upper;
  for (std::size_t i = 0; i < linkage_.pointers.size(); ++i, pointers += 3) {
    const PointerSpec& pointer = linkage_.pointers[i];
    const Mat3& frame = pointer.part == PointerSpec::kObject ? object : turns[pointer.part];
    const Vec3 along = direction(pointers, body_.at(pointer.to) - body_.at(pointer.from));
    posture[index(pointer.to)] = posture[index(pointer.from)] + frame * along * pointer_lengths_[i];
  }
}

void place_hands(const Body& body, const std::array<Vec3, 2>& wrist_from_grip, Posture& posture) {
  using enum Joint;
  for (const bool left : {true, false}) {
    const Joint wrist = left ? left_wrist : right_wrist;
    const Vec3 along = -wrist_from_grip[left ? 0 : 1], direction = glm::normalize(along);
    posture[index(left ? left_grip : right_grip)] = posture[index(wrist)] + along;
    for (const Joint j :
         left ? std::array{left_hand_front, left_hand_back} : std::array{right_hand_front, right_hand_back}) {
      posture[index(j)] = posture[index(wrist)] + direction * body.distance(wrist, j);
    }
  }
}

}  // namespace reachcast
