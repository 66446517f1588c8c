// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/corpus/corpus.hpp"

#include <mutex>
#include <stdexcept>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "opening.hpp"
#include "problems.hpp"
#include "rows.hpp"
#include "schema.hpp"
#include "sources.hpp"
#include "sqlite.hpp"

namespace reachcast {

namespace fs = std::filesystem;
using opening::quoted;
using opening::reporting;
using sqlite::Connection;
using sqlite::Statement;
using sqlite::Transaction;

struct Corpus::State {
  fs::path path;
  std::unique_ptr<Connection> connection;  ///< empty once closed
  std::mutex mutex;                        ///< held by whoever uses the connection
  std::shared_ptr<const MotionTable> table;
  std::int64_t table_version = 0;  ///< PRAGMA data_version when the table was read
  std::unordered_map<std::int64_t, std::shared_ptr<const MotionCode>> codes;

  void forget() {
    table.reset();
    codes.clear();
  }
};

namespace {

/// A row that makes no sense means that the file is damaged.
template <typename Read>
auto read_row(const fs::path& path, const Read& read) {
  try {
    return read();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(quoted(path) + "is damaged: " + error.what());
  }
}

void require_code(const MotionCode& code, std::size_t position, Precision precision) {
  const std::string complaint = rows::complaint(code, precision);
  if (complaint.empty()) return;
  throw std::invalid_argument("codes[" + std::to_string(position) + "]." + complaint);
}

void require_length(const MotionCode& code, std::size_t position, std::int64_t length, const fs::path& path) {
  if (code.coefficients.size() == length) return;
  throw std::invalid_argument("codes[" + std::to_string(position) + "].coefficients has " +
                              std::to_string(code.coefficients.size()) + " values, " + quoted(path) +
                              "holds codes of " + std::to_string(length));
}

void require_codes(Connection& connection, std::span<const MotionCode> codes, const fs::path& path) {
  const Precision precision = reporting(path, [&] { return rows::format_of(connection).precision; });
  for (std::size_t i = 0; i < codes.size(); ++i) require_code(codes[i], i, precision);
}

/// Within the caller's transaction.
std::vector<std::int64_t> write_codes(Connection& connection, std::span<const MotionCode> codes,
                                      std::optional<std::int64_t> source, const fs::path& path) {
  rows::Format format = rows::format_of(connection);
  if (format.code_length == 0 && !codes.empty()) {
    format.code_length = codes.front().coefficients.size();
    schema::put_meta(connection, "code_length", std::to_string(format.code_length));
  }
  rows::Writer writer(connection, format, source);
  std::vector<std::int64_t> ids;
  ids.reserve(codes.size());
  for (const MotionCode& code : codes) {
    require_length(code, ids.size(), format.code_length, path);
    ids.push_back(writer.add(code));
  }
  return ids;
}

Connection& require_open(const std::unique_ptr<Connection>& connection, const fs::path& path) {
  if (!connection) throw std::invalid_argument(quoted(path) + "is closed");
  return *connection;
}

Connection& require_writable(const std::unique_ptr<Connection>& connection, const fs::path& path) {
  if (require_open(connection, path).is_read_only()) {
    throw std::invalid_argument(quoted(path) + "was opened for reading only, use open_for_writing");
  }
  return *connection;
}

}  // namespace

Corpus::Corpus(std::unique_ptr<State> state) : state_(std::move(state)) {}
Corpus::Corpus(Corpus&& other) noexcept = default;
Corpus& Corpus::operator=(Corpus&& other) noexcept = default;
Corpus::~Corpus() = default;

Corpus Corpus::create(const fs::path& path, std::string_view created_by, Precision precision) {
  opening::claim_file(path);
  auto state = std::make_unique<State>();
  state->path = path;
  try {
    reporting(path, [&] {
      state->connection = opening::connect(path, true);
      schema::write_empty_corpus(*state->connection, created_by, precision);
    });
  } catch (...) {
    state->connection.reset();
    std::error_code ignored;
    fs::remove(path, ignored);
    throw;
  }
  return Corpus(std::move(state));
}

Corpus Corpus::open(const fs::path& path) {
  auto state = std::make_unique<State>();
  state->path = path;
  state->connection = opening::open_checked(path, false);
  return Corpus(std::move(state));
}

Corpus Corpus::open_for_writing(const fs::path& path) {
  auto state = std::make_unique<State>();
  state->path = path;
  state->connection = opening::open_checked(path, true);
  return Corpus(std::move(state));
}

std::vector<std::int64_t> Corpus::add(std::span<const MotionCode> codes) {
  const std::scoped_lock lock(state_->mutex);
  Connection& connection = require_writable(state_->connection, state_->path);
  require_codes(connection, codes, state_->path);
  if (codes.empty()) return {};
  return reporting(state_->path, [&] {
    Transaction transaction(connection, Transaction::Kind::write);
    std::vector<std::int64_t> ids = write_codes(connection, codes, {}, state_->path);
    transaction.commit();
    state_->forget();  // data_version tells of others' changes only
    return ids;
  });
}

std::optional<StoredSource> Corpus::add_source(const SourceFile& file, std::span<const MotionCode> codes,
                                               std::span<const StoredRejection> rejections) {
  const std::scoped_lock lock(state_->mutex);
  Connection& connection = require_writable(state_->connection, state_->path);
  if (const std::string complaint = sources::complaint(file); !complaint.empty())
    throw std::invalid_argument("file." + complaint);
  require_codes(connection, codes, state_->path);
  return reporting(state_->path, [&]() -> std::optional<StoredSource> {
    Transaction transaction(connection, Transaction::Kind::write);
    if (const auto earlier = sources::find(connection, file.checksum)) {
      if (earlier->settings == file.settings) return std::nullopt;
      sources::remove_source(connection, earlier->id);
    }
    StoredSource stored{sources::insert(connection, file, rejections), file, 0,
                        std::vector<StoredRejection>(rejections.begin(), rejections.end())};
    stored.motions = write_codes(connection, codes, stored.id, state_->path).size();
    transaction.commit();
    state_->forget();
    return stored;
  });
}

std::vector<StoredSource> Corpus::sources() const {
  const std::scoped_lock lock(state_->mutex);
  Connection& connection = require_open(state_->connection, state_->path);
  return reporting(state_->path, [&] {
    const Transaction snapshot(connection, Transaction::Kind::read);
    return sources::all(connection);
  });
}

bool Corpus::has_source(const std::string& checksum, const std::string& settings) const {
  const std::scoped_lock lock(state_->mutex);
  Connection& connection = require_open(state_->connection, state_->path);
  return reporting(state_->path, [&] {
    const auto stored = sources::find(connection, checksum);
    return stored && stored->settings == settings;
  });
}

std::vector<std::int64_t> Corpus::motions_of(std::int64_t source) const {
  const std::scoped_lock lock(state_->mutex);
  Connection& connection = require_open(state_->connection, state_->path);
  return reporting(state_->path, [&] { return sources::motions_of(connection, source); });
}

std::vector<std::string> Corpus::check() const {
  const std::scoped_lock lock(state_->mutex);
  Connection& connection = require_open(state_->connection, state_->path);
  return reporting(state_->path, [&] {
    const Transaction snapshot(connection, Transaction::Kind::read);
    return problems::find(connection, kMostProblems);
  });
}

std::size_t Corpus::remove(std::span<const std::int64_t> ids) {
  const std::scoped_lock lock(state_->mutex);
  Connection& connection = require_writable(state_->connection, state_->path);
  return reporting(state_->path, [&] {
    Transaction transaction(connection, Transaction::Kind::write);
    const std::size_t count = sources::remove(connection, ids);
    transaction.commit();
    state_->forget();
    return count;
  });
}

std::size_t Corpus::size() const {
  const std::scoped_lock lock(state_->mutex);
  Connection& connection = require_open(state_->connection, state_->path);
  return reporting(state_->path,
                   [&] { return static_cast<std::size_t>(connection.integer("SELECT count(*) FROM motions")); });
}

std::vector<StoredMotion> Corpus::motions() const {
  const std::scoped_lock lock(state_->mutex);
  Connection& connection = require_open(state_->connection, state_->path);
  return reporting(state_->path, [&] {
    const Transaction snapshot(connection, Transaction::Kind::read);
    const rows::Format format = rows::format_of(connection);
    Statement row(connection, rows::select(true));
    std::vector<StoredMotion> motions;
    while (row.step()) motions.push_back(read_row(state_->path, [&] { return rows::read_motion(row, format); }));
    return motions;
  });
}

std::shared_ptr<const MotionTable> Corpus::table() const {
  const std::scoped_lock lock(state_->mutex);
  Connection& connection = require_open(state_->connection, state_->path);
  return reporting(state_->path, [&] {
    const Transaction snapshot(connection, Transaction::Kind::read);
    const std::int64_t version = connection.integer("PRAGMA data_version");
    if (state_->table && state_->table_version == version) return state_->table;
    state_->forget();
    opening::require_corpus(connection, state_->path);  // the change may have been to a newer schema
    Statement row(connection, rows::select(false));
    std::vector<MotionSummary> motions;
    motions.reserve(static_cast<std::size_t>(connection.integer("SELECT count(*) FROM motions")));
    while (row.step()) motions.push_back(read_row(state_->path, [&] { return rows::read_summary(row); }));
    state_->table = std::make_shared<const MotionTable>(std::move(motions));
    state_->table_version = version;
    return state_->table;
  });
}

std::shared_ptr<const MotionCode> Corpus::code(std::int64_t id) const {
  {
    const std::scoped_lock lock(state_->mutex);
    (void)require_open(state_->connection, state_->path);
    if (const auto found = state_->codes.find(id); found != state_->codes.end()) return found->second;
  }
  auto code = std::make_shared<const MotionCode>(std::move(load(std::span(&id, 1)).front().code));
  const std::scoped_lock lock(state_->mutex);
  if (state_->codes.size() >= kRememberedCodes) state_->codes.clear();
  return state_->codes.emplace(id, std::move(code)).first->second;
}

std::vector<StoredMotion> Corpus::load(std::span<const std::int64_t> ids) const {
  const std::scoped_lock lock(state_->mutex);
  Connection& connection = require_open(state_->connection, state_->path);
  return reporting(state_->path, [&] {
    const Transaction snapshot(connection, Transaction::Kind::read);
    const rows::Format format = rows::format_of(connection);
    Statement row(connection, rows::select(true, "WHERE m.id = ?"));
    std::vector<StoredMotion> motions;
    motions.reserve(ids.size());
    for (const std::int64_t id : ids) {
      row.bind(1, id);
      if (!row.step())
        throw std::invalid_argument(quoted(state_->path) + "has no motion with id " + std::to_string(id));
      motions.push_back(read_row(state_->path, [&] { return rows::read_motion(row, format); }));
      row.reset();
    }
    return motions;
  });
}

std::map<std::string, std::string> Corpus::meta() const {
  const std::scoped_lock lock(state_->mutex);
  Connection& connection = require_open(state_->connection, state_->path);
  return reporting(state_->path, [&] {
    std::map<std::string, std::string> meta;
    Statement row(connection, "SELECT key, value FROM meta");
    while (row.step()) meta.emplace(row.text(0), row.text(1));
    return meta;
  });
}

void Corpus::set_meta(std::string_view key, std::string_view value) {
  const std::scoped_lock lock(state_->mutex);
  Connection& connection = require_writable(state_->connection, state_->path);
  if (key.empty() || key == "schema_version" || key == "created_by" || key == "code_length" || key == "precision") {
    throw std::invalid_argument("meta key '" + std::string(key) + "' cannot be set: the corpus keeps it itself");
  }
  reporting(state_->path, [&] { schema::put_meta(connection, key, value); });
}

const fs::path& Corpus::path() const {
  return state_->path;
}

bool Corpus::is_open() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->connection != nullptr;
}

bool Corpus::is_writable() const {
  const std::scoped_lock lock(state_->mutex);
  return !require_open(state_->connection, state_->path).is_read_only();
}

void Corpus::close() {
  const std::scoped_lock lock(state_->mutex);
  state_->connection.reset();
  state_->forget();
}

}  // namespace reachcast
