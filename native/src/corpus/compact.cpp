// SPDX-License-Identifier: GPL-3.0-or-later
#include "compact.hpp"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "reachcast/corpus/corpus.hpp"

namespace reachcast::compact {
namespace {

std::int64_t steps(double value) {
  return std::llround(value / kCompactStep);
}

/// Small numbers of either sign become small numbers without one, in as many groups of seven bits as they need.
void put(std::vector<std::byte>& bytes, std::int64_t value) {
  auto rest = (static_cast<std::uint64_t>(value) << 1U) ^ static_cast<std::uint64_t>(value >> 63);
  for (; rest >= 128; rest >>= 7U) bytes.push_back(static_cast<std::byte>(rest | 128U));
  bytes.push_back(static_cast<std::byte>(rest));
}

std::int64_t take(std::span<const std::byte>& bytes) {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 63 && !bytes.empty(); shift += 7) {
    const auto next = std::to_integer<std::uint64_t>(bytes.front());
    bytes = bytes.subspan(1);
    value |= (next & 127U) << shift;
    if (next < 128) return static_cast<std::int64_t>(value >> 1U) ^ -static_cast<std::int64_t>(value & 1U);
  }
  throw std::runtime_error("has coefficients that end too early or are too large");
}

}  // namespace

Eigen::VectorXd rounded(const Eigen::VectorXd& coefficients) {
  return coefficients.unaryExpr([](double value) { return static_cast<double>(steps(value)) * kCompactStep; });
}

std::vector<std::byte> pack(const Eigen::VectorXd& coefficients, const Eigen::VectorXd& base) {
  std::vector<std::byte> bytes;
  std::int64_t before = 0, zeros = 0;
  const auto close_run = [&] {
    if (zeros > 0) put(bytes, 0), put(bytes, zeros - 1);
    zeros = 0;
  };
  for (Eigen::Index i = 0; i < coefficients.size(); ++i) {
    const std::int64_t value = steps(coefficients[i]), difference = value - (base.size() > 0 ? steps(base[i]) : before);
    before = value;
    if (difference == 0) {
      ++zeros;
      continue;
    }
    close_run();
    put(bytes, difference);
  }
  close_run();
  return bytes;
}

Eigen::VectorXd unpack(std::span<const std::byte> bytes, Eigen::Index count, const Eigen::VectorXd& base) {
  Eigen::VectorXd coefficients(count);
  std::int64_t before = 0, zeros = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    std::int64_t difference = 0;
    if (zeros > 0) {
      --zeros;
    } else if (difference = take(bytes); difference == 0) {
      zeros = take(bytes);
      if (zeros < 0 || zeros >= count - i) throw std::runtime_error("has more coefficients than it should");
    }
    const std::int64_t value = difference + (base.size() > 0 ? steps(base[i]) : before);
    coefficients[i] = static_cast<double>(value) * kCompactStep;
    if (!(std::abs(coefficients[i]) <= kLargest)) throw std::runtime_error("has a coefficient that is too large");
    before = value;
  }
  if (!bytes.empty())
    throw std::runtime_error("has " + std::to_string(bytes.size()) + " bytes of coefficients too many");
  return coefficients;
}

}  // namespace reachcast::compact
