// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/corpus/corpus.hpp"

#include <chrono>

#include "corpus/corpus_cases.hpp"

namespace reachcast::tests {
namespace {

TEST(Corpus, ReturnsCodesBitForBit) {
  const TemporaryFolder folder;
  for (const int count : {0, 1, 2, 50, 500}) {
    const auto path = folder / (std::to_string(count) + ".sqlite");
    const std::vector<MotionCode> codes = random_codes(static_cast<std::uint64_t>(count), count, 104);
    const std::vector<std::int64_t> ids = Corpus::create(path).add(codes);
    const Corpus corpus = Corpus::open(path);
    const std::vector<StoredMotion> stored = corpus.motions();
    ASSERT_EQ(stored.size(), codes.size());
    EXPECT_EQ(corpus.size(), codes.size());
    for (std::size_t i = 0; i < stored.size(); ++i) {
      EXPECT_EQ(stored[i].id, ids[i]);
      expect_same(stored[i].code, codes[i]);
    }
  }
}

TEST(Corpus, StoresCoefficientsAsLittleEndianDoubles) {
  const TemporaryFolder folder;
  MotionCode code = random_codes(3, 1, 2)[0];
  code.coefficients << 1.0, -2.0;
  Corpus::create(folder / "a").add({&code, 1});
  sqlite3* handle = nullptr;
  ASSERT_EQ(sqlite3_open((folder / "a").c_str(), &handle), SQLITE_OK);
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(handle, "SELECT hex(data) FROM codes", -1, &statement, nullptr);
  ASSERT_EQ(sqlite3_step(statement), SQLITE_ROW);
  EXPECT_STREQ(reinterpret_cast<const char*>(sqlite3_column_text(statement, 0)), "000000000000F03F00000000000000C0");
  sqlite3_finalize(statement);
  sqlite3_close(handle);
}

TEST(Corpus, SummariesAgreeWithMotions) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a");
  corpus.add(random_codes(4, 200));
  const std::vector<StoredMotion> motions = corpus.motions();
  const std::vector<MotionSummary> summaries = corpus.table()->motions();
  ASSERT_EQ(summaries.size(), motions.size());
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    const MotionSummary& summary = summaries[i];
    EXPECT_EQ(summary.id, motions[i].id);
    const MotionCode as_code{
        summary.subject,    summary.phase, summary.hands,  summary.origin,          summary.is_mirrored,
        summary.duration_s, summary.home,  summary.target, summary.grip_distance_m, motions[i].code.coefficients};
    expect_same(as_code, motions[i].code);
  }
}

TEST(Corpus, TableIsKeptUntilThisOrAnotherProgramAdds) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a");
  const std::vector<MotionCode> codes = random_codes(11, 9);
  corpus.add(std::span(codes).first(3));
  const Corpus reader = Corpus::open(folder / "a");
  const auto first = reader.table();
  EXPECT_EQ(reader.table(), first);
  EXPECT_EQ(first->motions().size(), 3U);
  corpus.add(std::span(codes).subspan(3, 4));
  EXPECT_EQ(corpus.table()->motions().size(), 7U);
  EXPECT_EQ(reader.table()->motions().size(), 7U);
  EXPECT_EQ(first->motions().size(), 3U) << "what was handed out does not change";
  (void)corpus.table();
  corpus.add(std::span(codes).last(2));
  EXPECT_EQ(corpus.table()->motions().size(), 9U);
}

TEST(Corpus, TableSaysWhenTheFileHasBecomeOneOfANewerSchema) {
  const TemporaryFolder folder;
  (void)Corpus::create(folder / "a");
  const Corpus reader = Corpus::open(folder / "a");
  (void)reader.table();
  sqlite3* handle = nullptr;
  ASSERT_EQ(sqlite3_open((folder / "a").c_str(), &handle), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(handle, "PRAGMA user_version = 99", nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(handle);
  EXPECT_THROW((void)reader.table(), std::invalid_argument);
}

TEST(Corpus, OneCodeIsThatOfItsMotion) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a");
  corpus.add(random_codes(14, 5));
  for (const StoredMotion& motion : corpus.motions()) {
    const auto code = corpus.code(motion.id);
    expect_same(*code, motion.code);
    EXPECT_EQ(corpus.code(motion.id), code);
  }
  EXPECT_THROW((void)corpus.code(99), std::invalid_argument);
  corpus.close();
  EXPECT_THROW((void)corpus.code(1), std::invalid_argument);
}

TEST(Corpus, EqualSubjectsShareOneSubjectId) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a");
  std::vector<MotionCode> codes = random_codes(5, 6);
  const Subject known{1.7, Sex::female, 30.0, std::nullopt};
  const Subject unknown_sex{1.7, std::nullopt, 30.0, std::nullopt};
  for (std::size_t i = 0; i < codes.size(); ++i) codes[i].subject = i % 2 ? known : unknown_sex;
  corpus.add(codes);
  const std::vector<MotionSummary> summaries = corpus.table()->motions();
  for (std::size_t i = 2; i < summaries.size(); ++i) EXPECT_EQ(summaries[i].subject_id, summaries[i - 2].subject_id);
  EXPECT_NE(summaries[0].subject_id, summaries[1].subject_id);
}

TEST(Corpus, AddingTheSameMotionAgainChangesNothing) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a");
  const std::vector<MotionCode> codes = random_codes(6, 20);
  const std::vector<std::int64_t> ids = corpus.add(codes);
  std::vector<MotionCode> again = codes;
  for (MotionCode& code : again) code.duration_s += 1.0;
  EXPECT_EQ(corpus.add(again), ids);
  const std::vector<StoredMotion> stored = corpus.motions();
  ASSERT_EQ(stored.size(), codes.size());
  for (std::size_t i = 0; i < codes.size(); ++i) expect_same(stored[i].code, codes[i]);
}

TEST(Corpus, OriginMirrorAndPhaseTogetherNameAMotion) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a");
  std::vector<MotionCode> codes(4, random_codes(7, 1)[0]);
  codes[1].is_mirrored = !codes[1].is_mirrored;
  codes[2].phase = codes[2].phase == Phase::reach ? Phase::return_ : Phase::reach;
  const std::vector<std::int64_t> ids = corpus.add(codes);
  EXPECT_EQ(corpus.size(), 3U);
  EXPECT_EQ(ids[3], ids[0]) << "a repetition within one call is the same motion too";
}

TEST(Corpus, LoadsTheIdsAskedForInTheirOrder) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a");
  const std::vector<MotionCode> codes = random_codes(8, 30);
  const std::vector<std::int64_t> ids = corpus.add(codes);
  const std::vector<std::int64_t> wanted{ids[17], ids[3], ids[17], ids[29]};
  const std::vector<StoredMotion> loaded = corpus.load(wanted);
  ASSERT_EQ(loaded.size(), 4U);
  expect_same(loaded[0].code, codes[17]);
  expect_same(loaded[1].code, codes[3]);
  expect_same(loaded[2].code, codes[17]);
  expect_same(loaded[3].code, codes[29]);
  EXPECT_TRUE(corpus.load({}).empty());
}

TEST(Corpus, KeepsMetadata) {
  const TemporaryFolder folder;
  {
    Corpus corpus = Corpus::create(folder / "a", "reachcast 9.8");
    corpus.set_meta("kind", "simulated");
    corpus.set_meta("kind", "recorded");
    corpus.set_meta("description", "Zwölf Personen");
    corpus.set_meta("licence", "");
  }
  const std::map<std::string, std::string> expected{
      {"created_by", "reachcast 9.8"},   {"schema_version", "4"}, {"precision", "exact"}, {"kind", "recorded"},
      {"description", "Zwölf Personen"}, {"licence", ""}};
  EXPECT_EQ(Corpus::open(folder / "a").meta(), expected);
}

TEST(Corpus, LeavesOneFileBehind) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a");
  corpus.add(random_codes(9, 100));
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"a"}) << "even before it is closed";
  const Corpus reader = Corpus::open(folder / "a");
  EXPECT_EQ(reader.size(), 100U);
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"a"});
}

TEST(Corpus, ContinuesWhenOpenedForWriting) {
  const TemporaryFolder folder;
  std::vector<MotionCode> codes = random_codes(10, 20);
  Corpus::create(folder / "a").add(std::span(codes).first(10));
  Corpus corpus = Corpus::open_for_writing(folder / "a");
  EXPECT_TRUE(corpus.is_writable());
  corpus.add(codes);
  EXPECT_EQ(corpus.size(), 20U);
}

TEST(Corpus, MovesAndCloses) {
  const TemporaryFolder folder;
  Corpus first = Corpus::create(folder / "a");
  Corpus second = std::move(first);
  EXPECT_TRUE(second.is_open());
  second.close();
  second.close();
  EXPECT_FALSE(second.is_open());
  EXPECT_EQ(second.path(), folder / "a");
  expect_contains(message_of<std::invalid_argument>([&] { (void)second.size(); }), "is closed");
}

// A pass over the summaries must not read the coefficients: 20,000 codes of 600 numbers are 96 MB, their summaries 3
// MB.
TEST(Corpus, ReadsTwentyThousandSummariesQuickly) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a");
  corpus.add(random_codes(11, 20'000, 600));
  const Corpus reader = Corpus::open(folder / "a");
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(reader.table()->motions().size(), 20'000U);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  RecordProperty("seconds", std::to_string(seconds.count()));
  // Measured: 0.02 s. The limit leaves room for sanitizers and a busy machine.
  EXPECT_LT(seconds.count(), 2.0);
}

}  // namespace
}  // namespace reachcast::tests
