// SPDX-License-Identifier: GPL-3.0-or-later
/// The little of SQLite that the corpus needs, owned and checked. Private to this folder.
#pragma once

#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace reachcast::sqlite {

/// What SQLite answered, with its extended result code. The corpus decides what it means for the caller.
struct Error : std::runtime_error {
  Error(int code_, const std::string& message) : std::runtime_error(message), code(code_) {}
  int code;
};

class Connection {
 public:
  /// `flags` of sqlite3_open_v2. Throws Error.
  Connection(const std::filesystem::path& path, int flags, int busy_timeout_ms);
  ~Connection() { sqlite3_close_v2(handle_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void execute(const std::string& sql);
  [[nodiscard]] std::int64_t integer(std::string_view sql);  ///< the first column of the first row
  [[nodiscard]] bool is_read_only() const { return sqlite3_db_readonly(handle_, "main") != 0; }
  [[nodiscard]] std::int64_t last_id() const { return sqlite3_last_insert_rowid(handle_); }
  [[nodiscard]] sqlite3* handle() const { return handle_; }
  void check(int code) const;  ///< throws Error unless the code says success

 private:
  sqlite3* handle_ = nullptr;
};

/// A prepared statement. Parameters and columns count from 1 and 0, as in SQLite.
class Statement {
 public:
  Statement(Connection& connection, std::string_view sql);
  ~Statement() { sqlite3_finalize(handle_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  void bind(int parameter, std::int64_t value);
  void bind(int parameter, double value);
  void bind(int parameter, std::optional<double> value);
  void bind(int parameter, std::optional<std::int64_t> value);
  void bind(int parameter, std::string_view value);  ///< copied
  void bind(int parameter, std::optional<std::string_view> value);
  void bind(int parameter, std::span<const std::byte> value);  ///< must outlive the next `step`

  [[nodiscard]] bool step();  ///< true while there is a row
  void run();                 ///< to the end, then ready for new parameters
  void reset() { sqlite3_reset(handle_); }

  [[nodiscard]] bool is_null(int column) const { return sqlite3_column_type(handle_, column) == SQLITE_NULL; }
  [[nodiscard]] std::int64_t integer(int column) const { return sqlite3_column_int64(handle_, column); }
  [[nodiscard]] double real(int column) const { return sqlite3_column_double(handle_, column); }
  [[nodiscard]] std::string_view text(int column) const;            ///< valid until the next step
  [[nodiscard]] std::span<const std::byte> blob(int column) const;  ///< valid until the next step

 private:
  Connection& connection_;
  sqlite3_stmt* handle_ = nullptr;
};

/// Begins on construction; undone on destruction unless committed.
class Transaction {
 public:
  enum class Kind { read, write };
  Transaction(Connection& connection, Kind kind);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Connection& connection_;
};

}  // namespace reachcast::sqlite
