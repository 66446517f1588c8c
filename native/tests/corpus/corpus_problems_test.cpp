// SPDX-License-Identifier: GPL-3.0-or-later
/// What `check` finds in files that were meddled with.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "corpus_cases.hpp"
#include "reachcast/corpus/corpus.hpp"

namespace reachcast::tests {
namespace {

std::string problems_after(const std::string& sql) {
  const TemporaryFolder folder;
  (void)Corpus::create(folder / "a").add(random_codes(1, 5));
  meddle(folder / "a", sql);
  std::string all;
  for (const std::string& problem : Corpus::open(folder / "a").check()) all += problem + "\n";
  return all;
}

TEST(CorpusProblems, ASoundCorpusHasNone) {
  EXPECT_EQ(problems_after("SELECT 1"), "");
}

TEST(CorpusProblems, EachIsNamedWithItsMotion) {
  expect_contains(problems_after("UPDATE motions SET phase = 'dance' WHERE id = 3"),
                  "motion 3 has the unknown phase 'dance'");
  expect_contains(problems_after("UPDATE codes SET data = x'0011' WHERE motion = 2"),
                  "motion 2 has 2 bytes of coefficients, expected 40");
  const std::string both = problems_after("UPDATE motions SET duration_s = 9e999 WHERE id IN (1, 4)");
  expect_contains(both, "motion 1 has an infinite duration");
  expect_contains(both, "motion 4 has an infinite duration");
}

TEST(CorpusProblems, ReferencesToNothingAreFound) {
  expect_contains(problems_after("PRAGMA foreign_keys = OFF; DELETE FROM clips WHERE id = 2"),
                  "row 2 of the table motions refers to a row of clips that is not there");
}

TEST(CorpusProblems, OverwrittenPagesAreFoundAndThereIsAnEndToTheList) {
  const TemporaryFolder folder;
  (void)Corpus::create(folder / "a").add(random_codes(1, 400, 60));
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(folder / "a"));
  {
    std::fstream file(folder / "a", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(size / 2);
    file << std::string(static_cast<std::size_t>(size / 4), '\x5a');
  }
  const std::vector<std::string> problems = Corpus::open(folder / "a").check();
  EXPECT_FALSE(problems.empty());
  EXPECT_LE(problems.size(), kMostProblems);
}

}  // namespace
}  // namespace reachcast::tests
