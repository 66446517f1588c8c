// SPDX-License-Identifier: GPL-3.0-or-later
#include "schema.hpp"

#include <string>

namespace reachcast::schema {
namespace {

// Coefficients have a table of their own: a pass over `motions` then reads little, however long the codes are.
// `original` is set where `data` holds but the difference from the mirror image of another motion.
constexpr const char* kTables = R"sql(
CREATE TABLE meta (
  key TEXT PRIMARY KEY NOT NULL,
  value TEXT NOT NULL
) STRICT;
CREATE TABLE subjects (
  id INTEGER PRIMARY KEY,
  stature_m REAL NOT NULL,
  sex TEXT CHECK (sex IN ('female', 'male')),
  age_years REAL,
  mass_kg REAL
) STRICT;
CREATE INDEX subjects_by_value ON subjects (stature_m, sex, age_years, mass_kg);
CREATE TABLE sources (
  id INTEGER PRIMARY KEY,
  path TEXT NOT NULL,
  checksum TEXT NOT NULL UNIQUE,
  bytes INTEGER NOT NULL,
  tool TEXT NOT NULL,
  note TEXT NOT NULL,
  settings TEXT NOT NULL
) STRICT;
CREATE TABLE rejections (
  id INTEGER PRIMARY KEY,
  source INTEGER NOT NULL REFERENCES sources (id),
  what TEXT NOT NULL,
  reason TEXT NOT NULL
) STRICT;
CREATE TABLE clips (
  id INTEGER PRIMARY KEY,
  origin TEXT NOT NULL UNIQUE,
  source INTEGER REFERENCES sources (id)
) STRICT;
CREATE INDEX clips_by_source ON clips (source);
CREATE TABLE motions (
  id INTEGER PRIMARY KEY,
  subject INTEGER NOT NULL REFERENCES subjects (id),
  clip INTEGER NOT NULL REFERENCES clips (id),
  phase TEXT NOT NULL,
  hands TEXT NOT NULL CHECK (hands IN ('both', 'left', 'right')),
  mirrored INTEGER NOT NULL CHECK (mirrored IN (0, 1)),
  duration_s REAL NOT NULL,
  home_x REAL NOT NULL, home_y REAL NOT NULL, home_z REAL NOT NULL,
  target_x REAL NOT NULL, target_y REAL NOT NULL, target_z REAL NOT NULL,
  grip_distance_m REAL NOT NULL,
  UNIQUE (clip, mirrored, phase)
) STRICT;
CREATE TABLE codes (
  motion INTEGER PRIMARY KEY REFERENCES motions (id),
  original INTEGER REFERENCES motions (id),
  data BLOB NOT NULL
) STRICT;
)sql";

}  // namespace

void put_meta(sqlite::Connection& connection, std::string_view key, std::string_view value) {
  sqlite::Statement statement(connection, "INSERT OR REPLACE INTO meta (key, value) VALUES (?, ?)");
  statement.bind(1, key);
  statement.bind(2, value);
  statement.run();
}

void write_empty_corpus(sqlite::Connection& connection, std::string_view created_by, Precision precision) {
  sqlite::Transaction transaction(connection, sqlite::Transaction::Kind::write);
  connection.execute("PRAGMA application_id = " + std::to_string(kCorpusApplicationId) +
                     "; PRAGMA user_version = " + std::to_string(kCorpusSchemaVersion));
  connection.execute(kTables);
  put_meta(connection, "schema_version", std::to_string(kCorpusSchemaVersion));
  put_meta(connection, "created_by", created_by);
  put_meta(connection, "precision", precision == Precision::compact ? "compact" : "exact");
  put_meta(connection, "kind", "");
  put_meta(connection, "description", "");
  transaction.commit();
}

}  // namespace reachcast::schema
