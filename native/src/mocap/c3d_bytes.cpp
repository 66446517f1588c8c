// SPDX-License-Identifier: GPL-3.0-or-later
#include "c3d_bytes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace reachcast {
namespace {

constexpr int kIntel = 84, kDec = 85, kMips = 86;
constexpr std::size_t kMostRecords = 100'000;

std::string capitals(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  return result;
}

int signed_byte(std::uint8_t byte) {
  return static_cast<std::int8_t>(byte);
}

}  // namespace

void C3dBytes::fail(const std::string& expected, const std::string& found) const {
  throw std::invalid_argument(source_ + ": expected " + expected + ", found " + found);
}

void C3dBytes::need(std::size_t at, std::size_t length) const {
  if (at <= bytes_.size() && length <= bytes_.size() - at) return;
  fail("data at byte " + std::to_string(at), "a file of only " + std::to_string(bytes_.size()) + " bytes");
}

std::uint8_t C3dBytes::byte(std::size_t at) const {
  need(at, 1);
  return static_cast<std::uint8_t>(bytes_[at]);
}

std::uint16_t C3dBytes::word(std::size_t at) const {
  need(at, 2);
  return static_cast<std::uint16_t>(byte(at) | byte(at + 1) << 8);
}

float C3dBytes::real(std::size_t at, bool is_dec) const {
  const std::uint16_t first = word(at), second = word(at + 2);
  if (is_dec) return from_dec(first, second);
  return std::bit_cast<float>(static_cast<std::uint32_t>(second) << 16 | first);
}

std::string_view C3dBytes::text(std::size_t at, std::size_t length) const {
  need(at, length);
  return bytes_.substr(at, length);
}

float from_dec(std::uint16_t first, std::uint16_t second) {
  if ((first & 0x7F80) == 0) return 0.0F;  // exponent 0 is zero on a DEC, whatever the rest
  return std::bit_cast<float>(static_cast<std::uint32_t>(first) << 16 | second) / 4.0F;
}

C3dParameters::C3dParameters(const C3dBytes& bytes, std::size_t section) : bytes_(bytes) {
  const int processor = bytes.byte(section + 3);
  if (processor == kMips) bytes.fail("Intel or DEC numbers", "MIPS (SGI) numbers, which are not supported");
  if (processor != kIntel && processor != kDec) {
    bytes.fail("processor 84 (Intel) or 85 (DEC) at byte " + std::to_string(section + 3), std::to_string(processor));
  }
  is_dec_ = processor == kDec;
  read_records(section + 4);
  for (std::size_t i = 0; i < found_.size(); ++i) {
    const auto& [group, name] = order_[i];
    parameters_.emplace(groups_[group] + ':' + name, found_[i]);
  }
}

/// A record: length of its name (negative when locked), number of its group (negative for the group itself), name,
/// distance to the next record, contents. The last one is followed by a name of length or a distance of 0.
void C3dParameters::read_records(std::size_t at) {
  for (std::size_t records = 0; at + 1 < bytes_.size(); ++records) {
    if (records > kMostRecords) {
      bytes_.fail("at most " + std::to_string(kMostRecords) + " parameters", "more");
    }
    const auto length = static_cast<std::size_t>(std::abs(signed_byte(bytes_.byte(at))));
    const int group = signed_byte(bytes_.byte(at + 1));
    if (length == 0 || group == 0) return;
    const std::string name = capitals(bytes_.text(at + 2, length));
    const std::size_t pointer = at + 2 + length;
    const std::size_t distance = bytes_.word(pointer);
    if (group < 0) {
      groups_[-group] = name;
    } else {
      read_parameter(group, name, pointer + 2);
    }
    if (distance == 0) return;
    at = pointer + distance;
  }
}

void C3dParameters::read_parameter(int group, const std::string& name, std::size_t at) {
  C3dParameter parameter;
  parameter.type = signed_byte(bytes_.byte(at));
  const std::size_t dimensions = bytes_.byte(at + 1);
  const bool is_known = parameter.type == -1 || parameter.type == 1 || parameter.type == 2 || parameter.type == 4;
  if (!is_known || dimensions > 7) {
    bytes_.fail("a parameter of type -1, 1, 2 or 4 with at most 7 dimensions at byte " + std::to_string(at),
                "type " + std::to_string(parameter.type) + " with " + std::to_string(dimensions));
  }
  const auto width = static_cast<std::size_t>(std::abs(parameter.type));
  for (std::size_t i = 0; i < dimensions; ++i) {
    parameter.dimensions.push_back(bytes_.byte(at + 2 + i));
    parameter.count *= parameter.dimensions.back();
    if (parameter.count > bytes_.size()) bytes_.fail("a parameter that fits into the file", "a larger one");
  }
  parameter.at = at + 2 + dimensions;
  (void)bytes_.text(parameter.at, parameter.count * width);
  order_.emplace_back(group, name);
  found_.push_back(parameter);
}

std::optional<double> C3dParameters::number(const std::string& name, std::size_t element) const {
  const auto found = parameters_.find(name);
  if (found == parameters_.end() || element >= found->second.count) return std::nullopt;
  const C3dParameter& parameter = found->second;
  if (parameter.type == 4) return bytes_.real(parameter.at + 4 * element, is_dec_);
  if (parameter.type == 2) return bytes_.word(parameter.at + 2 * element);
  if (parameter.type == 1) return bytes_.byte(parameter.at + element);
  return std::nullopt;
}

std::vector<std::string> C3dParameters::texts(const std::string& name) const {
  const auto found = parameters_.find(name);
  if (found == parameters_.end() || found->second.type != -1) return {};
  const C3dParameter& parameter = found->second;
  const std::size_t width = parameter.dimensions.empty() ? 1 : parameter.dimensions.front();
  std::vector<std::string> rows;
  for (std::size_t at = 0; width > 0 && at < parameter.count; at += width) {
    std::string_view row = bytes_.text(parameter.at + at, width);
    while (!row.empty() && (row.back() == ' ' || row.back() == '\0')) row.remove_suffix(1);
    while (!row.empty() && row.front() == ' ') row.remove_prefix(1);
    rows.emplace_back(row);
  }
  return rows;
}

std::vector<std::string> C3dParameters::all_texts(const std::string& name) const {
  std::vector<std::string> rows = texts(name);
  for (int part = 2; parameters_.contains(name + std::to_string(part)); ++part) {
    const std::vector<std::string> more = texts(name + std::to_string(part));
    rows.insert(rows.end(), more.begin(), more.end());
  }
  return rows;
}

}  // namespace reachcast
