// SPDX-License-Identifier: GPL-3.0-or-later
#include "opening.hpp"

#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <system_error>

#include "reachcast/corpus/corpus.hpp"

namespace reachcast::opening {

namespace fs = std::filesystem;
using sqlite::Connection;
using sqlite::Transaction;

std::string quoted(const fs::path& path) {
  return "corpus '" + path.string() + "' ";
}

[[noreturn]] void rethrow(const sqlite::Error& error, const fs::path& path) {
  const std::string corpus = quoted(path);
  switch (error.code & 0xFF) {  // the low byte is the primary result code
    case SQLITE_NOTADB:
      throw std::invalid_argument(corpus + "is not an SQLite file");
    case SQLITE_CORRUPT:
      throw std::runtime_error(corpus + "is damaged: " + error.what());
    case SQLITE_FULL:
      throw std::runtime_error(corpus + "could not be written: the disk is full; it is as it was before");
    case SQLITE_BUSY:
      throw std::runtime_error(corpus + "was in use by another program for more than " +
                               std::to_string(kBusyTimeout_ms / 1000) + " s");
    case SQLITE_READONLY:
      if (error.code == SQLITE_READONLY_ROLLBACK) {
        throw std::runtime_error(corpus +
                                 "was left half written by an interrupted program; opening it for writing "
                                 "repairs it");
      }
      throw std::runtime_error(corpus + "could not be written: the file or its folder is read-only");
    default:
      throw std::runtime_error(corpus + "could not be read or written: " + error.what());
  }
}

namespace {

constexpr std::uintmax_t kSmallestPage = 512;  ///< bytes; fixed by SQLite's file format

void require_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw std::invalid_argument(quoted(path) + "does not exist");
  if (error) throw std::runtime_error(quoted(path) + "could not be looked up: " + error.message());
  if (fs::is_directory(status)) throw std::invalid_argument(quoted(path) + "is a folder, not a file");
  if (!fs::is_regular_file(status)) throw std::invalid_argument(quoted(path) + "is not a regular file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw std::runtime_error(quoted(path) + "could not be looked up: " + error.message());
  if (size == 0) throw std::invalid_argument(quoted(path) + "is an empty file (0 bytes), not a corpus");
  if (size < kSmallestPage) {  // SQLite would take it for an empty database
    throw std::invalid_argument(quoted(path) + "is not an SQLite file: it has " + std::to_string(size) +
                                " bytes, expected at least " + std::to_string(kSmallestPage));
  }
}

/// A file that lost its end would otherwise read as zeros where the last page is cut.
void require_whole_file(Connection& connection, const fs::path& path) {
  const Transaction snapshot(connection, Transaction::Kind::read);
  const std::int64_t expected = connection.integer("PRAGMA page_count") * connection.integer("PRAGMA page_size");
  const auto size = static_cast<std::int64_t>(fs::file_size(path));
  if (size >= expected) return;
  throw std::runtime_error(quoted(path) + "is damaged: it has " + std::to_string(size) + " bytes, expected " +
                           std::to_string(expected));
}

}  // namespace

void require_corpus(Connection& connection, const fs::path& path) {
  const std::int64_t application = connection.integer("PRAGMA application_id");
  if (application != kCorpusApplicationId) {
    throw std::invalid_argument(quoted(path) + "is an SQLite file but not a Reachcast corpus: its application_id is " +
                                std::to_string(application) + ", expected " + std::to_string(kCorpusApplicationId));
  }
  const std::int64_t version = connection.integer("PRAGMA user_version");
  if (version > kCorpusSchemaVersion) {
    throw std::invalid_argument(quoted(path) + "has schema version " + std::to_string(version) +
                                ", this Reachcast reads versions up to " + std::to_string(kCorpusSchemaVersion));
  }
  if (version >= 1 && version < kCorpusSchemaVersion) {
    throw std::invalid_argument(quoted(path) + "has schema version " + std::to_string(version) +
                                ", which this Reachcast no longer reads: build it anew from its recordings");
  }
  if (version < 1) {
    throw std::runtime_error(quoted(path) + "is damaged: its schema version is " + std::to_string(version) +
                             ", expected at least 1");
  }
}

std::unique_ptr<Connection> connect(const fs::path& path, bool for_writing) {
  // Absolute, because SQLite gives names such as ":memory:" a meaning of their own.
  const int flags = for_writing ? SQLITE_OPEN_READWRITE : SQLITE_OPEN_READONLY;
  auto connection = std::make_unique<Connection>(fs::absolute(path), flags, kBusyTimeout_ms);
  // Without spilling, a writer keeps readers out only while it commits.
  connection->execute("PRAGMA foreign_keys = ON; PRAGMA cache_spill = OFF");
  return connection;
}

std::unique_ptr<Connection> open_checked(const fs::path& path, bool for_writing) {
  require_file(path);
  return reporting(path, [&] {
    auto connection = connect(path, for_writing);
    require_corpus(*connection, path);
    require_whole_file(*connection, path);
    // SQLite opens a file without write permission for reading, and says so only here.
    if (for_writing && connection->is_read_only()) {
      throw std::runtime_error(quoted(path) + "could not be opened for writing: the file is read-only");
    }
    // In case another tool switched the file to WAL, which readers in a read-only folder cannot use.
    if (for_writing) connection->execute("PRAGMA journal_mode = DELETE");
    return connection;
  });
}

void claim_file(const fs::path& path) {
  if (path.has_parent_path() && !fs::is_directory(path.parent_path())) {
    throw std::invalid_argument(quoted(path) + "could not be created: there is no folder '" +
                                path.parent_path().string() + "'");
  }
  errno = 0;
  std::FILE* const file = std::fopen(path.string().c_str(), "wbx");
  if (file) {
    std::fclose(file);
    return;
  }
  const int reason = errno;
  if (reason == EEXIST) throw std::invalid_argument(quoted(path) + "already exists");
  throw std::runtime_error(quoted(path) + "could not be created: " + std::generic_category().message(reason));
}

}  // namespace reachcast::opening
