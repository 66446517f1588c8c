// SPDX-License-Identifier: GPL-3.0-or-later
/// Neighbours among 1,000,000 motions, against sorting all ranks in the same run, and the cross-validation of 3,000
/// motions over 60 schemes.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <random>
#include <thread>

#include "../tests/motion/made_lift.hpp"
#include "reachcast/corpus/corpus.hpp"
#include "reachcast/motion/encode.hpp"
#include "reachcast/predict/cross_validate.hpp"
#include "reachcast/predict/neighbours.hpp"

namespace {

using namespace reachcast;

constexpr int kMany = 1'000'000;
constexpr int kQueries = 64;
constexpr int kSubjects = 20, kPerSubject = 150;  // 3,000, as in the 2004 paper

double between(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
}

Query random_query(std::mt19937_64& random) {
  Query query;
  query.home = {between(random, -0.1, 0.1), between(random, 0.35, 0.5), between(random, 0.1, 0.9)};
  query.target = {between(random, -0.4, 0.4), between(random, 0.25, 0.5), between(random, 0.4, 1.7)};
  query.subject.stature_m = between(random, 1.55, 1.95);
  return query;
}

const MotionTable& many_motions() {
  static const MotionTable table = [] {
    std::mt19937_64 random(1);
    std::vector<MotionSummary> motions(kMany);
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const Query like = random_query(random);
      motions[i].id = static_cast<std::int64_t>(i) + 1;
      motions[i].subject = like.subject;
      motions[i].home = like.home;
      motions[i].target = like.target;
      motions[i].is_mirrored = i % 2 == 1;
      motions[i].duration_s = between(random, 0.8, 2.0);
    }
    return MotionTable(std::move(motions));
  }();
  return table;
}

/// Rank of each value; equal ones share the smallest.
std::vector<std::uint32_t> ranks_of(const std::vector<double>& values) {
  std::vector<std::uint32_t> order(values.size()), ranks(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return values[a] < values[b]; });
  std::uint32_t rank = 0;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    if (values[order[i]] > values[order[rank]]) rank = i;
    ranks[order[i]] = rank;
  }
  return ranks;
}

/// The method as p. 549 says it: rank all motions by the task, rank all by stature, add, take the k smallest.
std::vector<std::int64_t> nearest_by_sorting(const MotionTable& table, const Query& query, int k) {
  const PhaseColumns& columns = table.of(query.phase);
  std::vector<double> task(columns.size()), stature(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Vec3 home = columns.home[i] - query.home, target = columns.target[i] - query.target;
    task[i] = 0.0625 * glm::dot(home, home) + glm::dot(target, target);
    stature[i] = std::abs(columns.traits[0][i] - query.subject.stature_m);
  }
  const std::vector<std::uint32_t> by_task = ranks_of(task), by_stature = ranks_of(stature);
  std::vector<std::uint32_t> order(columns.size());
  std::iota(order.begin(), order.end(), 0u);
  std::partial_sort(order.begin(), order.begin() + k, order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t x = by_task[a] + by_stature[a], y = by_task[b] + by_stature[b];
    return x != y ? x < y : a < b;
  });
  std::vector<std::int64_t> ids;
  for (int i = 0; i < k; ++i) ids.push_back(table.motions()[columns.rows[order[static_cast<std::size_t>(i)]]].id);
  return ids;
}

std::vector<std::int64_t> ids_of(const std::vector<Neighbour>& nearest) {
  std::vector<std::int64_t> ids;
  for (const Neighbour& n : nearest) ids.push_back(n.id);
  return ids;
}

double seconds_of(const auto& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Counter `ratio`: time of sorting all ranks over the time of the search, of the same queries one after the other.
/// Stops with an error where the two differ.
void bm_neighbours_of_a_million(benchmark::State& state) {
  const MotionTable& table = many_motions();
  const int k = static_cast<int>(state.range(0));
  std::mt19937_64 random(2);
  double sorting_s = 0.0, search_s = 0.0;
  std::int64_t searches = 0, sortings = 0;
  for (auto _ : state) {
    const Query query = random_query(random);
    std::vector<std::int64_t> found;
    const double took_s = seconds_of([&] { found = ids_of(nearest_motions(table, query, End::target, {.k = k})); });
    state.SetIterationTime(took_s);
    search_s += took_s;
    if (searches++ % 16 != 0) continue;
    std::vector<std::int64_t> sorted;
    sorting_s += seconds_of([&] { sorted = nearest_by_sorting(table, query, k); });
    ++sortings;
    if (sorted != found) state.SkipWithError("the search and sorting all ranks differ");
  }
  state.counters["sorting_ms"] = 1e3 * sorting_s / static_cast<double>(sortings);
  state.counters["ratio"] = sorting_s / static_cast<double>(sortings) / (search_s / static_cast<double>(searches));
}
BENCHMARK(bm_neighbours_of_a_million)
    ->Arg(1)
    ->Arg(5)
    ->Arg(20)
    ->UseManualTime()
    ->Iterations(kQueries)
    ->Unit(benchmark::kMillisecond);

/// Once for each change of the corpus.
void bm_index_of_a_million(benchmark::State& state) {
  const PhaseColumns& columns = many_motions().of(Phase::transfer);
  for (auto _ : state) benchmark::DoNotOptimize(TaskIndex(columns.home, columns.target));
}
BENCHMARK(bm_index_of_a_million)->Unit(benchmark::kMillisecond);

/// Lifts of 20 people, made up from formulas; each person's coefficients differ a little from lift to lift.
class ManyLifts {
 public:
  ManyLifts() {
    std::string pattern = (std::filesystem::temp_directory_path() / "reachcast-bench-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder at " + pattern);
    folder_ = pattern;
    corpus.emplace(Corpus::create(folder_ / "bench.sqlite"));
    corpus->add(codes());
  }
  ~ManyLifts() {
    corpus.reset();
    std::filesystem::remove_all(folder_);
  }
  ManyLifts(const ManyLifts&) = delete;
  ManyLifts& operator=(const ManyLifts&) = delete;
  std::optional<Corpus> corpus;

 private:
  static std::vector<MotionCode> codes() {
    std::mt19937_64 random(2004);
    std::vector<MotionCode> codes;
    for (int s = 0; s < kSubjects; ++s) {
      const Subject subject{.stature_m = between(random, 1.55, 1.95),
                            .sex = s % 2 ? Sex::male : Sex::female,
                            .age_years = between(random, 20.0, 60.0),
                            .mass_kg = between(random, 50.0, 95.0)};
      for (int i = 0; i < kPerSubject; ++i) {
        const Vec3 home(between(random, -0.05, 0.05), between(random, 0.40, 0.44), between(random, 0.2, 0.8));
        const Vec3 target(between(random, -0.2, 0.2), between(random, 0.36, 0.42), between(random, 0.7, 1.2));
        MotionCode code = encode_reach(tests::made_lift(subject.stature_m, home, target, 25, 1.25, 0.36));
        code.subject = subject;
        code.duration_s = between(random, 0.8, 2.0);
        code.origin = std::to_string(s) + "/" + std::to_string(i);
        for (double& value : code.coefficients) value *= between(random, 0.98, 1.02);
        codes.push_back(code);
      }
    }
    return codes;
  }
  std::filesystem::path folder_;
};

void bm_cross_validate(benchmark::State& state) {
  static const ManyLifts lifts;
  const std::vector<Scheme> schemes = all_schemes();
  const CrossValidation options{.leave_out = state.range(0) == 0 ? LeaveOut::motion : LeaveOut::subject};
  std::vector<SchemeError> rows;
  for (auto _ : state) rows = cross_validate(*lifts.corpus, schemes, options);
  state.counters["motions"] = static_cast<double>(rows.front().motions);
  state.counters["out_of_reach"] = static_cast<double>(rows.front().out_of_reach);
  state.counters["schemes"] = static_cast<double>(rows.size());
  state.counters["threads"] = std::thread::hardware_concurrency();
}
BENCHMARK(bm_cross_validate)
    ->Arg(0)
    ->Arg(1)
    ->ArgName("by_subject")
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

}  // namespace

BENCHMARK_MAIN();
