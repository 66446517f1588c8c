// SPDX-License-Identifier: GPL-3.0-or-later
/// Rows about imported files, within a transaction that the caller began. Private to this folder.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reachcast/corpus/source.hpp"
#include "sqlite.hpp"

namespace reachcast::sources {

/// What makes a file impossible to store, in words; empty if nothing does.
[[nodiscard]] std::string complaint(const SourceFile& file);

struct Key {
  std::int64_t id;
  std::string settings;
};
[[nodiscard]] std::optional<Key> find(sqlite::Connection& connection, const std::string& checksum);
[[nodiscard]] std::int64_t insert(sqlite::Connection& connection, const SourceFile& file,
                                  std::span<const StoredRejection> rejections);
[[nodiscard]] std::vector<StoredSource> all(sqlite::Connection& connection);

/// In id order; none for an unknown file.
[[nodiscard]] std::vector<std::int64_t> motions_of(sqlite::Connection& connection, std::int64_t id);

/// Takes away a file and the motions that came from it. Returns how many motions there were.
std::size_t remove_source(sqlite::Connection& connection, std::int64_t id);

/// Takes away the motions with these ids and, with the last of them, their clip and its file. Mirror images that are
/// kept as a difference go with their motion. Returns how many motions there were.
std::size_t remove(sqlite::Connection& connection, std::span<const std::int64_t> ids);

}  // namespace reachcast::sources
