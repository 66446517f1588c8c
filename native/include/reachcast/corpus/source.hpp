// SPDX-License-Identifier: GPL-3.0-or-later
/// Where the motions of a corpus come from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace reachcast {

/// A file that was imported. Files with the same checksum are one and the same.
struct SourceFile {
  std::string path;      ///< as it was given
  std::string checksum;  ///< of its bytes, in words that tell how it was made: "sha256:..."
  std::int64_t bytes = 0;
  std::string tool;      ///< what read it, with version
  std::string note;      ///< how it was understood, for people: unit, axes, rate; may be empty
  std::string settings;  ///< what else decided the result (who, labels, overrides), in any fixed spelling; may be empty
};

/// Something in the file that did not become a motion.
struct StoredRejection {
  std::string what;    ///< such as "transfer, frames 10 to 45"
  std::string reason;  ///< such as "a foot steps"
};

struct StoredSource {
  std::int64_t id = 0;
  SourceFile file;
  std::size_t motions = 0;  ///< mirror images included
  std::vector<StoredRejection> rejections;
};

}  // namespace reachcast
