// SPDX-License-Identifier: GPL-3.0-or-later
/// A folder that disappears with the test, random codes, and a way to meddle with a corpus behind its back.
#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "reachcast/corpus/corpus.hpp"

namespace reachcast::tests {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "reachcast-corpus-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder at " + pattern);
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::permissions(path_, std::filesystem::perms::owner_all, ignored);
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Any finite double, all exponents alike: what a lossy path through text or float would change.
inline double any_double(std::mt19937_64& random) {
  for (;;) {
    const auto value = std::bit_cast<double>(random());
    if (std::isfinite(value)) return value;
  }
}

inline MotionCode random_code(std::mt19937_64& random, int number, int length = 5) {
  std::uniform_real_distribution<double> uniform(0.01, 2.0);
  MotionCode code;
  code.subject.stature_m = uniform(random);
  if (random() % 2) code.subject.sex = random() % 2 ? Sex::female : Sex::male;
  if (random() % 2) code.subject.age_years = uniform(random);
  if (random() % 2) code.subject.mass_kg = uniform(random);
  code.phase = static_cast<Phase>(random() % 4);
  code.hands = static_cast<Hands>(random() % 3);
  code.origin = "folder/clip é.csv:" + std::to_string(number);
  code.is_mirrored = random() % 2 == 1;
  code.duration_s = uniform(random);
  code.home = Vec3(any_double(random), -0.0, uniform(random));
  code.target = Vec3(uniform(random), any_double(random), 5e-324);
  code.grip_distance_m = uniform(random) - 0.01;
  code.coefficients.resize(length);
  for (double& value : code.coefficients) value = any_double(random);
  code.coefficients[0] = -0.0;
  return code;
}

inline std::vector<MotionCode> random_codes(std::uint64_t seed, int count, int length = 5) {
  std::mt19937_64 random(seed);
  std::vector<MotionCode> codes;
  for (int i = 0; i < count; ++i) codes.push_back(random_code(random, i, length));
  return codes;
}

/// Equal in every bit, except that a scalar -0.0 may come back as 0.0.
inline void expect_same(const MotionCode& a, const MotionCode& b) {
  EXPECT_EQ(a.subject.stature_m, b.subject.stature_m);
  EXPECT_EQ(a.subject.sex, b.subject.sex);
  EXPECT_EQ(a.subject.age_years, b.subject.age_years);
  EXPECT_EQ(a.subject.mass_kg, b.subject.mass_kg);
  EXPECT_EQ(a.phase, b.phase);
  EXPECT_EQ(a.hands, b.hands);
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.is_mirrored, b.is_mirrored);
  EXPECT_EQ(a.duration_s, b.duration_s);
  EXPECT_EQ(a.home, b.home);
  EXPECT_EQ(a.target, b.target);
  EXPECT_EQ(a.grip_distance_m, b.grip_distance_m);
  ASSERT_EQ(a.coefficients.size(), b.coefficients.size());
  for (Eigen::Index i = 0; i < a.coefficients.size(); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.coefficients[i]), std::bit_cast<std::uint64_t>(b.coefficients[i])) << i;
  }
}

/// Runs SQL on the file as another program would.
inline void meddle(const std::filesystem::path& path, const std::string& sql) {
  sqlite3* handle = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &handle), SQLITE_OK);
  char* message = nullptr;
  EXPECT_EQ(sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, &message), SQLITE_OK) << (message ? message : "");
  sqlite3_free(message);
  sqlite3_close(handle);
}

/// The message of the E that `action` throws, or a failure.
template <typename E>
std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const E& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "another kind of error: " << error.what();
    return "";
  }
  ADD_FAILURE() << "no error";
  return "";
}

inline void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

/// Names of the files beside the corpus, which should be none.
inline std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  return names;
}

}  // namespace reachcast::tests
