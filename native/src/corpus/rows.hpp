// SPDX-License-Identifier: GPL-3.0-or-later
/// What the tables of a corpus hold, and the way from a MotionCode to a row and back. Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reachcast/corpus/corpus.hpp"
#include "sqlite.hpp"

namespace reachcast::rows {

/// How the coefficients of a corpus are written.
struct Format {
  std::int64_t code_length = 0;  ///< 0 until a motion was added
  Precision precision = Precision::exact;
};
[[nodiscard]] Format format_of(sqlite::Connection& connection);

/// Query for all columns that `read_summary` wants, with or without those that `read_motion` wants beside them.
[[nodiscard]] std::string select(bool with_coefficients, const std::string& condition = "");

/// What makes a code impossible to store, in words; empty if nothing does.
[[nodiscard]] std::string complaint(const MotionCode& code, Precision precision);

/// The current row. A value that cannot have been written by this program throws std::runtime_error: the sentence
/// starts with "motion 12", the caller puts the path in front.
[[nodiscard]] MotionSummary read_summary(const sqlite::Statement& row);
[[nodiscard]] StoredMotion read_motion(const sqlite::Statement& row, const Format& format);

/// Appends codes within a transaction that the caller began.
class Writer {
 public:
  /// source: what clips that are new come from.
  Writer(sqlite::Connection& connection, const Format& format, std::optional<std::int64_t> source = {});
  /// The new id, or the one that (origin, mirrored, phase) has already.
  [[nodiscard]] std::int64_t add(const MotionCode& code);

 private:
  [[nodiscard]] std::int64_t subject_id(const Subject& subject);
  [[nodiscard]] std::int64_t clip_id(const std::string& origin);
  [[nodiscard]] std::int64_t insert(const MotionCode& code, std::int64_t clip);
  [[nodiscard]] std::int64_t find_motion(std::int64_t clip, bool mirrored, Phase phase);
  /// The motion of which this one is the mirror image; 0 for another motion and where that one is not stored.
  [[nodiscard]] std::int64_t original_of(const MotionCode& code, std::int64_t clip);
  [[nodiscard]] std::vector<std::byte> to_blob(const MotionCode& code, std::int64_t original);

  sqlite::Connection& connection_;
  Format format_;
  std::optional<std::int64_t> source_;
  sqlite::Statement find_subject_, insert_subject_, find_clip_, insert_clip_, find_motion_, insert_motion_,
      insert_coefficients_, find_coefficients_;
};

}  // namespace reachcast::rows
