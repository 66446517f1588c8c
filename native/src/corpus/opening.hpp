// SPDX-License-Identifier: GPL-3.0-or-later
/// The file behind a corpus: found or made, checked, and its errors turned into sentences. Private to this folder.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "sqlite.hpp"

namespace reachcast::opening {

/// "corpus '/path' ", the start of every message.
[[nodiscard]] std::string quoted(const std::filesystem::path& path);

/// Says what SQLite's error means for this corpus: std::invalid_argument or std::runtime_error.
[[noreturn]] void rethrow(const sqlite::Error& error, const std::filesystem::path& path);

/// Runs `work`; what SQLite says about it becomes a sentence about this corpus.
template <typename Work>
auto reporting(const std::filesystem::path& path, const Work& work) {
  try {
    return work();
  } catch (const sqlite::Error& error) {
    rethrow(error, path);
  }
}

/// Opens a corpus that exists, after checking that it is one that this program can read.
[[nodiscard]] std::unique_ptr<sqlite::Connection> open_checked(const std::filesystem::path& path, bool for_writing);

/// std::invalid_argument unless the file says that it is a corpus of a schema that this program can read.
void require_corpus(sqlite::Connection& connection, const std::filesystem::path& path);

/// Takes the name in the folder, or fails: of two programs that create the same corpus only one succeeds.
void claim_file(const std::filesystem::path& path);

/// Opens without any check.
[[nodiscard]] std::unique_ptr<sqlite::Connection> connect(const std::filesystem::path& path, bool for_writing);

}  // namespace reachcast::opening
