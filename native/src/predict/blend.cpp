// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/blend.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "reachcast/motion/encode.hpp"

namespace reachcast {
namespace {

void require_length(std::int64_t id, const MotionCode& code) {
  if (code.coefficients.size() == code_length()) return;
  throw std::invalid_argument("motion " + std::to_string(id) + " of the corpus has " +
                              std::to_string(code.coefficients.size()) + " coefficients; this version needs " +
                              std::to_string(code_length()) + ": import the recordings again");
}

/// Sum of the codes' coefficients times their weights, paths carried onto the wanted axis.
Eigen::VectorXd sum_of(std::span<const WeightedCode> codes, const Query& query) {
  MotionCode sum;
  sum.coefficients.setZero(code_length());
  EndpointPath path{decltype(EndpointPath::velocity)::Zero(), decltype(EndpointPath::deviation)::Zero()};
  AxisCurve curve{{Vec3(0.0), Vec3(0.0)}, {0.0, 0.0}};
  const Vec3 wanted = query.target - query.home;
  for (const auto& [code, weight] : codes) {
    const Vec3 axis = code->target - code->home;
    sum.coefficients += weight * code->coefficients;
    const EndpointPath own = carried(path_of(*code), axis, wanted);
    path.velocity += weight * own.velocity;
    path.deviation += weight * own.deviation;
    const AxisCurve bent = carried(curve_of(*code), axis, wanted);
    for (std::size_t i = 0; i < curve.offsets.size(); ++i) curve.offsets[i] += weight * bent.offsets[i];
    curve.speed.alpha += weight * bent.speed.alpha;
    curve.speed.beta += weight * bent.speed.beta;
  }
  set_path(sum, path);
  set_curve(sum, curve);
  return std::move(sum.coefficients);
}

/// Some weights may be negative: exponents are brought back to where they belong.
void clamp_exponents(MotionCode& code) {
  AxisCurve curve = curve_of(code);
  for (double* exponent : {&curve.speed.alpha, &curve.speed.beta})
    *exponent = std::clamp(*exponent, kLeastExponent, kMostExponent);
  set_curve(code, curve);
}

void mean_of(std::span<const WeightedCode> codes, const Query& query, MotionCode& mean) {
  mean.phase = query.phase;
  mean.hands = query.hands;
  mean.home = query.home;
  mean.target = query.target;
  mean.coefficients = sum_of(codes, query);
  clamp_exponents(mean);
  mean.duration_s = 0.0;
  double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
  for (const auto& [code, weight] : codes) {
    mean.duration_s += weight * code->duration_s;
    shortest = std::min(shortest, code->duration_s);
    longest = std::max(longest, code->duration_s);
  }
  mean.duration_s = std::clamp(mean.duration_s, shortest, longest);
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

/// Each code once, with its weights in both sets.
std::vector<PosturePart> parts_of(std::span<const WeightedCode> at_home, std::span<const WeightedCode> at_target) {
  std::vector<PosturePart> parts;
  std::vector<const MotionCode*> known;
  const auto part_of = [&](const MotionCode* code) -> PosturePart& {
    const auto found = std::find(known.begin(), known.end(), code);
    if (found != known.end()) return parts[static_cast<std::size_t>(found - known.begin())];
    known.push_back(code);
    return parts.emplace_back(PosturePart{posture_curves(*code), 0.0, 0.0});
  };
  for (const auto& [code, weight] : at_home) part_of(code).at_home += weight;
  for (const auto& [code, weight] : at_target.empty() ? at_home : at_target) part_of(code).at_target += weight;
  if (parts.size() == 1) parts.clear();
  return parts;
}

}  // namespace

void blend_codes(std::span<const WeightedCode> at_home, std::span<const WeightedCode> at_target, const Query& query,
                 Average postures, Blend& blend) {
  blend.parts.clear();
  if (postures == Average::poses) blend.parts = parts_of(at_home, at_target);
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
  Search search(table, query, positions_of(table, query, left_out));
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
      const std::int64_t id = table.motions()[table.of(query.phase, query.hands).rows[share.at]].id;
      kept.push_back(code_of(id));
      require_length(id, *kept.back());
      codes.push_back({kept.back().get(), share.weight});
    }
    return codes;
  };
  const std::vector<WeightedCode> home_codes = codes_of(at_home), target_codes = codes_of(at_target);
  blend_codes(home_codes, target_codes, query, scheme.postures, blend);
  return blend;
}

void vary(std::span<const std::shared_ptr<const MotionCode>> codes, std::span<const double> normal, const Query& query,
          Blend& blend) {
  const auto count = static_cast<double>(codes.size());
  const double mean = std::accumulate(normal.begin(), normal.end(), 0.0) / count;
  std::vector<WeightedCode> differences;
  double longer = 0.0, shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    require_length(0, *codes[i]);
    differences.push_back({codes[i].get(), (normal[i] - mean) / std::sqrt(count - 1.0)});
    longer += differences.back().weight * std::log(codes[i]->duration_s);
    shortest = std::min(shortest, codes[i]->duration_s);
    longest = std::max(longest, codes[i]->duration_s);
  }
  const Eigen::VectorXd change = sum_of(differences, query);
  for (MotionCode* code : {&blend.from, &blend.to, &blend.whole}) {
    code->coefficients += change;
    clamp_exponents(*code);
    code->duration_s = std::clamp(code->duration_s * std::exp(longer), shortest, longest);
  }
  MotionCode changed;
  changed.coefficients = change;
  for (PosturePart& part : blend.parts) part.curves += posture_curves(changed);
}

void reverse(Blend& blend) {
  std::swap(blend.from, blend.to);
  for (MotionCode* code : {&blend.from, &blend.to, &blend.whole}) *code = reversed(*code);
  for (PosturePart& part : blend.parts) {
    part.curves = part.curves.rowwise().reverse().eval();
    std::swap(part.at_home, part.at_target);
  }
}

EndpointWay way_of(const MotionCode& code, PathForm form) {
  if (form == PathForm::deviation) return path_of(code);
  return curve_of(code);
}

double share_of_target(double t) {
  return t * t * (3.0 - 2.0 * t);
}

Eigen::VectorXd coordinates_at(const Blend& blend, double t) {
  const double share = share_of_target(t);
  return (1.0 - share) * coordinates_at(blend.from, t) + share * coordinates_at(blend.to, t);
}

}  // namespace reachcast
