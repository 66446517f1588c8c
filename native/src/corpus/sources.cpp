// SPDX-License-Identifier: GPL-3.0-or-later
#include "sources.hpp"

#include <set>

namespace reachcast::sources {

using sqlite::Connection;
using sqlite::Statement;

std::string complaint(const SourceFile& file) {
  if (file.path.empty()) return "path is empty, expected the name of the imported file";
  if (file.checksum.empty()) return "checksum is empty, expected one of the file's bytes";
  if (file.bytes < 0) return "bytes is " + std::to_string(file.bytes) + ", expected a number >= 0";
  return "";
}

std::optional<Key> find(Connection& connection, const std::string& checksum) {
  Statement row(connection, "SELECT id, settings FROM sources WHERE checksum = ?");
  row.bind(1, std::string_view(checksum));
  if (!row.step()) return std::nullopt;
  return Key{row.integer(0), std::string(row.text(1))};
}

std::int64_t insert(Connection& connection, const SourceFile& file, std::span<const StoredRejection> rejections) {
  Statement source(connection,
                   "INSERT INTO sources (path, checksum, bytes, tool, note, settings) VALUES (?, ?, ?, ?, ?, ?)");
  source.bind(1, std::string_view(file.path));
  source.bind(2, std::string_view(file.checksum));
  source.bind(3, file.bytes);
  source.bind(4, std::string_view(file.tool));
  source.bind(5, std::string_view(file.note));
  source.bind(6, std::string_view(file.settings));
  source.run();
  const std::int64_t id = connection.last_id();
  Statement rejection(connection, "INSERT INTO rejections (source, what, reason) VALUES (?, ?, ?)");
  for (const StoredRejection& left_out : rejections) {
    rejection.bind(1, id);
    rejection.bind(2, std::string_view(left_out.what));
    rejection.bind(3, std::string_view(left_out.reason));
    rejection.run();
  }
  return id;
}

std::vector<StoredSource> all(Connection& connection) {
  std::vector<StoredSource> found;
  Statement row(connection,
                "SELECT s.id, s.path, s.checksum, s.bytes, s.tool, s.note, s.settings, (SELECT count(*) FROM motions m"
                " JOIN clips c ON c.id = m.clip WHERE c.source = s.id) FROM sources s ORDER BY s.id");
  Statement rejection(connection, "SELECT what, reason FROM rejections WHERE source = ? ORDER BY id");
  while (row.step()) {
    StoredSource source;
    source.id = row.integer(0);
    source.file = {std::string(row.text(1)), std::string(row.text(2)), row.integer(3),
                   std::string(row.text(4)), std::string(row.text(5)), std::string(row.text(6))};
    source.motions = static_cast<std::size_t>(row.integer(7));
    rejection.bind(1, source.id);
    while (rejection.step())
      source.rejections.push_back({std::string(rejection.text(0)), std::string(rejection.text(1))});
    rejection.reset();
    found.push_back(std::move(source));
  }
  return found;
}

namespace {

/// The motions with these ids that there are, and the mirror images that are kept as a difference to one of them.
std::set<std::int64_t> with_images(Connection& connection, std::span<const std::int64_t> ids) {
  std::set<std::int64_t> found;
  Statement row(connection, "SELECT id FROM motions WHERE id = ?1 UNION SELECT motion FROM codes WHERE original = ?1");
  for (const std::int64_t id : ids) {
    row.bind(1, id);
    while (row.step()) found.insert(row.integer(0));
    row.reset();
  }
  return found;
}

void delete_motions(Connection& connection, const std::set<std::int64_t>& ids) {
  // Images first: each refers to its motion.
  for (const char* const sql : {"DELETE FROM codes WHERE motion = ? AND original IS NOT NULL",
                                "DELETE FROM codes WHERE motion = ?", "DELETE FROM motions WHERE id = ?"}) {
    Statement statement(connection, sql);
    for (const std::int64_t id : ids) {
      statement.bind(1, id);
      statement.run();
    }
  }
}

void delete_source(Connection& connection, std::int64_t id) {
  for (const char* const sql : {"DELETE FROM rejections WHERE source = ?", "DELETE FROM sources WHERE id = ?"}) {
    Statement statement(connection, sql);
    statement.bind(1, id);
    statement.run();
  }
}

/// Clips and subjects without motions go. Returns the files that lost a clip and have none left.
std::vector<std::int64_t> delete_bare(Connection& connection) {
  std::vector<std::int64_t> bare;
  Statement row(connection,
                "SELECT source FROM clips WHERE source IS NOT NULL GROUP BY source "
                "HAVING sum(id IN (SELECT clip FROM motions)) = 0");
  while (row.step()) bare.push_back(row.integer(0));
  connection.execute(
      "DELETE FROM clips WHERE id NOT IN (SELECT clip FROM motions);"
      "DELETE FROM subjects WHERE id NOT IN (SELECT subject FROM motions)");
  return bare;
}

}  // namespace

std::size_t remove(Connection& connection, std::span<const std::int64_t> ids) {
  const std::set<std::int64_t> gone = with_images(connection, ids);
  delete_motions(connection, gone);
  for (const std::int64_t source : delete_bare(connection)) delete_source(connection, source);
  return gone.size();
}

std::vector<std::int64_t> motions_of(Connection& connection, std::int64_t id) {
  std::vector<std::int64_t> ids;
  Statement row(connection,
                "SELECT m.id FROM motions m JOIN clips c ON c.id = m.clip WHERE c.source = ? ORDER BY m.id");
  row.bind(1, id);
  while (row.step()) ids.push_back(row.integer(0));
  return ids;
}

std::size_t remove_source(Connection& connection, std::int64_t id) {
  const std::size_t count = remove(connection, motions_of(connection, id));
  delete_source(connection, id);
  return count;
}

}  // namespace reachcast::sources
