// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/wait.h>

#include <atomic>
#include <thread>

#include "corpus/corpus_cases.hpp"
#include "reachcast/corpus/corpus.hpp"

namespace reachcast::tests {
namespace {

constexpr std::size_t kBatch = 25;

/// What a reader may see: whole batches only, each motion complete.
bool is_consistent(const Corpus& corpus) {
  const std::size_t count = corpus.motions().size();
  return count % kBatch == 0 && corpus.table()->motions().size() >= count;
}

void add_in_batches(const std::filesystem::path& path, std::span<const MotionCode> codes) {
  Corpus corpus = Corpus::open_for_writing(path);
  for (std::size_t i = 0; i < codes.size(); i += kBatch) corpus.add(codes.subspan(i, kBatch));
}

TEST(CorpusSharing, ThreadsReadWhileOneWrites) {
  const TemporaryFolder folder;
  const std::vector<MotionCode> codes = random_codes(1, 20 * kBatch, 104);
  (void)Corpus::create(folder / "a");
  std::atomic<bool> done = false;
  std::atomic<int> inconsistent = 0;
  std::vector<std::thread> readers;
  for (int i = 0; i < 4; ++i) {
    readers.emplace_back([&] {
      const Corpus corpus = Corpus::open(folder / "a");
      while (!done) inconsistent += is_consistent(corpus) ? 0 : 1;
    });
  }
  add_in_batches(folder / "a", codes);
  done = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(inconsistent, 0);
  EXPECT_EQ(Corpus::open(folder / "a").size(), codes.size());
}

TEST(CorpusSharing, OneCorpusServesSeveralThreads) {
  const TemporaryFolder folder;
  const std::vector<MotionCode> codes = random_codes(2, 12 * kBatch, 104);
  Corpus corpus = Corpus::create(folder / "a");
  std::atomic<int> inconsistent = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) {
    threads.emplace_back([&] {
      for (int round = 0; round < 10; ++round) inconsistent += is_consistent(corpus) ? 0 : 1;
    });
    threads.emplace_back([&, i] {
      const std::span<const MotionCode> share = std::span(codes).subspan(static_cast<std::size_t>(i) * 4 * kBatch);
      for (std::size_t k = 0; k < 4 * kBatch; k += kBatch) corpus.add(share.subspan(k, kBatch));
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(inconsistent, 0);
  EXPECT_EQ(corpus.size(), codes.size());
}

/// Starts a process that exits with 0 if `work` returns true.
template <typename Work>
pid_t start(const Work& work) {
  const pid_t child = fork();
  if (child == 0) {
    try {
      _exit(work() ? 0 : 1);
    } catch (...) {
      _exit(2);
    }
  }
  return child;
}

TEST(CorpusSharing, ProcessesReadAndWriteAtOnce) {
  const TemporaryFolder folder;
  const std::vector<MotionCode> codes = random_codes(3, 20 * kBatch, 104);
  (void)Corpus::create(folder / "a");
  std::vector<pid_t> children;
  for (std::size_t half = 0; half < 2; ++half) {
    children.push_back(start([&] {
      add_in_batches(folder / "a", std::span(codes).subspan(half * 10 * kBatch, 10 * kBatch));
      return true;
    }));
  }
  for (int i = 0; i < 3; ++i) {
    children.push_back(start([&] {
      for (int round = 0; round < 30; ++round) {
        if (!is_consistent(Corpus::open(folder / "a"))) return false;
      }
      return true;
    }));
  }
  for (const pid_t child : children) {
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  }
  EXPECT_EQ(Corpus::open(folder / "a").size(), codes.size());
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"a"});
}

TEST(CorpusSharing, OfSeveralCreatorsOneSucceeds) {
  const TemporaryFolder folder;
  std::atomic<int> created = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&] {
      try {
        (void)Corpus::create(folder / "a");
        ++created;
      } catch (const std::invalid_argument&) {
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(created, 1);
  EXPECT_EQ(Corpus::open(folder / "a").size(), 0U);
}

TEST(CorpusSharing, AReaderSeesWhatWasAddedAfterItOpened) {
  const TemporaryFolder folder;
  Corpus writer = Corpus::create(folder / "a");
  const Corpus reader = Corpus::open(folder / "a");
  EXPECT_EQ(reader.size(), 0U);
  writer.add(random_codes(4, 7));
  EXPECT_EQ(reader.size(), 7U);
}

}  // namespace
}  // namespace reachcast::tests
