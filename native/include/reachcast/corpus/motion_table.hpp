// SPDX-License-Identifier: GPL-3.0-or-later
/// What a neighbour search looks at: every motion of a corpus without its coefficients, and each phase by columns.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reachcast/corpus/task_index.hpp"
#include "reachcast/motion/reach.hpp"

namespace reachcast {

/// A stored motion without its coefficients.
struct MotionSummary {
  std::int64_t id = 0;
  std::int64_t subject_id = 0;  ///< equal for motions whose Subject has the same four values
  Subject subject;
  Phase phase = Phase::transfer;
  Hands hands = Hands::both;
  std::string origin;
  bool is_mirrored = false;
  double duration_s = 0.0;
  Vec3 home{0.0};    ///< body frame, metres
  Vec3 target{0.0};  ///< body frame, metres
  double grip_distance_m = 0.0;
};

/// The single numbers by which motions are compared, beside where they begin and end. Sex is 0 (female) or 1 (male).
enum class Trait { stature, age, sex, mass, duration };
inline constexpr std::size_t kTraitCount = 5;
using TraitValues = std::array<double, kTraitCount>;  ///< by Trait; kMissing where unknown

[[nodiscard]] std::string_view trait_name(Trait trait);  ///< "stature", ...
[[nodiscard]] TraitValues traits_of(const Subject& subject, double duration_s);

/// Sums from which the spread of some differences from a fixed value follows.
struct Moments {
  std::size_t count = 0;
  Vec3 sum{0.0};
  double squares = 0.0;

  void add(const Vec3& difference);
};
/// Root mean square distance from the mean, of what is in `all` and not in `without`; 0 where there is nothing.
[[nodiscard]] double spread(const Moments& all, const Moments& without);

struct PhaseColumns;

/// Some of the motions of a phase: what ranks and spreads among them are counted in.
struct Pool {
  std::size_t size = 0;
  std::array<std::vector<double>, kTraitCount> sorted;  ///< known values of each trait, rising
  Moments home, target;
  std::array<Moments, kTraitCount> traits;

  Pool() = default;
  /// The motions at these positions of the columns.
  Pool(const PhaseColumns& columns, std::span<const std::uint32_t> positions);
  [[nodiscard]] const std::vector<double>& by(Trait trait) const { return sorted[static_cast<std::size_t>(trait)]; }
};

/// The motions of one phase, in id order.
struct PhaseColumns {
  std::vector<std::uint32_t> rows;  ///< into MotionTable::motions
  std::vector<Vec3> home, target;
  std::vector<bool> is_mirrored;
  std::array<std::vector<double>, kTraitCount> traits;  ///< kMissing where unknown
  Pool all, originals;                                  ///< originals: those that are no mirror images
  TaskIndex index;                                      ///< of home and target

  [[nodiscard]] std::size_t size() const { return rows.size(); }
  [[nodiscard]] const Pool& pool(bool mirrored) const { return mirrored ? all : originals; }
};

/// In id order. Not changed once made, but for the columns of a phase, which are made when they are first asked for: in
/// a corpus of a million motions that takes longer than reading the motions.
class MotionTable {
 public:
  explicit MotionTable(std::vector<MotionSummary> motions);

  [[nodiscard]] const std::vector<MotionSummary>& motions() const { return motions_; }
  [[nodiscard]] const PhaseColumns& of(Phase phase) const;  ///< from any thread

 private:
  std::vector<MotionSummary> motions_;
  mutable std::array<PhaseColumns, kPhaseCount> phases_;
  mutable std::array<std::once_flag, kPhaseCount> made_;
};

}  // namespace reachcast
