// SPDX-License-Identifier: GPL-3.0-or-later
/// What a corpus has to say about one stage, also where it holds no motion of that phase.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reachcast/corpus/corpus.hpp"
#include "reachcast/predict/blend.hpp"

namespace reachcast {

/// Another motion than the mean, as people vary: the same seed draws the same one on every machine.
struct Variation {
  std::uint64_t seed = 0;
  double amount = 1.0;  ///< 0 to 2, of the covariance's own spread
};

inline constexpr int kVaryingMotions = 20;  ///< the nearest, whose covariance is drawn from

struct LearnedStage {
  Blend blend;
  /// Where the phase was not recorded, or not with these hands, the one whose postures serve it. A path of the hands
  /// for it is then not known.
  std::optional<Phase> borrowed;
  std::vector<std::string> outside;  ///< why the query lies outside the corpus; empty when it lies inside
};

/// The neighbours of a stage, averaged. Where nobody was recorded in its phase, postures are taken from the opposite
/// phase played backwards, else from the other phase of the same direction, else from its opposite: the hands are at
/// the object at the same end. Where nobody was recorded with the one hand that works, they are taken from both hands
/// in the same way. `outside` says so.
/// draw: number of the draw of the variation, if any: other draws of one seed are independent.
/// Throws std::invalid_argument as Search does and for an empty corpus.
[[nodiscard]] LearnedStage learn_stage(const Corpus& corpus, const MotionTable& table, const Query& query,
                                       const Scheme& scheme, const std::optional<Variation>& variation,
                                       std::uint64_t draw);

/// One stored motion as it is, on the wanted axis. Throws std::invalid_argument for an unknown id and another phase.
[[nodiscard]] LearnedStage retargeted_stage(const Corpus& corpus, const MotionTable& table, const Query& query,
                                            std::int64_t id);

}  // namespace reachcast
