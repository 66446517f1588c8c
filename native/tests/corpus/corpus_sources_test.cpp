// SPDX-License-Identifier: GPL-3.0-or-later
/// Files that motions come from: kept, skipped, replaced, taken away.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <random>
#include <stdexcept>

#include "corpus_cases.hpp"
#include "reachcast/corpus/corpus.hpp"
#include "reachcast/motion/encode.hpp"
#include "reachcast/motion/mirror_code.hpp"

namespace reachcast::tests {
namespace {

const SourceFile kFile{"lifts/é.bvh", "sha256:01", 1234, "reachcast 1.0", "centimetres, y up", "stature 1.8"};
const std::array<StoredRejection, 2> kLeftOut{{{"reach, frames 3 to 9", "a foot steps"}, {"transfer", "it is short"}}};

TEST(CorpusSources, AFileIsKeptWithWhatItGaveAndWhatWasLeftOut) {
  const TemporaryFolder folder;
  const std::vector<MotionCode> codes = random_codes(1, 3);
  {
    Corpus corpus = Corpus::create(folder / "a", "test");
    const auto added = corpus.add_source(kFile, codes, kLeftOut);
    ASSERT_TRUE(added);
    EXPECT_EQ(added->motions, 3U);
  }
  const Corpus corpus = Corpus::open(folder / "a");
  const std::vector<StoredSource> sources = corpus.sources();
  ASSERT_EQ(sources.size(), 1U);
  EXPECT_EQ(sources[0].file.path, kFile.path);
  EXPECT_EQ(sources[0].file.checksum, kFile.checksum);
  EXPECT_EQ(sources[0].file.bytes, kFile.bytes);
  EXPECT_EQ(sources[0].file.tool, kFile.tool);
  EXPECT_EQ(sources[0].file.note, kFile.note);
  EXPECT_EQ(sources[0].file.settings, kFile.settings);
  EXPECT_EQ(sources[0].motions, 3U);
  ASSERT_EQ(sources[0].rejections.size(), 2U);
  EXPECT_EQ(sources[0].rejections[0].what, kLeftOut[0].what);
  EXPECT_EQ(sources[0].rejections[1].reason, kLeftOut[1].reason);
  for (std::size_t i = 0; i < codes.size(); ++i) expect_same(corpus.motions()[i].code, codes[i]);
}

TEST(CorpusSources, TheSameFileAgainChangesNothingAndOtherSettingsReplaceIt) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a", "test");
  const std::vector<MotionCode> codes = random_codes(2, 4), fewer(codes.begin() + 1, codes.begin() + 3);
  corpus.add(random_codes(3, 1));
  ASSERT_TRUE(corpus.add_source(kFile, codes, kLeftOut));
  SourceFile again = kFile;
  again.path = "moved.bvh";
  EXPECT_TRUE(corpus.has_source(again.checksum, again.settings));
  EXPECT_FALSE(corpus.add_source(again, codes, kLeftOut));
  EXPECT_EQ(corpus.sources()[0].file.path, kFile.path);

  again.settings = "stature 1.7";
  EXPECT_FALSE(corpus.has_source(again.checksum, again.settings));
  ASSERT_TRUE(corpus.add_source(again, fewer, {}));
  const std::vector<StoredSource> sources = corpus.sources();
  ASSERT_EQ(sources.size(), 1U);
  EXPECT_EQ(sources[0].file.path, again.path);
  EXPECT_EQ(sources[0].motions, 2U);
  EXPECT_TRUE(sources[0].rejections.empty());
  EXPECT_EQ(corpus.size(), 3U);
}

TEST(CorpusSources, AFileGoesWithItsLastMotion) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a", "test");
  ASSERT_TRUE(corpus.add_source(kFile, random_codes(4, 2), kLeftOut));
  const SourceFile empty{"nothing.bvh", "sha256:02", 0, "", "", ""};
  ASSERT_TRUE(corpus.add_source(empty, {}, kLeftOut));
  const std::array<std::int64_t, 2> first{1, 77};
  EXPECT_EQ(corpus.remove(first), 1U);
  EXPECT_EQ(corpus.sources().size(), 2U);
  const std::array<std::int64_t, 1> second{2};
  EXPECT_EQ(corpus.remove(second), 1U);
  ASSERT_EQ(corpus.sources().size(), 1U);
  EXPECT_EQ(corpus.sources()[0].file.path, empty.path);  // it never had a motion, so none was taken away
  EXPECT_EQ(corpus.size(), 0U);
  EXPECT_TRUE(corpus.add_source(kFile, random_codes(4, 2), kLeftOut));
}

TEST(CorpusSources, MirrorImagesKeptAsADifferenceGoWithTheirMotion) {
  const TemporaryFolder folder;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::vector<MotionCode> codes;
  for (int i = 0; i < 2; ++i) {
    MotionCode code = random_code(random, i, static_cast<int>(code_length()));
    code.is_mirrored = false;
    for (double& value : code.coefficients) value = normal(random);
    codes.push_back(code);
    code.is_mirrored = true;
    code.coefficients = mirror_image(code.coefficients);
    codes.push_back(code);
  }
  Corpus corpus = Corpus::create(folder / "a", "test", Precision::compact);
  const std::vector<std::int64_t> ids = corpus.add(codes);
  EXPECT_EQ(corpus.remove(std::span(ids).subspan(0, 1)), 2U);
  ASSERT_EQ(corpus.size(), 2U);
  EXPECT_EQ(corpus.motions()[0].code.origin, codes[2].origin);
  EXPECT_EQ(corpus.remove(std::span(ids).subspan(3, 1)), 1U);  // an image alone
  EXPECT_EQ(corpus.size(), 1U);
}

TEST(CorpusSources, EachFileKnowsItsMotions) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a", "test");
  const std::vector<MotionCode> codes = random_codes(7, 6);
  corpus.add(std::span(codes).subspan(0, 1));
  ASSERT_TRUE(corpus.add_source(kFile, std::span(codes).subspan(1, 2), {}));
  SourceFile other = kFile;
  other.checksum = "sha256:03";
  const auto second =
      corpus.add_source(other, std::span(codes).subspan(2, 4), {});  // the first of them is there already
  ASSERT_TRUE(second);
  EXPECT_EQ(corpus.motions_of(1), (std::vector<std::int64_t>{2, 3}));
  EXPECT_EQ(corpus.motions_of(second->id), (std::vector<std::int64_t>{4, 5, 6}));
  EXPECT_TRUE(corpus.motions_of(99).empty());
}

TEST(CorpusSources, WhatCannotBeStoredLeavesNothing) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a", "test");
  std::vector<MotionCode> codes = random_codes(6, 3);
  codes[2].duration_s = -1.0;
  expect_contains(message_of<std::invalid_argument>([&] { corpus.add_source(kFile, codes, {}); }), "codes[2]");
  codes = random_codes(6, 3);
  codes[2].coefficients.conservativeResize(2);  // seen only while the rows are written
  expect_contains(message_of<std::invalid_argument>([&] { corpus.add_source(kFile, codes, {}); }), "codes[2]");
  SourceFile nameless = kFile;
  nameless.checksum.clear();
  expect_contains(message_of<std::invalid_argument>([&] { corpus.add_source(nameless, {}, {}); }), "checksum is empty");
  EXPECT_TRUE(corpus.sources().empty());
  EXPECT_EQ(corpus.size(), 0U);
  Corpus reader = Corpus::open(folder / "a");
  expect_contains(message_of<std::invalid_argument>([&] { reader.add_source(kFile, {}, {}); }),
                  "opened for reading only");
}

}  // namespace
}  // namespace reachcast::tests
