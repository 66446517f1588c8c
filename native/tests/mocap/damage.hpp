// SPDX-License-Identifier: GPL-3.0-or-later
/// Damages files in every way that disks, editors and mischief do.
#pragma once

#include <random>
#include <string>

#include "mocap_cases.hpp"

namespace reachcast::test {

/// Between one and `changes` bytes flipped, cut out, put in or repeated, now and then the end cut off.
inline std::string damaged(std::string text, std::mt19937& random, int changes) {
  const int count = 1 + static_cast<int>(random() % static_cast<unsigned>(changes));
  for (int i = 0; i < count && !text.empty(); ++i) {
    const std::size_t at = random() % text.size();
    switch (random() % 8) {
      case 0:
        text.erase(at, 1 + random() % 20);
        break;
      case 1:
        text.insert(at, 1 + random() % 3, static_cast<char>(random() % 256));
        break;
      case 2:
        text.insert(at, text.substr(random() % text.size(), random() % 100));
        break;
      case 3:
        text.resize(at);
        break;
      case 4:
        text[at] = static_cast<char>(random() % 2 ? 0xFF : 0x7F);
        break;
      case 5:
        text[at] = "{}0123456789.-+eE \t\r\n:"[random() % 22];
        break;
      default:
        text[at] = static_cast<char>(text[at] ^ (1 << random() % 8));
    }
  }
  return text;
}

/// Calls read(bytes) on `cases` damaged copies; anything it throws but std::invalid_argument ends the test. Returns how
/// many were read.
template <typename Read>
std::size_t survivors(const std::string& whole, int cases, Read read, std::size_t head = std::string::npos) {
  std::mt19937 random(20240611);
  std::size_t count = 0;
  for (int i = 0; i < cases; ++i) {
    // Every other case changes the head only, where sizes and counts are.
    const std::size_t part = i % 2 == 0 ? whole.size() : std::min(head, whole.size());
    const std::string bytes = damaged(whole.substr(0, part), random, 1 + i % 8) + whole.substr(part);
    count += complaint([&] { read(bytes); }).empty();
  }
  return count;
}

}  // namespace reachcast::test
