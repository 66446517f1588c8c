// SPDX-License-Identifier: GPL-3.0-or-later
/// The tables of a corpus. Private to this folder.
#pragma once

#include <string_view>

#include "reachcast/corpus/corpus.hpp"
#include "sqlite.hpp"

namespace reachcast::schema {

/// Makes the tables of an empty database and what the metadata always holds, in one transaction.
void write_empty_corpus(sqlite::Connection& connection, std::string_view created_by, Precision precision);

/// Sets one value of the metadata, new or not.
void put_meta(sqlite::Connection& connection, std::string_view key, std::string_view value);

}  // namespace reachcast::schema
