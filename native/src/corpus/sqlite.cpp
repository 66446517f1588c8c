// SPDX-License-Identifier: GPL-3.0-or-later
#include "sqlite.hpp"

namespace reachcast::sqlite {

Connection::Connection(const std::filesystem::path& path, int flags, int busy_timeout_ms) {
  // Whoever uses a connection from several threads holds a mutex anyway; SQLite's own costs a tenth of the reading.
  const int code = sqlite3_open_v2(path.string().c_str(), &handle_, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  if (code != SQLITE_OK) {
    const Error error(handle_ ? sqlite3_extended_errcode(handle_) : code,
                      handle_ ? sqlite3_errmsg(handle_) : sqlite3_errstr(code));
    sqlite3_close_v2(handle_);
    throw error;
  }
  sqlite3_extended_result_codes(handle_, 1);
  sqlite3_busy_timeout(handle_, busy_timeout_ms);
}

void Connection::check(int code) const {
  if (code == SQLITE_OK || code == SQLITE_DONE || code == SQLITE_ROW) return;
  throw Error(code, sqlite3_errmsg(handle_));
}

void Connection::execute(const std::string& sql) {
  check(sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr));
}

std::int64_t Connection::integer(std::string_view sql) {
  Statement statement(*this, sql);
  return statement.step() ? statement.integer(0) : 0;
}

Statement::Statement(Connection& connection, std::string_view sql) : connection_(connection) {
  connection_.check(
      sqlite3_prepare_v2(connection_.handle(), sql.data(), static_cast<int>(sql.size()), &handle_, nullptr));
}

void Statement::bind(int parameter, std::int64_t value) {
  connection_.check(sqlite3_bind_int64(handle_, parameter, value));
}

void Statement::bind(int parameter, double value) {
  connection_.check(sqlite3_bind_double(handle_, parameter, value));
}

void Statement::bind(int parameter, std::optional<double> value) {
  if (value) return bind(parameter, *value);
  connection_.check(sqlite3_bind_null(handle_, parameter));
}

void Statement::bind(int parameter, std::optional<std::int64_t> value) {
  if (value) return bind(parameter, *value);
  connection_.check(sqlite3_bind_null(handle_, parameter));
}

void Statement::bind(int parameter, std::string_view value) {
  // A null pointer would bind NULL, and an empty view may hold one.
  const char* const text = value.empty() ? "" : value.data();
  connection_.check(sqlite3_bind_text64(handle_, parameter, text, value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
}

void Statement::bind(int parameter, std::optional<std::string_view> value) {
  if (value) return bind(parameter, *value);
  connection_.check(sqlite3_bind_null(handle_, parameter));
}

void Statement::bind(int parameter, std::span<const std::byte> value) {
  connection_.check(sqlite3_bind_blob64(handle_, parameter, value.data(), value.size(), SQLITE_STATIC));
}

bool Statement::step() {
  const int code = sqlite3_step(handle_);
  connection_.check(code);
  return code == SQLITE_ROW;
}

void Statement::run() {
  while (step()) {
  }
  reset();
}

std::string_view Statement::text(int column) const {
  const auto* const data = reinterpret_cast<const char*>(sqlite3_column_text(handle_, column));
  return data ? std::string_view(data, static_cast<std::size_t>(sqlite3_column_bytes(handle_, column)))
              : std::string_view();
}

std::span<const std::byte> Statement::blob(int column) const {
  const auto* const data = static_cast<const std::byte*>(sqlite3_column_blob(handle_, column));
  return {data, data ? static_cast<std::size_t>(sqlite3_column_bytes(handle_, column)) : 0};
}

Transaction::Transaction(Connection& connection, Kind kind) : connection_(connection) {
  // IMMEDIATE takes the writer's lock at once: two writers queue up instead of meeting half way.
  connection_.execute(kind == Kind::write ? "BEGIN IMMEDIATE" : "BEGIN");
}

Transaction::~Transaction() {
  // After some errors (a full disk) SQLite has already rolled back by itself.
  if (sqlite3_get_autocommit(connection_.handle()) == 0) {
    sqlite3_exec(connection_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
  }
}

void Transaction::commit() {
  connection_.execute("COMMIT");
}

}  // namespace reachcast::sqlite
