// SPDX-License-Identifier: GPL-3.0-or-later
/// What the tables of a corpus hold, and the way from a MotionCode to a row and back. Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "reachcast/corpus/corpus.hpp"
#include "sqlite.hpp"

namespace reachcast::rows {

/// Statements that create the tables of an empty database.
[[nodiscard]] const char* schema();

/// Query for all columns that `read_summary` wants, with or without the coefficients as the last one.
[[nodiscard]] std::string select(bool with_coefficients, const std::string& condition = "");

/// What makes a code impossible to store, in words; empty if nothing does.
[[nodiscard]] std::string complaint(const MotionCode& code);

/// Little-endian on every machine, eight bytes per number.
[[nodiscard]] std::vector<std::byte> to_blob(const Eigen::VectorXd& coefficients);

/// The current row. A value that cannot have been written by this program throws std::runtime_error: the sentence
/// starts with "motion 12", the caller puts the path in front.
[[nodiscard]] MotionSummary read_summary(const sqlite::Statement& row);
[[nodiscard]] StoredMotion read_motion(const sqlite::Statement& row, std::int64_t code_length);

/// Appends codes within a transaction that the caller began.
class Writer {
 public:
  explicit Writer(sqlite::Connection& connection);
  /// The new id, or the one that (origin, mirrored, phase) has already.
  [[nodiscard]] std::int64_t add(const MotionCode& code);

 private:
  [[nodiscard]] std::int64_t subject_id(const Subject& subject);
  [[nodiscard]] std::int64_t source_id(const std::string& origin);
  [[nodiscard]] std::int64_t insert(const MotionCode& code, std::int64_t source);

  sqlite::Connection& connection_;
  sqlite::Statement find_subject_, insert_subject_, find_source_, insert_source_, find_motion_, insert_motion_,
      insert_coefficients_;
};

}  // namespace reachcast::rows
