// SPDX-License-Identifier: GPL-3.0-or-later
/// Many MotionCodes in one SQLite file: what prediction learns from. The only stage that writes files.
///
/// The file is in SQLite's rollback-journal mode, never WAL: a reader then needs no -wal or -shm beside the file, so a
/// corpus also opens from a read-only folder. The -journal exists only while `add` or `set_meta` runs.
/// Any number of processes and threads may read while one writes; a reader sees all of an `add` or none of it, and
/// whoever waits longer than kBusyTimeout_ms gets an error. A Corpus must not be carried across fork(): open it after.
///
/// Failure, in every function: std::invalid_argument for the caller's mistakes (file missing, empty, not a corpus,
/// newer schema, invalid code, unknown id), std::runtime_error for disk errors and damaged files. The message is one
/// sentence that names the path, the value and the limit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reachcast/corpus/motion_table.hpp"
#include "reachcast/corpus/source.hpp"
#include "reachcast/motion/motion_code.hpp"

namespace reachcast {

inline constexpr int kCorpusSchemaVersion = 4;                    ///< PRAGMA user_version
inline constexpr std::int32_t kCorpusApplicationId = 0x52434350;  ///< PRAGMA application_id: "RCCP"
inline constexpr std::size_t kRememberedCodes = 4096;
inline constexpr std::size_t kMostProblems = 100;
inline constexpr int kBusyTimeout_ms = 30'000;  ///< how long to wait for another process

/// How coefficients are kept: as they are, or as multiples of kCompactStep in a fifth of the bytes, mirror images as
/// their difference from what `mirror_image` makes of the motion. Then a coefficient comes back with an error of at
/// most half a step, and joints with 0.04 mm in the median and 0.2 mm in 99 of 100 places (recorded lifts; 3 mm at
/// worst, an elbow that is nearly straight).
enum class Precision { exact, compact };
inline constexpr double kCompactStep = 1.0 / 4096.0;

/// Comes back bit for bit as it was added, except that -0.0 becomes 0.0 outside the coefficients (SQLite's REAL), and
/// except for the coefficients of a compact corpus.
struct StoredMotion {
  std::int64_t id = 0;  ///< > 0, grows in the order of adding, never reused
  MotionCode code;
};

/// Movable. Its functions may be called from several threads; they take turns.
class Corpus {
 public:
  /// A new, empty corpus; fails if anything exists at `path`. `created_by` is kept in the metadata.
  [[nodiscard]] static Corpus create(const std::filesystem::path& path, std::string_view created_by = "reachcast",
                                     Precision precision = Precision::exact);
  /// Read-only. An empty corpus is legal.
  [[nodiscard]] static Corpus open(const std::filesystem::path& path);
  /// Also repairs what a crashed writer left half done.
  [[nodiscard]] static Corpus open_for_writing(const std::filesystem::path& path);

  Corpus(Corpus&& other) noexcept;
  Corpus& operator=(Corpus&& other) noexcept;
  ~Corpus();

  /// Appends in one transaction: all or nothing, also on errors. A code whose (origin, mirrored, phase) is already
  /// stored changes nothing and yields the id it has. Returns one id per code, in their order.
  /// Every code needs a non-empty origin, finite values within the ranges of MotionCode and Subject, a
  /// duration > 0, and as many coefficients as the codes already stored.
  std::vector<std::int64_t> add(std::span<const MotionCode> codes);

  /// What an imported file gave, in one transaction: the file, its motions and what in it was left out. A file whose
  /// checksum and settings are stored already changes nothing and yields nothing; one stored with other settings is
  /// replaced. Motions whose (origin, mirrored, phase) another file brought stay that file's.
  std::optional<StoredSource> add_source(const SourceFile& file, std::span<const MotionCode> codes,
                                         std::span<const StoredRejection> rejections);
  [[nodiscard]] std::vector<StoredSource> sources() const;  ///< all, in id order
  /// Whether `add_source` would change nothing.
  [[nodiscard]] bool has_source(const std::string& checksum, const std::string& settings) const;
  /// The motions that came from a file, in id order; none for an unknown id.
  [[nodiscard]] std::vector<std::int64_t> motions_of(std::int64_t source) const;
  /// Reads everything: what is wrong with the file, one sentence each, at most kMostProblems of them. Empty if nothing.
  [[nodiscard]] std::vector<std::string> check() const;
  /// Takes motions away, and with the last of a file the file, so that it can be imported again. In a compact corpus
  /// mirror images go with their motion. Unknown ids are no error. Returns how many motions there were.
  std::size_t remove(std::span<const std::int64_t> ids);

  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] std::vector<StoredMotion> motions() const;  ///< all, in id order
  /// All motions without their coefficients, in id order. Kept, and read again when the file has changed.
  [[nodiscard]] std::shared_ptr<const MotionTable> table() const;
  /// One code. Up to kRememberedCodes of them are kept until `table` finds that the file has changed.
  [[nodiscard]] std::shared_ptr<const MotionCode> code(std::int64_t id) const;
  /// The codes of these ids, in their order; repeated ids are legal.
  [[nodiscard]] std::vector<StoredMotion> load(std::span<const std::int64_t> ids) const;

  /// Always there: "schema_version", "created_by", "precision" ("exact" or "compact"), "kind" (such as "recorded" or
  /// "simulated";
  /// "" until it is set), "description"; and "code_length", the number of coefficients, once a motion was added.
  [[nodiscard]] std::map<std::string, std::string> meta() const;
  /// Any key except "schema_version", "created_by", "precision" and "code_length", which the corpus keeps itself.
  void set_meta(std::string_view key, std::string_view value);

  [[nodiscard]] const std::filesystem::path& path() const;
  [[nodiscard]] bool is_open() const;
  [[nodiscard]] bool is_writable() const;
  /// Releases the file; every later call but path, is_open and close fails. Closing twice is legal.
  void close();

 private:
  struct State;
  explicit Corpus(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace reachcast
