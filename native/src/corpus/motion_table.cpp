// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/corpus/motion_table.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reachcast {
namespace {

double or_missing(const std::optional<double>& value) {
  return value.value_or(kMissing);
}

}  // namespace

std::string_view trait_name(Trait trait) {
  constexpr std::array<std::string_view, kTraitCount> names{"stature", "age", "sex", "mass", "duration"};
  return names[static_cast<std::size_t>(trait)];
}

TraitValues traits_of(const Subject& subject, double duration_s) {
  const double sex = subject.sex ? (*subject.sex == Sex::male ? 1.0 : 0.0) : kMissing;
  return {subject.stature_m, or_missing(subject.age_years), sex, or_missing(subject.mass_kg), duration_s};
}

void Moments::add(const Vec3& difference) {
  ++count;
  sum += difference;
  squares += glm::dot(difference, difference);
}

double spread(const Moments& all, const Moments& without) {
  if (all.count <= without.count) return 0.0;
  const auto n = static_cast<double>(all.count - without.count);
  const Vec3 sum = all.sum - without.sum;
  return std::sqrt(std::max(0.0, (all.squares - without.squares) / n - glm::dot(sum, sum) / (n * n)));
}

Pool::Pool(const PhaseColumns& columns, std::span<const std::uint32_t> positions) : size(positions.size()) {
  // Differences from the first motion's values lose no digits in their squares.
  for (const std::uint32_t at : positions) {
    home.add(columns.home[at] - columns.home[0]);
    target.add(columns.target[at] - columns.target[0]);
  }
  for (std::size_t t = 0; t < kTraitCount; ++t) {
    const std::vector<double>& values = columns.traits[t];
    const auto known = std::find_if(values.begin(), values.end(), [](double value) { return !std::isnan(value); });
    for (const std::uint32_t at : positions) {
      if (std::isnan(values[at])) continue;
      sorted[t].push_back(values[at]);
      traits[t].add({values[at] - *known, 0.0, 0.0});
    }
    std::sort(sorted[t].begin(), sorted[t].end());
  }
}

namespace {

PhaseColumns columns_of(std::span<const MotionSummary> motions, Phase phase, Hands hands) {
  PhaseColumns columns;
  std::vector<std::uint32_t> all, originals;
  for (std::size_t row = 0; row < motions.size(); ++row) {
    const MotionSummary& motion = motions[row];
    if (motion.phase != phase || motion.hands != hands) continue;
    const auto at = static_cast<std::uint32_t>(columns.size());
    all.push_back(at);
    if (!motion.is_mirrored) originals.push_back(at);
    columns.rows.push_back(static_cast<std::uint32_t>(row));
    columns.home.push_back(motion.home);
    columns.target.push_back(motion.target);
    columns.is_mirrored.push_back(motion.is_mirrored);
    const TraitValues traits = traits_of(motion.subject, motion.duration_s);
    for (std::size_t t = 0; t < kTraitCount; ++t) columns.traits[t].push_back(traits[t]);
  }
  columns.all = Pool(columns, all);
  columns.originals = Pool(columns, originals);
  columns.index = TaskIndex(columns.home, columns.target);
  return columns;
}

}  // namespace

MotionTable::MotionTable(std::vector<MotionSummary> motions) : motions_(std::move(motions)) {
  const auto by_id = [](const MotionSummary& a, const MotionSummary& b) { return a.id < b.id; };
  if (!std::is_sorted(motions_.begin(), motions_.end(), by_id))
    std::stable_sort(motions_.begin(), motions_.end(), by_id);
}

const PhaseColumns& MotionTable::of(Phase phase, Hands hands) const {
  const std::size_t number = static_cast<std::size_t>(phase) * kHandsCount + static_cast<std::size_t>(hands);
  std::call_once(made_[number], [&] { phases_[number] = columns_of(motions_, phase, hands); });
  return phases_[number];
}

}  // namespace reachcast
