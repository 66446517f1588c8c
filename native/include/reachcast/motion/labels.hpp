// SPDX-License-Identifier: GPL-3.0-or-later
/// Phases as people have written them down: a table beside the recordings, one row per phase.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reachcast/body/subject.hpp"
#include "reachcast/motion/find_reaches.hpp"

namespace reachcast {

/// One row. What its cells left empty is empty here.
struct PhaseLabel {
  std::string table;     ///< path of the table, for messages
  std::size_t line = 0;  ///< of the row in the table, from 1
  std::string file;      ///< the recording, as written
  std::optional<std::string> subject;
  std::optional<double> stature_m;  ///< 0.5 to 2.6
  std::optional<Sex> sex;
  std::optional<double> age_years;  ///< 0 to 130
  std::optional<double> mass_kg;    ///< over 0, at most 500
  Phase phase = Phase::transfer;
  Hands hands = Hands::both;
  std::optional<std::size_t> first, last;  ///< frames of the recording, from 0; both or neither
  std::optional<double> start_s, end_s;    ///< seconds from its first frame; both or neither
  /// A point of the recording if it has one of this name, else a word for people.
  std::optional<std::string> object;
  std::vector<ObjectEvent> events;  ///< in order of time

  /// The frames of the phase; seconds are rounded to the nearest frame. Throws std::invalid_argument naming the row
  /// when they do not lie within the clip.
  [[nodiscard]] FrameRange frames(const Clip& clip) const;
  /// All values that were given, in one line.
  [[nodiscard]] std::string text() const;
};

/// Columns: file, phase, and first and last (frames) or start_s and end_s; optional: subject, stature_m, sex (female,
/// male, f, m), age, mass_kg, hands (both, left, right), object, grasp_frame, lift_off_frame, placed_frame,
/// release_frame. Letter case of names does not matter. Throws std::invalid_argument naming an unknown or missing
/// column, or the row, value and limit.
[[nodiscard]] std::vector<PhaseLabel> read_labels(const std::string& path);

/// The same from text in memory; `source` names it in messages.
[[nodiscard]] std::vector<PhaseLabel> parse_labels(std::string_view text, const std::string& source);

/// The labelled phases of one recording, held to the same rules as those that find_reaches finds, with the feet
/// standing from first to last. What a label says of the person goes before `subject`; a person without a stature
/// rejects the row. `recorded` (may be null) is the clip as read, in which the labels' objects are looked for before
/// evidence.object. Throws as find_reaches does.
[[nodiscard]] FoundReaches cut_labelled(const Clip& clip, const std::vector<PhaseLabel>& labels,
                                        const std::optional<Subject>& subject, const Clip* recorded = nullptr,
                                        const FindOptions& options = {}, const Evidence& evidence = {});

}  // namespace reachcast
