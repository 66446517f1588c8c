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

void decode_chain(const ChainSpec& spec, const Chain& chain, const double* coordinates, const Vec3& start, const Vec3& end,
                  Posture& posture) {
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

}  // namespace

Mat3 triangle_frame(const Vec3& a, const Vec3& b, const Vec3& apex) {
  const Vec3 x = glm::normalize(b - a);
  const Vec3 z = glm::normalize(glm::cross(x, apex - a));
  return {x, glm::cross(z, x), z};
}

const std::array<ChainSpec, kLimbCount>& holding_limbs() {
  using enum Joint;
  static const auto limbs = [] {
    const auto limit_of = [](Joint joint) {
      for (const ChainSpec& spec : two_handed_linkage().limbs) {
        if (spec.limits.front().first == joint) return spec.limits.front().second;
      }
      return FlexionLimit{};
    };
    const FlexionLimit knee = limit_of(right_knee), elbow = limit_of(left_elbow);
    const auto leg = [&](Joint hip, Joint bend, Joint ankle) { return ChainSpec{"leg", {hip, bend, ankle}, {bend}, {{bend, knee}}}; };
    const auto arm = [&](Joint root, Joint shoulder, Joint bend, Joint wrist, Joint grip) {
      return ChainSpec{"arm", {root, shoulder, bend, wrist, grip}, {shoulder, wrist}, {{bend, elbow}}};
    };
    return std::array<ChainSpec, kLimbCount>{
        leg(left_hip, left_knee, left_ankle), leg(right_hip, right_knee, right_ankle),
        arm(left_clavicle, left_shoulder, left_elbow, left_wrist, left_grip),
        arm(right_clavicle, right_shoulder, right_elbow, right_wrist, right_grip)};
  }();
  return limbs;
}

Anchors anchors_of(const Posture& p) {
  using enum Joint;
  return {{p[index(left_ball)], p[index(right_ball)]},
          {p[index(left_ankle)], p[index(right_ankle)]},
          {p[index(left_grip)], p[index(right_grip)]}};
}

Eigen::Index posture_coordinate_count(const Linkage& linkage) {
  std::size_t count = coordinates_of(linkage.primary) + 3 * (linkage.parts.size() + linkage.pointers.size());
  for (const ChainSpec& limb : linkage.limbs) count += coordinates_of(limb);
  return static_cast<Eigen::Index>(count);
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
  double* next = out.data();
  encode_chain(linkage.primary, posture, next);
  next += coordinates_of(linkage.primary);
  for (const RigidSpec& part : linkage.parts) {
    const Vec3 base = posture[index(part.b)] - posture[index(part.a)], apex = posture[index(part.apex)] - posture[index(part.a)];
    const double size = glm::length(base) * glm::length(apex);
    const Vec3 normal = size > 0.0 ? glm::cross(base, apex) / size : Vec3(0.0);
    for (int i = 0; i < 3; ++i) *next++ = normal[i];
  }
  for (const ChainSpec& limb : linkage.limbs) {
    encode_chain(limb, posture, next);
    next += coordinates_of(limb);
  }
  for (const PointerSpec& pointer : linkage.pointers) {
    const RigidSpec& part = linkage.parts[pointer.part];
    const Mat3 frame = triangle_frame(posture[index(part.a)], posture[index(part.b)], posture[index(part.apex)]);
    const Vec3 local = glm::transpose(frame) * glm::normalize(posture[index(pointer.to)] - posture[index(pointer.from)]);
    for (int i = 0; i < 3; ++i) *next++ = local[i];
  }
  return out;
}

BodyLinkage::BodyLinkage(const Linkage& linkage, const Body& body)
    : linkage_(linkage), body_(body), primary_(chain_of(linkage.primary, body.posture(), true)) {
  for (const ChainSpec& limb : linkage.limbs) limbs_.push_back(chain_of(limb, body.posture(), true));
}

Decoded BodyLinkage::decode(const Eigen::Ref<const Eigen::VectorXd>& coordinates, const Anchors& wanted) const {
  using enum Joint;
  Posture posture{};
  const double yaw = facing_yaw(wanted);
  const Anchors anchors = with_grips_turned(wanted, -yaw);
  const double* next = coordinates.data();
  decode_chain(linkage_.primary, primary_, next, anchors.ball[0], anchors.grip[1], posture);
  next += primary_.coordinate_count();
  for (const RigidSpec& part : linkage_.parts) {
    decode_part(part, body_, next, posture);
    next += 3;
  }
  const std::map<Joint, Vec3> ends{{right_ball, anchors.ball[1]}, {left_grip, anchors.grip[0]}, {right_grip, anchors.grip[1]}};
  for (std::size_t i = 0; i < limbs_.size(); ++i) {
    const ChainSpec& spec = linkage_.limbs[i];
    decode_chain(spec, limbs_[i], next, posture[index(spec.joints.front())], ends.at(spec.joints.back()), posture);
    next += limbs_[i].coordinate_count();
  }
  for (const PointerSpec& pointer : linkage_.pointers) {
    const RigidSpec& part = linkage_.parts[pointer.part];
    const Mat3 frame = triangle_frame(posture[index(part.a)], posture[index(part.b)], posture[index(part.apex)]);
    const Vec3 local(next[0], next[1], next[2]);
    const Vec3 direction = glm::length(local) > 1e-9 ? glm::normalize(local) : Vec3(1, 0, 0);
    posture[index(pointer.to)] = posture[index(pointer.from)] + frame * direction * body_.distance(pointer.from, pointer.to);
    next += 3;
  }
  for (const Joint joint : {left_hand_front, left_hand_back, right_hand_front, right_hand_back}) {
    const bool left = joint == left_hand_front || joint == left_hand_back;
    const Vec3 wrist = posture[index(left ? left_wrist : right_wrist)], grip = posture[index(left ? left_grip : right_grip)];
    posture[index(joint)] = wrist + glm::normalize(grip - wrist) * body_.distance(left ? left_wrist : right_wrist, joint);
  }
  Decoded decoded;
  for (std::size_t i = 0; i < kLimbCount; ++i) decoded.limbs[i] = turned_limb_coordinates(i, posture, yaw);
  decoded.posture = twisted(posture, yaw);
  return decoded;
}

}  // namespace reachcast
