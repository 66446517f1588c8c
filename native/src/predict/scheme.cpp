// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/scheme.hpp"

#include <algorithm>
#include <initializer_list>
#include <sstream>
#include <stdexcept>

namespace reachcast {
namespace {

using enum Trait;

constexpr double kLeast = 1e-6, kMost = 1e6;  // of bandwidth, ridge and scales: beyond them weights lose their digits

void require_within(const char* name, double value) {
  if (value >= kLeast && value <= kMost) return;
  std::ostringstream out;
  out << name << " is " << value << "; it must lie between " << kLeast << " and " << kMost;
  throw std::invalid_argument(out.str());
}

bool has_kernel(const Scheme& scheme) {
  return scheme.smoother == Smoother::kernel || scheme.smoother == Smoother::linear;
}

Scheme by(Measure measure, bool task, std::initializer_list<Trait> traits, int k,
          Smoother smoother = Smoother::triangular) {
  Scheme scheme{.k = k, .measure = measure, .task = task, .traits = {}, .smoother = smoother};
  for (const Trait trait : traits) scheme.traits[static_cast<std::size_t>(trait)] = true;
  return scheme;
}

void add_rank_sums(std::vector<Scheme>& schemes, bool task, std::initializer_list<Trait> traits,
                   std::initializer_list<int> ks, Smoother smoother = Smoother::triangular) {
  for (const int k : ks) schemes.push_back(by(Measure::ranks, task, traits, k, smoother));
}

}  // namespace

void check(const Scheme& scheme) {
  if (scheme.k < 1) throw std::invalid_argument("k is " + std::to_string(scheme.k) + "; it must be at least 1");
  const bool any = std::find(scheme.traits.begin(), scheme.traits.end(), true) != scheme.traits.end();
  if (!scheme.task && !any) throw std::invalid_argument("the scheme compares nothing; it must name at least one thing");
  require_within("bandwidth", scheme.bandwidth);
  require_within("ridge", scheme.ridge);
  if (scheme.task_scale_m != 0.0) require_within("the scale of task", scheme.task_scale_m);
  for (std::size_t t = 0; t < kTraitCount; ++t) {
    if (scheme.trait_scales[t] == 0.0) continue;
    require_within(("the scale of " + std::string(trait_name(static_cast<Trait>(t)))).c_str(), scheme.trait_scales[t]);
  }
}

std::string describe(const Scheme& scheme) {
  constexpr std::array<const char*, 4> smoothers{"uniform", "triangular", "kernel", "linear"};
  std::ostringstream out;
  out << (scheme.measure == Measure::ranks ? "ranks of " : "distances of ");
  const char* plus = "";
  if (scheme.task) out << "task", plus = " + ";
  for (std::size_t t = 0; t < kTraitCount; ++t) {
    if (!scheme.traits[t]) continue;
    out << plus << trait_name(static_cast<Trait>(t));
    plus = " + ";
  }
  out << ", " << scheme.k << ' ' << smoothers[static_cast<std::size_t>(scheme.smoother)];
  if (has_kernel(scheme)) out << ' ' << scheme.bandwidth;
  if (scheme.smoother == Smoother::linear) out << " ridge " << scheme.ridge;
  if (scheme.effective_sets() == Sets::one) out << ", one set";
  if (scheme.paths == PathForm::bezier) out << ", Bezier paths";
  if (scheme.postures == Average::poses) out << ", poses";
  if (!scheme.mirrored) out << ", no mirror images";
  return out.str();
}

std::vector<Scheme> paper_schemes() {
  std::vector<Scheme> schemes;
  add_rank_sums(schemes, true, {stature}, {1, 2, 3, 5, 8, 12});
  add_rank_sums(schemes, true, {stature}, {2, 3, 5, 8, 12}, Smoother::uniform);
  add_rank_sums(schemes, true, {}, {1, 3, 5, 8});
  add_rank_sums(schemes, false, {stature}, {3, 5, 8});
  add_rank_sums(schemes, true, {stature, age}, {3, 5, 8});
  add_rank_sums(schemes, true, {stature, sex}, {3, 5, 8});
  add_rank_sums(schemes, true, {stature, mass}, {3, 5, 8});
  add_rank_sums(schemes, true, {stature, duration}, {3, 5, 8});
  add_rank_sums(schemes, true, {stature, age, sex, mass, duration}, {3, 5, 8});
  return schemes;
}

std::vector<Scheme> all_schemes() {
  std::vector<Scheme> schemes = paper_schemes();
  const auto distances = [&](std::initializer_list<Trait> traits, int k, Smoother smoother = Smoother::triangular) {
    schemes.push_back(by(Measure::distances, true, traits, k, smoother));
  };
  for (const int k : {1, 3, 5, 8}) distances({stature}, k);
  for (const int k : {3, 5, 8}) distances({}, k);
  for (const int k : {1, 5}) {
    schemes.push_back(by(Measure::ranks, true, {stature}, k));
    schemes.back().mirrored = false;
  }
  for (const int k : {1, 3, 5, 8}) {
    schemes.push_back(by(Measure::ranks, true, {stature}, k));
    schemes.back().paths = PathForm::bezier;
  }
  for (const int k : {3, 5, 8}) {
    schemes.push_back(by(Measure::ranks, true, {stature}, k));
    schemes.back().sets = Sets::one;
  }
  for (const double bandwidth : {0.25, 0.5, 1.0}) {
    for (const bool with_stature : {true, false}) {
      with_stature ? distances({stature}, 20, Smoother::kernel) : distances({}, 20, Smoother::kernel);
      schemes.back().bandwidth = bandwidth;
    }
  }
  for (const auto& [bandwidth, ridge] : {std::pair{0.25, 0.1}, {0.5, 0.1}, {0.5, 1.0}, {1.0, 1.0}, {1.0, 10.0}}) {
    distances({stature}, 20, Smoother::linear);
    schemes.back().bandwidth = bandwidth;
    schemes.back().ridge = ridge;
  }
  return schemes;
}

}  // namespace reachcast
