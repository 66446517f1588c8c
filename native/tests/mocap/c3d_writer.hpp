// SPDX-License-Identifier: GPL-3.0-or-later
/// Writes small C3D files of every flavour for the tests, from the format's description and without the reader's code.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "reachcast/conventions.hpp"

namespace reachcast::test {

struct C3dFlavour {
  bool is_dec = false;
  bool is_real = true;
  double scale = 0.1;  ///< of integers
};

struct C3dContent {
  std::vector<std::string> names;
  Points points;  ///< frames first, file units; NaN is missing
  double rate_hz = 100.0;
  std::string units = "mm";
  std::string y_screen = "+Z";
  std::size_t analog = 0;           ///< analogue samples per frame, all 7
  std::vector<std::string> angles;  ///< names listed as angles
  bool has_trial = true;
  std::uint8_t processor = 0;  ///< 0: as the flavour says
};

class C3dWriter {
 public:
  explicit C3dWriter(C3dFlavour flavour) : flavour_(flavour) {}

  std::string write(const C3dContent& content) {
    const std::size_t joints = content.names.size();
    const std::size_t frames = content.points.size() / joints;
    const std::string parameters = parameter_section(content, frames);
    const std::size_t data_block = 2 + parameters.size() / 512;
    out_.clear();
    out_ += '\x02';
    out_ += '\x50';
    word(joints);
    word(content.analog);
    word(1);
    word(std::min<std::size_t>(frames, 65535));
    word(10);
    real(flavour_.is_real ? -flavour_.scale : flavour_.scale);
    word(data_block);
    word(content.analog);
    real(content.rate_hz);
    pad(512);
    out_ += parameters;
    for (std::size_t frame = 0; frame < frames; ++frame) {
      for (std::size_t joint = 0; joint < joints; ++joint) point(content.points[frame * joints + joint]);
      for (std::size_t i = 0; i < content.analog; ++i) flavour_.is_real ? real(7.0) : word(7);
    }
    pad(512);
    return out_;
  }

 private:
  std::string parameter_section(const C3dContent& content, std::size_t frames) {
    out_.clear();
    out_ += std::string{'\x01', '\x50', '\x00'};
    out_ += static_cast<char>(content.processor ? content.processor : flavour_.is_dec ? 85 : 84);
    group(1, "POINT");
    begin(1, "USED", 2, {});
    word(content.names.size());
    end();
    begin(1, "SCALE", 4, {});
    real(flavour_.is_real ? -flavour_.scale : flavour_.scale);
    end();
    begin(1, "RATE", 4, {});
    real(content.rate_hz);
    end();
    texts("UNITS", {content.units});
    if (!content.y_screen.empty()) texts("Y_SCREEN", {content.y_screen});
    const std::size_t most = 255;  // names beyond go to LABELS2
    texts("LABELS", {content.names.begin(),
                     content.names.begin() + static_cast<std::ptrdiff_t>(std::min(most, content.names.size()))});
    if (content.names.size() > most) texts("LABELS2", {content.names.begin() + 255, content.names.end()});
    if (!content.angles.empty()) texts("ANGLES", content.angles);
    group(2, "TRIAL");
    if (content.has_trial) {
      begin(2, "ACTUAL_START_FIELD", 2, {2});
      word(1);
      word(0);
      end();
      begin(2, "ACTUAL_END_FIELD", 2, {2});
      word(frames % 65536);
      word(frames / 65536);
      end();
    }
    out_ += '\0';
    pad(512);
    out_[2] = static_cast<char>(out_.size() / 512);
    return out_;
  }

  void group(int id, const std::string& name) {
    out_ += static_cast<char>(name.size());
    out_ += static_cast<char>(-id);
    out_ += name;
    word(3);
    out_ += '\0';
  }
  void begin(int id, const std::string& name, int type, const std::vector<std::size_t>& dimensions) {
    out_ += static_cast<char>(name.size());
    out_ += static_cast<char>(id);
    out_ += name;
    pointer_ = out_.size();
    word(0);
    out_ += static_cast<char>(type);
    out_ += static_cast<char>(dimensions.size());
    for (const std::size_t size : dimensions) out_ += static_cast<char>(size);
  }
  void end() {
    out_ += '\0';  // no description
    const std::size_t distance = out_.size() - pointer_;
    out_[pointer_] = static_cast<char>(distance & 0xFF);
    out_[pointer_ + 1] = static_cast<char>(distance >> 8);
  }
  void texts(const std::string& name, const std::vector<std::string>& rows) {
    std::size_t width = 1;
    for (const std::string& row : rows) width = std::max(width, row.size());
    begin(1, name, -1, {width, rows.size()});
    for (const std::string& row : rows) out_ += row + std::string(width - row.size(), ' ');
    end();
  }

  void pad_row(const std::string& row, std::size_t width) {
    out_ += row;
    out_.append(width - row.size(), ' ');
  }

  void point(const Vec3& p) {
    const bool is_missing = std::isnan(p.x);
    for (int axis = 0; axis < 3; ++axis) {
      const double value = is_missing ? 0.0 : p[axis];
      flavour_.is_real ? real(value) : word(static_cast<std::uint16_t>(std::lround(value / flavour_.scale)));
    }
    flavour_.is_real ? real(is_missing ? -1.0 : 0.0) : word(is_missing ? 0xFFFF : 0);
  }
  void word(std::size_t value) {
    out_ += static_cast<char>(value & 0xFF);
    out_ += static_cast<char>(value >> 8 & 0xFF);
  }
  /// DEC's F format by its definition: sign, exponent biased by 128, fraction 0.1f; the word with the sign first.
  void real(double value) {
    const auto number = static_cast<float>(value);
    if (!flavour_.is_dec) {
      std::uint32_t bits;
      std::memcpy(&bits, &number, 4);
      word(bits & 0xFFFF);
      word(bits >> 16);
      return;
    }
    int exponent = 0;
    const double fraction = std::frexp(std::abs(static_cast<double>(number)), &exponent);  // 0.5 <= fraction < 1
    if (fraction == 0.0) {
      word(0);
      word(0);
      return;
    }
    const auto mantissa = static_cast<std::uint32_t>(std::ldexp(fraction, 24));  // 24 bits, the first one hidden
    const std::uint32_t sign = number < 0.0F ? 1U : 0U;
    word(sign << 15 | static_cast<std::uint32_t>(exponent + 128) << 7 | (mantissa >> 16 & 0x7F));
    word(mantissa & 0xFFFF);
  }
  void pad(std::size_t block) { out_.resize((out_.size() + block - 1) / block * block, '\0'); }

  C3dFlavour flavour_;
  std::string out_;
  std::size_t pointer_ = 0;
};

}  // namespace reachcast::test
