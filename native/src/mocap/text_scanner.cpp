// SPDX-License-Identifier: GPL-3.0-or-later
#include "text_scanner.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace reachcast {
namespace {

constexpr double kLargestNumber = 1e9;  // nothing recorded is this far away; keeps every later product finite

bool is_line_end(char c) {
  return c == '\n' || c == '\r';
}
bool is_blank(char c) {
  return static_cast<unsigned char>(c) <= ' ' && !is_line_end(c);
}
bool is_brace(char c) {
  return c == '{' || c == '}';
}
char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

}  // namespace

std::string read_text_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  constexpr std::streamoff largest = std::streamoff{1} << 32;  // a directory reports nonsense
  if (size < 0 || size > largest) throw std::invalid_argument(path + ": cannot be read as a file of at most 4 GB");
  std::string text(static_cast<std::size_t>(size), '\0');
  file.seekg(0);
  if (!file.read(text.data(), size)) throw std::invalid_argument(path + ": cannot be read");
  return text;
}

std::string quote(std::string_view found) {
  constexpr std::size_t longest = 40;
  std::string shown(found.substr(0, longest));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return '"' + shown + (found.size() > longest ? "...\"" : "\"");
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

std::optional<double> parse_number(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if (!(std::abs(value) <= kLargestNumber)) return std::nullopt;
  return value;
}

TextScanner::TextScanner(std::string_view text, std::string source) : text_(text), source_(std::move(source)) {
  if (text_.starts_with("\xEF\xBB\xBF")) position_ = 3;
}

void TextScanner::skip_blanks() {
  while (position_ < text_.size() && is_blank(text_[position_])) ++position_;
}

bool TextScanner::pass_line_end() {
  if (at_end() || !is_line_end(text_[position_])) return false;
  const bool pair = text_[position_] == '\r' && position_ + 1 < text_.size() && text_[position_ + 1] == '\n';
  position_ += pair ? 2 : 1;
  ++line_;
  return true;
}

bool TextScanner::next_line_with_words() {
  do skip_blanks();
  while (pass_line_end());
  return !at_end();
}

std::string_view TextScanner::word() {
  if (!next_line_with_words()) return {};
  const std::size_t begin = position_++;
  if (is_brace(text_[begin])) return text_.substr(begin, 1);
  while (!at_end() && !is_blank(text_[position_]) && !is_line_end(text_[position_]) && !is_brace(text_[position_])) {
    ++position_;
  }
  return text_.substr(begin, position_ - begin);
}

std::string_view TextScanner::peek_word() {
  const std::size_t position = position_;
  const std::size_t line = line_;
  const std::string_view found = word();
  position_ = position;
  line_ = line;
  return found;
}

std::string_view TextScanner::rest_of_line() {
  skip_blanks();
  const std::size_t begin = position_;
  while (!at_end() && !is_line_end(text_[position_]) && !is_brace(text_[position_])) ++position_;
  std::size_t end = position_;
  while (end > begin && is_blank(text_[end - 1])) --end;
  return text_.substr(begin, end - begin);
}

std::string_view TextScanner::word_on_line() {
  skip_blanks();
  const std::size_t begin = position_;
  while (!at_end() && static_cast<unsigned char>(text_[position_]) > ' ') ++position_;
  return text_.substr(begin, position_ - begin);
}

std::string_view TextScanner::take_line() {
  const std::size_t begin = position_;
  const std::size_t end = std::min(text_.find_first_of("\r\n", begin), text_.size());
  position_ = end;
  pass_line_end();
  return text_.substr(begin, end - begin);
}

double TextScanner::number(std::string_view what) {
  const std::string_view found = word();
  const std::optional<double> value = parse_number(found);
  if (!value) fail(what, found);
  return *value;
}

void TextScanner::fail(std::string_view expected, std::string_view found) const {
  fail_found(expected, found.empty() ? std::string("the end of the file") : quote(found));
}

void TextScanner::fail_found(std::string_view expected, std::string_view found_in_words) const {
  throw std::invalid_argument(source_ + ':' + std::to_string(line_) + ": expected " + std::string(expected) +
                              ", found " + std::string(found_in_words));
}

}  // namespace reachcast
