// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/blend.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "reachcast/motion/encode.hpp"

namespace reachcast {
namespace {

void require_length(std::int64_t id, const MotionCode& code) {
  if (code.coefficients.size() == code_length()) return;
  throw std::invalid_argument("motion " + std::to_string(id) + " of the corpus has " +
                              std::to_string(code.coefficients.size()) + " coefficients; this version needs " +
                              std::to_string(code_length()) + ": import the recordings again");
}

void mean_of(std::span<const WeightedCode> codes, const Query& query, MotionCode& mean) {
  mean.phase = query.phase;
  mean.home = query.home;
  mean.target = query.target;
  mean.coefficients.setZero(code_length());
  mean.duration_s = 0.0;
  double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
  EndpointPath path{decltype(EndpointPath::velocity)::Zero(), decltype(EndpointPath::deviation)::Zero()};
  for (const auto& [code, weight] : codes) {
    mean.coefficients += weight * code->coefficients;
    mean.duration_s += weight * code->duration_s;
    shortest = std::min(shortest, code->duration_s);
    longest = std::max(longest, code->duration_s);
    const EndpointPath own = carried(path_of(*code), code->target - code->home, query.target - query.home);
    path.velocity += weight * own.velocity;
    path.deviation += weight * own.deviation;
  }
  mean.duration_s = std::clamp(mean.duration_s, shortest, longest);
  set_path(mean, path);
}

/// Each motion once, by the mean of its weights in both sets.
std::vector<Share> merged(const std::vector<Share>& a, const std::vector<Share>& b) {
  std::vector<Share> all = a;
  all.insert(all.end(), b.begin(), b.end());
  std::stable_sort(all.begin(), all.end(), [](const Share& x, const Share& y) { return x.at < y.at; });
  std::vector<Share> once;
  for (const Share& share : all) {
    if (once.empty() || once.back().at != share.at) once.push_back({share.at, 0.0});
    once.back().weight += 0.5 * share.weight;
  }
  std::stable_sort(once.begin(), once.end(), [](const Share& x, const Share& y) { return x.weight > y.weight; });
  return once;
}

}  // namespace

void blend_codes(std::span<const WeightedCode> at_home, std::span<const WeightedCode> at_target, const Query& query,
                 Blend& blend) {
  mean_of(at_home, query, blend.from);
  if (at_target.empty()) {
    blend.to = blend.from;
    blend.whole = blend.from;
    return;
  }
  mean_of(at_target, query, blend.to);
  blend.whole = blend.from;
  blend.whole.coefficients = 0.5 * (blend.from.coefficients + blend.to.coefficients);
  blend.whole.duration_s = 0.5 * (blend.from.duration_s + blend.to.duration_s);
}

Blend blend_neighbours(const MotionTable& table, const Query& query, const Scheme& scheme, const CodeOf& code_of,
                       const LeftOut& left_out) {
  Search search(table, query, positions_of(table, query.phase, left_out));
  const auto shares_for = [&](End end) { return search.shares(scheme, end, search.nearest(scheme, end)); };
  const bool one = scheme.effective_sets() == Sets::one;
  const std::vector<Share> at_home = shares_for(one ? End::both : End::home);
  const std::vector<Share> at_target = one ? std::vector<Share>() : shares_for(End::target);
  Blend blend;
  for (const Share& share : merged(at_home, one ? at_home : at_target)) {
    blend.neighbours.push_back(named(table, query, share));
  }
  std::vector<std::shared_ptr<const MotionCode>> kept;
  const auto codes_of = [&](const std::vector<Share>& shares) {
    std::vector<WeightedCode> codes;
    for (const Share& share : shares) {
      const std::int64_t id = table.motions()[table.of(query.phase).rows[share.at]].id;
      kept.push_back(code_of(id));
      require_length(id, *kept.back());
      codes.push_back({kept.back().get(), share.weight});
    }
    return codes;
  };
  const std::vector<WeightedCode> home_codes = codes_of(at_home), target_codes = codes_of(at_target);
  blend_codes(home_codes, target_codes, query, blend);
  return blend;
}

double share_of_target(double t) {
  return t * t * (3.0 - 2.0 * t);
}

Eigen::VectorXd coordinates_at(const Blend& blend, double t) {
  const double share = share_of_target(t);
  return (1.0 - share) * coordinates_at(blend.from, t) + share * coordinates_at(blend.to, t);
}

}  // namespace reachcast
