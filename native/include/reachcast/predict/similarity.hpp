// SPDX-License-Identifier: GPL-3.0-or-later
/// The search for motions like one that is wanted, under any scheme, exactly and without looking at all of them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "reachcast/predict/scheme.hpp"

namespace reachcast {

/// What is wanted, in the terms in which motions are stored.
struct Query {
  Phase phase = Phase::transfer;
  Vec3 home{0.0};    ///< hold point at the start, body frame
  Vec3 target{0.0};  ///< hold point at the end, body frame
  Subject subject;
  std::optional<double> duration_s{};  ///< only schemes that compare durations need it
  Hands hands = Hands::both;           ///< only motions of these hands are looked at
};

/// A motion and its share of the prediction.
struct Share {
  std::uint32_t at = 0;  ///< position in the columns of the phase
  double weight = 0.0;   ///< all sum to 1; under Smoother::linear some may be negative
};

/// All searches for one query. What they have in common, such as the order of the tasks, is found once and kept.
class Search {
 public:
  /// `left_out`: positions in the columns of the query's phase, rising; they are as if they were not there. Table and
  /// query must outlive the search. Throws std::invalid_argument when no motion of the phase is left.
  Search(const MotionTable& table, const Query& query, std::vector<std::uint32_t> left_out = {});

  /// Positions of the k best (of all, if fewer), best first; equal ones by id. Equal differences share the smallest
  /// rank. For Measure::ranks with a task, motions are looked at in the order of the task's distance until no later one
  /// can win. Throws for a scheme that check() refuses, one that compares durations without one in the query, and
  /// where no motion may take part.
  [[nodiscard]] std::vector<std::uint32_t> nearest(const Scheme& scheme, End end);

  /// Shares of `nearest` (or of its first ones), by the scheme's smoother.
  [[nodiscard]] std::vector<Share> shares(const Scheme& scheme, End end, std::span<const std::uint32_t> nearest);

 private:
  struct Comparison;
  /// Motions in order of the task's distance, as far as they were asked for.
  struct TaskOrder {
    struct Step {
      std::uint32_t at = 0;
      double squared_distance = 0.0;
      std::size_t rank = 0;
    };
    TaskWalk walk;
    std::vector<Step> steps;
  };

  /// Ranks that were counted: people lift many times, so the same values come again and again.
  struct KnownRanks {
    static constexpr std::size_t kPlaces = 128;
    std::array<double, kPlaces> value;  ///< kMissing where nothing is known yet
    std::array<std::uint32_t, kPlaces> rank;
    KnownRanks() { value.fill(kMissing); }
  };

  [[nodiscard]] bool takes_part(std::uint32_t at, bool mirrored) const;
  [[nodiscard]] const Pool& missing(bool mirrored) const { return mirrored ? missing_ : missing_originals_; }
  [[nodiscard]] std::size_t count(bool mirrored) const;
  [[nodiscard]] Comparison comparison(const Scheme& scheme, End end);
  [[nodiscard]] const TaskOrder::Step* step(End end, bool mirrored, std::size_t number);
  [[nodiscard]] double squared_task_distance_of(std::uint32_t at, End end) const;
  [[nodiscard]] Eigen::MatrixXd offsets(std::span<const std::uint32_t> motions, bool mirrored) const;

  const PhaseColumns& columns_;
  Query query_;
  TraitValues wanted_;
  std::vector<std::uint32_t> left_out_;
  std::vector<bool> is_left_out_;     ///< empty when nothing is
  Pool missing_, missing_originals_;  ///< what is left out
  std::array<std::optional<TaskOrder>, 6> orders_;
  std::array<std::optional<KnownRanks>, 2 * kTraitCount> known_ranks_;
};

}  // namespace reachcast
