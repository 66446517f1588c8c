// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/resource.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>
#include <limits>

#include "corpus/corpus_cases.hpp"
#include "reachcast/corpus/corpus.hpp"

namespace reachcast::tests {
namespace {

namespace fs = std::filesystem;

/// The message of opening `path`, for reading and for writing alike; it must name the path.
template <typename E>
std::string opening(const fs::path& path) {
  const std::string reading = message_of<E>([&] { (void)Corpus::open(path); });
  const std::string writing = message_of<E>([&] { (void)Corpus::open_for_writing(path); });
  EXPECT_EQ(reading, writing);
  expect_contains(reading, path.string());
  return reading;
}

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

TEST(CorpusErrors, SayWhyAFileIsNotACorpus) {
  const TemporaryFolder folder;
  expect_contains(opening<std::invalid_argument>(folder / "missing"), "does not exist");
  EXPECT_FALSE(fs::exists(folder / "missing")) << "a failed opening must not leave an empty file";
  expect_contains(opening<std::invalid_argument>(folder.path()), "is a folder");
  write_text(folder / "empty", "");
  expect_contains(opening<std::invalid_argument>(folder / "empty"), "empty file");
  write_text(folder / "short", "x");
  expect_contains(opening<std::invalid_argument>(folder / "short"), "not an SQLite file");
  write_text(folder / "text", std::string(5000, 'x'));
  expect_contains(opening<std::invalid_argument>(folder / "text"), "not an SQLite file");
  meddle(folder / "other", "CREATE TABLE t (x)");
  expect_contains(opening<std::invalid_argument>(folder / "other"), "application_id is 0");
  expect_contains(opening<std::invalid_argument>("/dev/null"), "not a regular file");
  expect_contains(opening<std::invalid_argument>(folder / "short" / "below"), "does not exist");
}

TEST(CorpusErrors, NamesBothVersionsOfANewerSchema) {
  const TemporaryFolder folder;
  (void)Corpus::create(folder / "a");
  meddle(folder / "a", "PRAGMA user_version = 7");
  const std::string message = opening<std::invalid_argument>(folder / "a");
  expect_contains(message, "version 7");
  expect_contains(message, "up to " + std::to_string(kCorpusSchemaVersion));
}

TEST(CorpusErrors, CreateNeverTouchesWhatIsThere) {
  const TemporaryFolder folder;
  write_text(folder / "a", "precious");
  expect_contains(message_of<std::invalid_argument>([&] { (void)Corpus::create(folder / "a"); }), "already exists");
  EXPECT_EQ(fs::file_size(folder / "a"), 8U);
  expect_contains(message_of<std::invalid_argument>([&] { (void)Corpus::create(folder.path()); }), "already exists");
  expect_contains(message_of<std::invalid_argument>([&] { (void)Corpus::create(folder / "no" / "a"); }), "no folder");
}

// Cut anywhere, the file is refused on opening or, if the cut is in the header, is no SQLite file any more.
TEST(CorpusErrors, NoticesATruncatedFile) {
  const TemporaryFolder folder;
  Corpus::create(folder / "a").add(random_codes(1, 300, 104));
  const std::uintmax_t size = fs::file_size(folder / "a");
  for (const std::uintmax_t kept : {size - 1, size - 4096, size / 2, std::uintmax_t{5000}, std::uintmax_t{4096},
                                    std::uintmax_t{600}, std::uintmax_t{101}, std::uintmax_t{50}}) {
    fs::copy_file(folder / "a", folder / "cut", fs::copy_options::overwrite_existing);
    fs::resize_file(folder / "cut", kept);
    try {
      (void)Corpus::open(folder / "cut");
      ADD_FAILURE() << kept << " of " << size << " bytes were accepted";
    } catch (const std::exception& error) {
      expect_contains(error.what(), (folder / "cut").string());
    }
  }
}

// Overwritten bytes may hit free space; then nothing is lost. Otherwise the error says so; it never crashes.
TEST(CorpusErrors, SurvivesDamagedBytes) {
  const TemporaryFolder folder;
  Corpus::create(folder / "a").add(random_codes(2, 60, 104));
  std::mt19937_64 random(3);
  for (int round = 0; round < 200; ++round) {
    fs::copy_file(folder / "a", folder / "bad", fs::copy_options::overwrite_existing);
    std::fstream file(folder / "bad", std::ios::in | std::ios::out | std::ios::binary);
    for (int k = 0; k < 16; ++k) {
      file.seekp(static_cast<std::streamoff>(random() % fs::file_size(folder / "a")));
      file.put(static_cast<char>(random()));
    }
    file.close();
    try {
      const Corpus corpus = Corpus::open(folder / "bad");
      (void)corpus.meta();
      (void)corpus.table()->motions();
      (void)corpus.motions();
    } catch (const std::invalid_argument& error) {
      expect_contains(error.what(), (folder / "bad").string());
    } catch (const std::runtime_error& error) {
      expect_contains(error.what(), (folder / "bad").string());
    }
  }
}

TEST(CorpusErrors, SaysWhichMotionIsDamaged) {
  const TemporaryFolder folder;
  const auto damaged_by = [&](const std::string& sql) {
    fs::remove(folder / "a");
    Corpus::create(folder / "a").add(random_codes(4, 3));
    meddle(folder / "a", "PRAGMA ignore_check_constraints = ON; " + sql);
    const Corpus corpus = Corpus::open(folder / "a");
    const std::int64_t id = 2;
    const std::string message = message_of<std::runtime_error>([&] { (void)corpus.motions(); });
    EXPECT_EQ(message, message_of<std::runtime_error>([&] { (void)corpus.load({&id, 1}); }));
    expect_contains(message, "corpus '" + (folder / "a").string() + "' is damaged: motion 2 ");
    return message;
  };
  expect_contains(damaged_by("UPDATE codes SET data = x'0011223344556677' WHERE motion = 2"),
                  "has 8 bytes of coefficients, expected 40");
  expect_contains(damaged_by("DELETE FROM codes WHERE motion = 2"), "has 0 bytes");
  expect_contains(damaged_by("UPDATE codes SET data = x'000000000000F07F000000000000F07F000000000000F07F"
                             "000000000000F07F000000000000F07F' WHERE motion = 2"),
                  "not finite");
  expect_contains(damaged_by("UPDATE motions SET target_y = 9e999 WHERE id = 2"), "infinite target");
  expect_contains(damaged_by("UPDATE motions SET phase = 'dance' WHERE id = 2"), "unknown phase 'dance'");
  expect_contains(damaged_by("PRAGMA foreign_keys = OFF; UPDATE motions SET subject = 99 WHERE id = 2"), "no stature");
  expect_contains(damaged_by("PRAGMA foreign_keys = OFF; UPDATE motions SET clip = 99 WHERE id = 2"), "no origin");
}

TEST(CorpusErrors, RefusesCodesThatCannotBeUsed) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto refused = [&](const std::function<void(MotionCode&)>& spoil) {
    std::vector<MotionCode> codes = random_codes(5, 5);
    spoil(codes[2]);
    const std::string message = message_of<std::invalid_argument>([&] { corpus.add(codes); });
    EXPECT_TRUE(message.starts_with("codes[2].")) << message;
    EXPECT_EQ(corpus.size(), 0U);
    return message;
  };
  expect_contains(refused([&](MotionCode& c) { c.origin = ""; }), "origin is empty");
  expect_contains(refused([&](MotionCode& c) { c.duration_s = 0.0; }), "duration_s is 0.0");
  expect_contains(refused([&](MotionCode& c) { c.duration_s = infinity; }), "duration_s is inf");
  expect_contains(refused([&](MotionCode& c) { c.home.z = nan; }), "home is not finite");
  expect_contains(refused([&](MotionCode& c) { c.target.x = infinity; }), "target is not finite");
  expect_contains(refused([&](MotionCode& c) { c.grip_distance_m = -0.1; }), "grip_distance_m is -0.1");
  expect_contains(refused([&](MotionCode& c) { c.subject.stature_m = 0.0; }), "stature_m is 0.0");
  expect_contains(refused([&](MotionCode& c) { c.subject.age_years = -1.0; }), "age_years is -1.0");
  expect_contains(refused([&](MotionCode& c) { c.subject.mass_kg = 0.0; }), "mass_kg is 0.0");
  expect_contains(refused([&](MotionCode& c) { c.coefficients[3] = nan; }), "coefficients[3] is nan");
  expect_contains(refused([&](MotionCode& c) { c.coefficients.resize(0); }), "coefficients is empty");
  const std::string message = refused([&](MotionCode& c) { c.coefficients = Eigen::VectorXd::Zero(4); });
  expect_contains(message, "has 4 values");
  expect_contains(message, "holds codes of 5");
  EXPECT_EQ(corpus.meta().count("code_length"), 0U) << "the failed call must not fix the length either";
}

// The length is checked inside the transaction, a trigger fails inside SQLite: both undo the codes before them.
TEST(CorpusErrors, UndoEverythingOfTheCallThatFailed) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a");
  std::vector<MotionCode> codes = random_codes(6, 40);
  corpus.add(std::span(codes).first(10));
  meddle(folder / "a",
         "CREATE TRIGGER t BEFORE INSERT ON motions WHEN NEW.duration_s > 1000 BEGIN SELECT RAISE(FAIL, 'boom'); END");
  std::vector<MotionCode> spoiled = codes;
  spoiled[25].duration_s = 2000.0;
  expect_contains(message_of<std::runtime_error>([&] { corpus.add(spoiled); }), "boom");
  EXPECT_EQ(corpus.size(), 10U);
  spoiled = codes;
  spoiled[25].coefficients = Eigen::VectorXd::Zero(3);
  (void)message_of<std::invalid_argument>([&] { corpus.add(spoiled); });
  EXPECT_EQ(corpus.size(), 10U);
  corpus.add(codes);
  EXPECT_EQ(corpus.size(), 40U) << "and the corpus works afterwards";
}

TEST(CorpusErrors, RefusesWritingThroughAReader) {
  const TemporaryFolder folder;
  (void)Corpus::create(folder / "a");
  Corpus reader = Corpus::open(folder / "a");
  EXPECT_FALSE(reader.is_writable());
  const std::vector<MotionCode> codes = random_codes(7, 1);
  expect_contains(message_of<std::invalid_argument>([&] { reader.add(codes); }), "open_for_writing");
  expect_contains(message_of<std::invalid_argument>([&] { reader.set_meta("kind", "x"); }), "open_for_writing");
}

TEST(CorpusErrors, ProtectsItsOwnMetadataAndNamesUnknownIds) {
  const TemporaryFolder folder;
  Corpus corpus = Corpus::create(folder / "a");
  for (const char* key : {"schema_version", "created_by", "code_length", ""}) {
    expect_contains(message_of<std::invalid_argument>([&] { corpus.set_meta(key, "x"); }), "cannot be set");
  }
  const std::int64_t id = 12;
  expect_contains(message_of<std::invalid_argument>([&] { (void)corpus.load({&id, 1}); }), "no motion with id 12");
}

/// Runs `work` in a child process and returns its exit code: what it returns, 99 if it throws.
int in_child(const std::function<int()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    try {
      _exit(work());
    } catch (...) {
      _exit(99);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 98;
}

/// Root may write anywhere, so such a child becomes nobody first.
void drop_privileges() {
  if (geteuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0)) throw std::runtime_error("still root");
}

TEST(CorpusErrors, ReadsFromAReadOnlyFolderAndRefusesToWriteThere) {
  const TemporaryFolder folder;
  Corpus::create(folder / "a").add(random_codes(8, 10));
  fs::permissions(folder / "a", fs::perms::owner_all | fs::perms::group_read | fs::perms::others_read);
  fs::permissions(folder.path(), static_cast<fs::perms>(0555));
  const auto tries = [&] {
    drop_privileges();
    if (Corpus::open(folder / "a").motions().size() != 10) return 1;
    const auto fails = [](const std::function<void()>& action, const std::string& reason) {
      try {
        action();
      } catch (const std::runtime_error& error) {
        return std::string(error.what()).find(reason) != std::string::npos;
      }
      return false;
    };
    if (!fails([&] { (void)Corpus::create(folder / "b"); }, "could not be created")) return 2;
    if (geteuid() == 65534 && !fails([&] { (void)Corpus::open_for_writing(folder / "a"); }, "read-only")) return 3;
    return 0;
  };
  EXPECT_EQ(in_child(tries), 0);
  fs::permissions(folder / "a", static_cast<fs::perms>(0666));
  const auto journal_impossible = [&] {
    drop_privileges();
    Corpus corpus = Corpus::open_for_writing(folder / "a");
    try {
      corpus.add(random_codes(9, 20));
    } catch (const std::runtime_error& error) {
      return std::string(error.what()).find("read-only") != std::string::npos && corpus.size() == 10 ? 0 : 1;
    }
    return 2;
  };
  EXPECT_EQ(in_child(journal_impossible), 0);
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"a"});
}

// A limit on the size of files stands in for a full disk: the write fails in the middle of the commit.
TEST(CorpusErrors, AFailedWriteLeavesTheCorpusAsItWas) {
  const TemporaryFolder folder;
  const std::vector<MotionCode> codes = random_codes(10, 400, 104);
  Corpus::create(folder / "a").add(std::span(codes).first(50));
  const auto writes_too_much = [&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{fs::file_size(folder / "a") + 20'000, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &limit);
    Corpus corpus = Corpus::open_for_writing(folder / "a");
    try {
      corpus.add(codes);
    } catch (const std::runtime_error&) {
      return corpus.size() == 50 ? 0 : 1;
    }
    return 2;
  };
  EXPECT_EQ(in_child(writes_too_much), 0);
  const std::vector<StoredMotion> stored = Corpus::open(folder / "a").motions();
  ASSERT_EQ(stored.size(), 50U);
  for (std::size_t i = 0; i < stored.size(); ++i) expect_same(stored[i].code, codes[i]);
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"a"});
}

// A writer that dies with pages already in the file: readers say how to repair it, a writer does.
TEST(CorpusErrors, RepairsWhatACrashedWriterLeft) {
  const TemporaryFolder folder;
  Corpus::create(folder / "a").add(random_codes(11, 50, 104));
  // Closing the connection would roll back, so the child leaves without.
  const auto dies = [&] {
    sqlite3* handle = nullptr;
    if (sqlite3_open((folder / "a").c_str(), &handle) != SQLITE_OK) return 1;
    return sqlite3_exec(handle,
                        "PRAGMA cache_size = 1; BEGIN; UPDATE motions SET duration_s = 77; "
                        "UPDATE codes SET data = zeroblob(8)",
                        nullptr, nullptr, nullptr) == SQLITE_OK
               ? 0
               : 2;
  };
  ASSERT_EQ(in_child(dies), 0);
  ASSERT_EQ(names_in(folder.path()).size(), 2U) << "the crash should have left a journal";
  const std::string message = message_of<std::runtime_error>([&] { (void)Corpus::open(folder / "a"); });
  expect_contains(message, "opening it for writing repairs it");
  const std::vector<StoredMotion> stored = Corpus::open_for_writing(folder / "a").motions();
  ASSERT_EQ(stored.size(), 50U);
  EXPECT_LT(stored[0].code.duration_s, 77.0);
  EXPECT_EQ(Corpus::open(folder / "a").size(), 50U);
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"a"});
}

}  // namespace
}  // namespace reachcast::tests
