// SPDX-License-Identifier: GPL-3.0-or-later
/// Walks through a text file in memory, counting lines, for readers whose errors name the line. Private to mocap/.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace reachcast {

/// The bytes of a file, read in one go. Throws std::invalid_argument when it cannot be read.
[[nodiscard]] std::string read_text_file(const std::string& path);

/// Short, printable form of anything found in a file, in quotes.
[[nodiscard]] std::string quote(std::string_view found);

[[nodiscard]] bool equal_ignoring_case(std::string_view a, std::string_view b);

/// A whole number or decimal of size at most 1e9 that fills the text; a leading plus sign is allowed.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// Line ends are \n, \r\n or a lone \r; blanks are spaces and tabs (and other control characters but line ends).
class TextScanner {
 public:
  TextScanner(std::string_view text, std::string source);

  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] std::size_t remaining() const { return text_.size() - position_; }  ///< bytes
  [[nodiscard]] bool at_end() const { return position_ >= text_.size(); }

  /// Next word on this or a later line; braces are words of their own. Empty at the end of the text.
  std::string_view word();
  [[nodiscard]] std::string_view peek_word();
  /// Rest of the current line up to a brace, trimmed.
  std::string_view rest_of_line();
  /// Next word on this line, commas and braces included; empty at the end of the line, which is not passed.
  std::string_view word_on_line();
  /// Moves past blank lines to the first word of a line; false at the end of the text.
  bool next_line_with_words();
  /// The whole of the current line without its end, and moves past it.
  std::string_view take_line();

  double number(std::string_view what);

  /// Throws std::invalid_argument: "source:line: expected ..., found ...".
  [[noreturn]] void fail(std::string_view expected, std::string_view found) const;
  [[noreturn]] void fail_found(std::string_view expected, std::string_view found_in_words) const;

 private:
  void skip_blanks();
  bool pass_line_end();

  std::string_view text_;
  std::string source_;
  std::size_t position_ = 0;
  std::size_t line_ = 1;
};

}  // namespace reachcast
