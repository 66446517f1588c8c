// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/whole_body.hpp"

#include <algorithm>
#include <span>

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

void decode_chain(const ChainSpec& spec, const Chain& chain, const double* coordinates, const Vec3& start,
                  const Vec3& end, Posture& posture) {
  Points points(spec.joints.size());
  chain.decode(start, within_reach(chain, start, end), {coordinates, chain.coordinate_count()}, points);
  for (std::size_t i = 0; i < points.size(); ++i) posture[index(spec.joints[i])] = points[i];
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
  const std::vector<double> ones(spec.joints.size() - 1, 1.0);
  std::vector<std::size_t> pivots;
  for (const Joint joint : spec.pivots) pivots.push_back(position_in(spec, joint));
  return Chain(ones, pivots).coordinate_count();
}

/// Primary chain and parts; returns where the next coordinates go.
double* encode_trunk(const Linkage& linkage, const Posture& posture, double* out) {
  encode_chain(linkage.primary, posture, out);
  out += coordinates_of(linkage.primary);
  for (const RigidSpec& part : linkage.parts) {
    const Vec3 base = posture[index(part.b)] - posture[index(part.a)],
               apex = posture[index(part.apex)] - posture[index(part.a)];
    const double size = glm::length(base) * glm::length(apex);
    const Vec3 normal = size > 0.0 ? glm::cross(base, apex) / size : Vec3(0.0);
    for (int i = 0; i < 3; ++i) *out++ = normal[i];
  }
  return out;
}

/// How a part is turned in `posture` against a stand.
Mat3 turn_of(const RigidSpec& part, const Posture& stand, const Posture& posture) {
  const auto frame = [&](const Posture& p) {
    return triangle_frame(p[index(part.a)], p[index(part.b)], p[index(part.apex)]);
  };
  return frame(posture) * glm::transpose(frame(stand));
}

/// Level axes of the held object: x from the left grip to the right one.
Mat3 object_frame(const Posture& posture) {
  const Vec3 across = posture[index(Joint::right_grip)] - posture[index(Joint::left_grip)];
  const double size = std::hypot(across.x, across.y);
  const Vec3 x = size > 1e-6 ? Vec3(across.x / size, across.y / size, 0.0) : Vec3(1, 0, 0);
  return {x, Vec3(-x.y, x.x, 0.0), Vec3(0, 0, 1)};
}

Mat3 pointer_frame(const Linkage& linkage, const PointerSpec& pointer, const Posture& stand, const Posture& posture) {
  return pointer.part == PointerSpec::kObject ? object_frame(posture)
                                              : turn_of(linkage.parts[pointer.part], stand, posture);
}

/// The stand against which recordings are measured: they bring none of their own, and their trunk landmarks follow
/// the same proportions.
const Posture& upright() {
  static const Posture stand = Body::from_stature(1.7).posture();
  return stand;
}

/// The apex on its circle about a -> b, in the direction whose triangle has the stored normal; the riders follow.
void decode_part(const RigidSpec& part, const Body& body, const double* stored, Posture& posture) {
  const Vec3 a = posture[index(part.a)], b = posture[index(part.b)];
  const Vec3 normal(stored[0], stored[1], stored[2]);
  const Vec3 axis = glm::normalize(b - a);
  const Vec3 across = glm::cross(normal, axis);
  const double size = glm::length(across);
  const Mat3 rest = triangle_frame(body.at(part.a), body.at(part.b), body.at(part.apex));
  const Vec3 toward = size > 1e-9 ? across / size : glm::normalize(glm::cross(axis, Vec3(axis.y, axis.z, -axis.x)));
  const Mat3 frame(axis, toward, glm::cross(axis, toward));
  const Mat3 rotation = frame * glm::transpose(rest);
  posture[index(part.apex)] = a + rotation * (body.at(part.apex) - body.at(part.a));
  for (const Joint rider : part.riders) posture[index(rider)] = a + rotation * (body.at(rider) - body.at(part.a));
}

/// Parts that hang together at l5s1, midway between two ways of standing.
Posture mean_trunk(const Linkage& linkage, const Body& body, const Posture& one, const Posture& other) {
  Posture mean{};
  const Vec3 centre = 0.5 * (one[index(Joint::l5s1)] + other[index(Joint::l5s1)]);
  for (const RigidSpec& part : linkage.parts) {
    const Quat a = glm::quat_cast(turn_of(part, body.posture(), one)),
               b = glm::quat_cast(turn_of(part, body.posture(), other));
    const Mat3 rotation = glm::mat3_cast(glm::normalize(glm::dot(a, b) < 0.0 ? a - b : a + b));
    const auto place = [&](Joint j) { mean[index(j)] = centre + rotation * (body.at(j) - body.at(Joint::l5s1)); };
    for (const Joint j : {part.a, part.b, part.apex}) place(j);
    for (const Joint j : part.riders) place(j);
  }
  return mean;
}

}  // namespace

Anchors mirrored(const Anchors& anchors) {
  const auto flip = [](const std::array<Vec3, 2>& pair) {
    return std::array{Vec3(-pair[1].x, pair[1].y, pair[1].z), Vec3(-pair[0].x, pair[0].y, pair[0].z)};
  };
  return {flip(anchors.ball), flip(anchors.ankle), flip(anchors.grip)};
}

Mat3 triangle_frame(const Vec3& a, const Vec3& b, const Vec3& apex) {
  const Vec3 x = glm::normalize(b - a);
  const Vec3 z = glm::normalize(glm::cross(x, apex - a));
  return {x, glm::cross(z, x), z};
}

Anchors anchors_of(const Posture& p) {
  using enum Joint;
  return {{p[index(left_ball)], p[index(right_ball)]},
          {p[index(left_ankle)], p[index(right_ankle)]},
          {p[index(left_grip)], p[index(right_grip)]}};
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

Eigen::VectorXd encode_posture(const Linkage& linkage, const Posture& recorded) {
  const Posture posture = twisted(recorded, -facing_yaw(anchors_of(recorded)));
  Eigen::VectorXd out(posture_coordinate_count(linkage));
  double* next = encode_trunk(linkage, posture, out.data());
  next = encode_trunk(linkage, mirrored(posture), next);
  for (const PointerSpec& pointer : linkage.pointers) {
    const Mat3 turn = pointer_frame(linkage, pointer, upright(), posture);
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
      mirror_body_(Body::from_posture(mirrored(body.posture()), body.stature_m())),
      primary_(chain_of(linkage.primary, body.posture(), true)),
      mirror_primary_(chain_of(linkage.primary, mirror_body_.posture(), true)) {}

Decoded BodyLinkage::decode(const Eigen::Ref<const Eigen::VectorXd>& coordinates, const Anchors& wanted) const {
  const double yaw = facing_yaw(wanted);
  const Anchors anchors = with_grips_turned(wanted, -yaw);
  const std::size_t trunk_count = primary_.coordinate_count() + 3 * linkage_.parts.size();
  const double* next = coordinates.data();
  Posture posture =
      mean_trunk(linkage_, body_, trunk_of(next, body_, primary_, anchors),
                 mirrored(trunk_of(next + trunk_count, mirror_body_, mirror_primary_, mirrored(anchors))));
  next += 2 * trunk_count;
  place_pointed(anchors, next, posture);
  next += 3 * linkage_.pointers.size();
  Decoded decoded;
  for (std::size_t i = 0; i < kLimbCount; ++i) {
    const double turn = linkage_.limbs[i].turn * yaw;
    decoded.planes[i] = {turned({next[0], next[1], next[2]}, turn), turned({next[3], next[4], next[5]}, turn)};
    next += 6;
  }
  for (const std::size_t side : {0u, 1u}) {
    const Joint wrist = side == 0 ? Joint::left_wrist : Joint::right_wrist;
    decoded.wrist_from_grip[side] = turned(posture[index(wrist)] - anchors.grip[side], yaw);
    posture[index(side == 0 ? Joint::left_ankle : Joint::right_ankle)] = anchors.ankle[side];
  }
  decoded.trunk = turned_trunk(posture, yaw);
  return decoded;
}

Posture BodyLinkage::trunk_of(const double* stored, const Body& body, const Chain& primary,
                              const Anchors& anchors) const {
  Posture posture{};
  decode_chain(linkage_.primary, primary, stored, anchors.ball[0], anchors.grip[1], posture);
  stored += primary.coordinate_count();
  for (const RigidSpec& part : linkage_.parts) {
    decode_part(part, body, stored, posture);
    stored += 3;
  }
  return posture;
}

void BodyLinkage::place_pointed(const Anchors& anchors, const double* stored, Posture& posture) const {
  posture[index(Joint::left_grip)] = anchors.grip[0];
  posture[index(Joint::right_grip)] = anchors.grip[1];
  for (const PointerSpec& pointer : linkage_.pointers) {
    const Vec3 local(stored[0], stored[1], stored[2]);
    const double size = glm::length(local);
    const Vec3 direction = size > 1e-9 ? local / size : glm::normalize(body_.at(pointer.to) - body_.at(pointer.from));
    const Mat3 frame = pointer_frame(linkage_, pointer, body_.posture(), posture);
    posture[index(pointer.to)] =
        posture[index(pointer.from)] + frame * direction * body_.distance(pointer.from, pointer.to);
    stored += 3;
  }
}

void place_hands(const Body& body, const std::array<Vec3, 2>& wrist_from_grip, Posture& posture) {
  using enum Joint;
  for (const bool left : {true, false}) {
    const Joint wrist = left ? left_wrist : right_wrist;
    const Vec3 along = -wrist_from_grip[left ? 0 : 1];
    posture[index(left ? left_grip : right_grip)] = posture[index(wrist)] + along;
    for (const Joint j :
         left ? std::array{left_hand_front, left_hand_back} : std::array{right_hand_front, right_hand_back}) {
      posture[index(j)] = posture[index(wrist)] + glm::normalize(along) * body.distance(wrist, j);
    }
  }
}

}  // namespace reachcast
