// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/chain.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "reachcast/posture/stretch.hpp"

namespace reachcast {
namespace {

constexpr double kReachTolerance_m = 1e-9;  // decode clamps this much: rounding of a distance computed elsewhere
// A bend is the square root of a gap in the triangle inequality, so that rounding of 1e-16 would bend a straight or
// folded chain by 1e-8. Gaps below this share of the chain's span count as none.
constexpr double kFlat = 1e-13;
constexpr double kUsualNormal = 1e-12;  // squares of normals, and of their parts, that leave no doubt

template <class... Parts>
[[noreturn]] void fail(const Parts&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  throw std::invalid_argument(out.str());
}

Vec3 any_perpendicular(const Vec3& axis) {
  const Vec3 a = glm::abs(axis);
  const Vec3 least = a.x <= a.y && a.x <= a.z ? Vec3(1, 0, 0) : (a.y <= a.z ? Vec3(0, 1, 0) : Vec3(0, 0, 1));
  return glm::normalize(glm::cross(axis, least));
}

/// 2004 paper p. 543: three numbers, projected back orthogonal to the axis and normalised.
Vec3 usable_normal(const Vec3& stored, const Vec3& axis) {
  const double largest = std::max({std::abs(stored.x), std::abs(stored.y), std::abs(stored.z)});
  const Vec3 scaled = largest > 1e-12 ? stored / largest : Vec3(0.0);  // its square neither overflows nor vanishes
  const Vec3 flat = scaled - glm::dot(scaled, axis) * axis;
  const double size = glm::length(flat);
  return size > 1e-9 ? flat / size : any_perpendicular(axis);
}

/// Reach of two single links under a hinge limit, by the law of cosines.
Interval hinge_reach(double a, double b, const FlexionLimit& limit) {
  const auto across = [&](double flexion) {
    return std::sqrt(std::max(0.0, a * a + b * b + 2.0 * a * b * std::cos(flexion)));
  };
  return {limit.max_rad >= kPi ? std::abs(a - b) : across(limit.max_rad),
          limit.min_rad <= 0.0 ? a + b : across(limit.min_rad)};
}

void check_arguments(const std::vector<double>& lengths, const std::vector<std::size_t>& pivots) {
  if (lengths.empty()) fail("lengths is empty; a chain has at least one link");
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    if (!(lengths[i] > 0.0 && lengths[i] <= 1e6)) {
      fail("lengths[", i, "] is ", lengths[i], "; it must be positive and at most 1e6");
    }
  }
  std::set<std::size_t> seen;
  for (const std::size_t p : pivots) {
    if (p < 1 || p >= lengths.size()) fail("pivots holds ", p, "; interior joints are 1 to ", lengths.size() - 1);
    if (!seen.insert(p).second) fail("pivots holds ", p, " twice");
  }
}

}  // namespace

Vec3 pivot_point(const Vec3& start, const Vec3& end, double proximal_m, double distal_m, const Vec3& normal) {
  const double c = glm::distance(start, end);
  if (c <= 1e-12) {
    const Vec3 axis = any_perpendicular(usable_normal(normal, Vec3(0, 0, 1)));
    return start + glm::cross(axis, usable_normal(normal, axis)) * proximal_m;
  }
  return pivot_point(start, (end - start) / c, c, proximal_m, distal_m, normal);
}

Vec3 pivot_point(const Vec3& start, const Vec3& axis, double across_m, double proximal_m, double distal_m,
                 const Vec3& normal) {
  const double along = (across_m * across_m + (proximal_m - distal_m) * (proximal_m + distal_m)) / (2.0 * across_m);
  const double gap = std::min(proximal_m + distal_m - across_m, across_m - std::abs(proximal_m - distal_m));
  if (gap <= kFlat * (proximal_m + distal_m)) return start + axis * std::copysign(proximal_m, along);
  const double height_squared = std::max(0.0, (proximal_m - along) * (proximal_m + along));
  const Vec3 side = glm::cross(axis, normal);
  const double whole = glm::dot(normal, normal), across = glm::dot(side, side);
  if (whole > kUsualNormal && whole < 1.0 / kUsualNormal && across > kUsualNormal * whole)
    return start + axis * along + side * std::sqrt(height_squared / across);
  return start + axis * along + glm::cross(axis, usable_normal(normal, axis)) * std::sqrt(height_squared);
}

Chain::Chain(std::vector<double> lengths, std::vector<std::size_t> pivots,
             const std::map<std::size_t, FlexionLimit>& limits)
    : lengths_(std::move(lengths)) {
  check_arguments(lengths_, pivots);
  for (const auto& [joint, limit] : limits) {
    if (joint < 1 || joint >= lengths_.size())
      fail("limits names joint ", joint, "; interior joints are 1 to ", lengths_.size() - 1);
    if (!(limit.min_rad >= 0.0 && limit.min_rad <= limit.max_rad && limit.max_rad <= kPi)) {
      fail("limits of joint ", joint, " are ", limit.min_rad, " to ", limit.max_rad, "; they must rise within 0 to pi");
    }
  }
  std::vector<std::size_t> order = std::move(pivots);
  for (std::size_t j = 1; j < lengths_.size(); ++j) {
    if (std::find(order.begin(), order.end(), j) == order.end()) order.push_back(j);
  }
  build(0, lengths_.size(), order, limits, root_reach_);
}

int Chain::build(std::size_t first, std::size_t last, const std::vector<std::size_t>& order,
                 const std::map<std::size_t, FlexionLimit>& limits, Interval& reach) {
  if (last - first == 1) {
    reach = {lengths_[first], lengths_[first]};
    return -1;
  }
  const auto found = std::find_if(order.begin(), order.end(), [&](std::size_t j) { return j > first && j < last; });
  const int self = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.first = first, node.pivot = *found, node.last = last;
  node.stretches = (node.pivot - first > 1 ? 1 : 0) + (last - node.pivot > 1 ? 1 : 0);
  node.offset = coordinate_count_;
  coordinate_count_ += static_cast<std::size_t>(node.stretches) + 3;
  node.proximal = build(first, node.pivot, order, limits, node.proximal_reach);
  node.distal = build(node.pivot, last, order, limits, node.distal_reach);
  reach = {
      std::max({0.0, node.proximal_reach.lo - node.distal_reach.hi, node.distal_reach.lo - node.proximal_reach.hi}),
      node.proximal_reach.hi + node.distal_reach.hi};
  if (const auto limit = limits.find(node.pivot); limit != limits.end()) {
    if (node.stretches != 0) {
      fail("limits of joint ", node.pivot,
           " need it to be the pivot between two single links; here its sub-chain is joints ", first, " to ", last);
    }
    reach = hinge_reach(lengths_[first], lengths_[first + 1], limit->second);
  }
  nodes_[static_cast<std::size_t>(self)] = node;
  return self;
}

void Chain::encode(std::span<const Vec3> points, std::span<double> coordinates) const {
  for (const Node& node : nodes_) {
    const Vec3 a = points[node.first], m = points[node.pivot], b = points[node.last];
    const double lp = glm::distance(a, m), ld = glm::distance(m, b), c = glm::distance(a, b);
    double* out = &coordinates[node.offset];
    const StretchDomain domain(node.proximal_reach, node.distal_reach, c);
    if (node.stretches == 2) {
      const auto [qs, qd] = domain.fractions(lp, ld);
      out[0] = to_logit(qs);
      out[1] = to_logit(qd);
    } else if (node.stretches == 1) {
      out[0] = to_logit(node.proximal < 0 ? domain.distal_fraction(ld) : domain.proximal_fraction(lp));
    }
    const Vec3 bend = lp > 0.0 && ld > 0.0 ? glm::cross(m - a, b - m) / (lp * ld) : Vec3(0.0);
    for (int i = 0; i < 3; ++i) out[node.stretches + i] = bend[i];
  }
}

void Chain::decode(const Vec3& start, const Vec3& end, std::span<const double> coordinates,
                   std::span<Vec3> points) const {
  place_ends(start, end, points);
  for (const Node& node : nodes_) decode_node(node, coordinates, points);
}

void Chain::decode(const Vec3& start, const Vec3& end, std::span<const double> coordinates,
                   std::span<const std::size_t> steps, std::span<Vec3> points) const {
  place_ends(start, end, points);
  for (const std::size_t step : steps) decode_node(nodes_[step], coordinates, points);
}

std::vector<std::size_t> Chain::steps_to(std::span<const std::size_t> joints) const {
  std::vector<bool> needed(nodes_.size());
  for (std::size_t i = nodes_.size(); i-- > 0;) {  // children before parents
    const Node& node = nodes_[i];
    const auto is_needed = [&](int child) { return child >= 0 && needed[static_cast<std::size_t>(child)]; };
    needed[i] = std::find(joints.begin(), joints.end(), node.pivot) != joints.end() || is_needed(node.proximal) ||
                is_needed(node.distal);
  }
  std::vector<std::size_t> steps;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (needed[i]) steps.push_back(i);
  }
  return steps;
}

void Chain::place_ends(const Vec3& start, const Vec3& end, std::span<Vec3> points) const {
  const double across = glm::distance(start, end);
  if (!(across <= root_reach_.hi + kReachTolerance_m && across >= root_reach_.lo - kReachTolerance_m)) {
    fail("the ends are ", across, " m apart; the chain spans ", root_reach_.lo, " to ", root_reach_.hi, " m");
  }
  points[0] = start;
  points[links()] = end;
}

void Chain::decode_node(const Node& node, std::span<const double> coordinates, std::span<Vec3> points) const {
  const Vec3 a = points[node.first], b = points[node.last];
  const double* in = &coordinates[node.offset];
  double lp = node.proximal_reach.hi, ld = node.distal_reach.hi;
  if (node.stretches > 0) {
    const StretchDomain domain(node.proximal_reach, node.distal_reach, glm::distance(a, b));
    if (node.stretches == 2) {
      std::tie(lp, ld) = domain.lengths(from_logit(in[0]), from_logit(in[1]));
    } else if (node.proximal < 0) {
      ld = domain.distal_length(from_logit(in[0]));
    } else {
      lp = domain.proximal_length(from_logit(in[0]));
    }
  }
  const Vec3 normal(in[node.stretches], in[node.stretches + 1], in[node.stretches + 2]);
  points[node.pivot] = pivot_point(a, b, lp, ld, normal);
}

}  // namespace reachcast
