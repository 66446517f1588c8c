// SPDX-License-Identifier: GPL-3.0-or-later
/// A compact corpus against the codes that were put into it.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <stdexcept>

#include "corpus_cases.hpp"
#include "reachcast/corpus/corpus.hpp"
#include "reachcast/motion/encode.hpp"
#include "reachcast/motion/mirror_code.hpp"

namespace reachcast::tests {
namespace {

/// As many coefficients as a real code has, of every size that is legal.
MotionCode code_of(std::mt19937_64& random, int number, bool mirrored) {
  MotionCode code = random_code(random, number, static_cast<int>(code_length()));
  code.is_mirrored = mirrored;
  code.phase = Phase::transfer;
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-5.0, 5.9);
  for (double& value : code.coefficients)
    value = normal(random) > 2.0 ? std::pow(10.0, exponent(random)) : normal(random);
  return code;
}

MotionCode image_of(const MotionCode& code) {
  MotionCode image = code;
  image.is_mirrored = true;
  image.coefficients = mirror_image(code.coefficients);
  return image;
}

void expect_within_half_a_step(const MotionCode& back, const MotionCode& code) {
  EXPECT_LE((back.coefficients - code.coefficients).cwiseAbs().maxCoeff(), 0.5 * kCompactStep * (1.0 + 1e-9));
  MotionCode same = code;
  same.coefficients = back.coefficients;
  expect_same(back, same);
}

TEST(CompactCorpus, GivesBackWhatWasAddedToHalfAStep) {
  const TemporaryFolder folder;
  std::mt19937_64 random(3);
  std::vector<MotionCode> codes;
  for (int i = 0; i < 20; ++i) {
    codes.push_back(code_of(random, i, false));
    codes.push_back(image_of(codes.back()));                    // what follows from the motion
    if (i % 3 == 0) codes.back().coefficients.array() += 0.01;  // what nearly does
    if (i % 5 == 0) codes.erase(codes.end() - 2);               // an image without its motion
  }
  Corpus corpus = Corpus::create(folder / "a", "test", Precision::compact);
  const std::vector<std::int64_t> ids = corpus.add(codes);
  const std::vector<StoredMotion> all = corpus.motions(), some = Corpus::open(folder / "a").load(ids);
  ASSERT_EQ(all.size(), codes.size());
  for (std::size_t i = 0; i < codes.size(); ++i) {
    expect_within_half_a_step(all[i].code, codes[i]);
    expect_within_half_a_step(some[i].code, codes[i]);
  }
  EXPECT_EQ(corpus.meta().at("precision"), "compact");
}

TEST(CompactCorpus, TakesAFractionOfTheBytesAndNextToNothingForImages) {
  const TemporaryFolder folder;
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0.0, 0.02);  // of what a coefficient differs by from the one before it
  std::vector<MotionCode> codes;
  for (int i = 0; i < 100; ++i) {
    codes.push_back(random_code(random, i, static_cast<int>(code_length())));
    codes.back().is_mirrored = false;
    for (double& value : codes.back().coefficients) value = normal(random);
  }
  const auto bytes = [&](const char* name, Precision precision, bool images) {
    Corpus corpus = Corpus::create(folder / name, "test", precision);
    const auto empty = std::filesystem::file_size(folder / name);
    for (const MotionCode& code : codes) {
      corpus.add({&code, 1});
      const MotionCode image = image_of(code);
      if (images) corpus.add({&image, 1});
    }
    return static_cast<double>(std::filesystem::file_size(folder / name) - empty);
  };
  const double exact = bytes("exact", Precision::exact, false), compact = bytes("compact", Precision::compact, false);
  EXPECT_LT(compact, 0.30 * exact);
  EXPECT_LT(bytes("images", Precision::compact, true), 1.15 * compact);
}

TEST(CompactCorpus, RefusesWhatItCannotHold) {
  const TemporaryFolder folder;
  std::mt19937_64 random(5);
  Corpus corpus = Corpus::create(folder / "a", "test", Precision::compact);
  for (const double value : {1.1e6, -1e300, std::numeric_limits<double>::quiet_NaN()}) {
    MotionCode code = code_of(random, 0, false);
    code.coefficients[7] = value;
    EXPECT_THROW(corpus.add({&code, 1}), std::invalid_argument);
  }
  EXPECT_EQ(corpus.size(), 0u);
  EXPECT_THROW(corpus.set_meta("precision", "exact"), std::invalid_argument);
}

TEST(CompactCorpus, SaysThatItIsDamaged) {
  const TemporaryFolder folder;
  std::mt19937_64 random(6);
  const MotionCode code = code_of(random, 1, false), image = image_of(code);
  for (const char* spoil :
       {"UPDATE codes SET data = x'80'", "UPDATE codes SET data = x'0002' WHERE original IS NULL",
        "UPDATE codes SET data = x'00ffffffffffffffffff7f'", "UPDATE codes SET data = CAST(data || x'01' AS BLOB)",
        "UPDATE codes SET data = CAST(x'ffffffffffffffffff7f' || zeroblob(983) AS BLOB)",
        "UPDATE codes SET data = x'' WHERE original IS NULL",
        "UPDATE codes SET original = NULL WHERE original IS NOT NULL; UPDATE codes SET data = x'0101'"}) {
    std::filesystem::remove(folder / "a");
    {
      Corpus corpus = Corpus::create(folder / "a", "test", Precision::compact);
      corpus.add({&code, 1});
      corpus.add({&image, 1});
    }
    meddle(folder / "a", spoil);
    const Corpus corpus = Corpus::open(folder / "a");
    try {
      (void)corpus.motions();
      ADD_FAILURE() << spoil;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("is damaged: motion "), std::string::npos) << error.what();
    }
  }
}

TEST(CompactCorpus, ASchemaOfBeforeIsToBeBuiltAnew) {
  for (const std::string version : {"1", "2"}) {
    const TemporaryFolder folder;
    (void)Corpus::create(folder / "a");
    meddle(folder / "a", "PRAGMA user_version = " + version);
    const std::string message = message_of<std::invalid_argument>([&] { (void)Corpus::open(folder / "a"); });
    expect_contains(message, "schema version " + version);
    expect_contains(message, "build it anew");
  }
}

}  // namespace
}  // namespace reachcast::tests
