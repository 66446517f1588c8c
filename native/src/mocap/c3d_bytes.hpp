// SPDX-License-Identifier: GPL-3.0-or-later
/// Bytes of a C3D file and the parameters in them. Private to mocap/.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace reachcast {

/// Numbers at given places, checked against the end of the file. Integers are little-endian on both processors.
class C3dBytes {
 public:
  C3dBytes(std::string_view bytes, std::string source) : bytes_(bytes), source_(std::move(source)) {}

  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] const std::string& source() const { return source_; }
  [[nodiscard]] std::uint8_t byte(std::size_t at) const;
  [[nodiscard]] std::uint16_t word(std::size_t at) const;
  [[nodiscard]] float real(std::size_t at, bool is_dec) const;
  [[nodiscard]] std::string_view text(std::size_t at, std::size_t length) const;
  [[noreturn]] void fail(const std::string& expected, const std::string& found) const;

 private:
  void need(std::size_t at, std::size_t length) const;

  std::string_view bytes_;
  std::string source_;
};

/// DEC's F format has the words exchanged and an exponent greater by 2 than IEEE's.
[[nodiscard]] float from_dec(std::uint16_t first, std::uint16_t second);

struct C3dParameter {
  int type = 0;  ///< bytes per element: 1, 2, 4; -1: characters
  std::vector<std::size_t> dimensions;
  std::size_t at = 0;     ///< of the first element
  std::size_t count = 1;  ///< elements, all inside the file
};

/// The parameters of a file by "GROUP:NAME" in capitals.
class C3dParameters {
 public:
  /// Throws std::invalid_argument for a broken section and for MIPS numbers.
  C3dParameters(const C3dBytes& bytes, std::size_t section);

  [[nodiscard]] bool is_dec() const { return is_dec_; }
  /// One element as a number; integers are taken without sign. Empty when absent or too short.
  [[nodiscard]] std::optional<double> number(const std::string& name, std::size_t element = 0) const;
  /// Rows of characters, blanks at the end removed; a single text is one row.
  [[nodiscard]] std::vector<std::string> texts(const std::string& name) const;
  /// NAME, NAME2, NAME3, ... one after the other.
  [[nodiscard]] std::vector<std::string> all_texts(const std::string& name) const;

 private:
  void read_records(std::size_t at);
  void read_parameter(int group, const std::string& name, std::size_t at);

  const C3dBytes& bytes_;
  bool is_dec_ = false;
  std::map<int, std::string> groups_;
  std::vector<std::pair<int, std::string>> order_;
  std::vector<C3dParameter> found_;
  std::map<std::string, C3dParameter> parameters_;
};

}  // namespace reachcast
