// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/blend.hpp"

#include <algorithm>
#include <stdexcept>

#include "reachcast/motion/encode.hpp"

namespace reachcast {
namespace {

MotionCode mean_code(const std::vector<Neighbour>& neighbours, const Query& query, const CodeOf& code_of) {
  MotionCode mean;
  mean.phase = query.phase;
  mean.home = query.home;
  mean.target = query.target;
  mean.coefficients = Eigen::VectorXd::Zero(code_length());
  EndpointPath path{decltype(EndpointPath::velocity)::Zero(), decltype(EndpointPath::deviation)::Zero()};
  for (const Neighbour& neighbour : neighbours) {
    const std::shared_ptr<const MotionCode> code = code_of(neighbour.id);
    if (code->coefficients.size() != code_length()) {
      throw std::invalid_argument("motion " + std::to_string(neighbour.id) + " of the corpus has " +
                                  std::to_string(code->coefficients.size()) + " coefficients; this version needs " +
                                  std::to_string(code_length()) + ": import the recordings again");
    }
    mean.coefficients += neighbour.weight * code->coefficients;
    mean.duration_s += neighbour.weight * code->duration_s;
    const EndpointPath own = carried(path_of(*code), code->target - code->home, query.target - query.home);
    path.velocity += neighbour.weight * own.velocity;
    path.deviation += neighbour.weight * own.deviation;
  }
  set_path(mean, path);
  return mean;
}

std::vector<Neighbour> merged(const std::vector<Neighbour>& a, const std::vector<Neighbour>& b) {
  std::vector<Neighbour> all;
  for (const auto* set : {&a, &b}) {
    for (Neighbour n : *set) {
      n.weight *= 0.5;
      const auto found = std::find_if(all.begin(), all.end(), [&](const Neighbour& other) { return other.id == n.id; });
      if (found == all.end()) {
        all.push_back(n);
      } else {
        found->weight += n.weight;
      }
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Neighbour& x, const Neighbour& y) {
    return x.weight != y.weight ? x.weight > y.weight : x.id < y.id;
  });
  return all;
}

}  // namespace

Blend blend_neighbours(const MotionTable& table, const Query& query, int k, const CodeOf& code_of,
                       const LeftOut& left_out) {
  const std::vector<Neighbour> at_home = nearest_motions(table, query, End::home, k, left_out);
  const std::vector<Neighbour> at_target = nearest_motions(table, query, End::target, k, left_out);
  Blend blend;
  blend.neighbours = merged(at_home, at_target);
  blend.from = mean_code(at_home, query, code_of);
  blend.to = mean_code(at_target, query, code_of);
  blend.whole = mean_code(blend.neighbours, query, code_of);
  return blend;
}

Eigen::VectorXd coordinates_at(const Blend& blend, double t) {
  const double share = t * t * (3.0 - 2.0 * t);
  return (1.0 - share) * coordinates_at(blend.from, t) + share * coordinates_at(blend.to, t);
}

}  // namespace reachcast
