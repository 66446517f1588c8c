// SPDX-License-Identifier: GPL-3.0-or-later
/// Prediction and its parts on a corpus of 3,000 motions: made-up lifts, encoded once, then varied a little.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <random>

#include "../tests/motion/made_lift.hpp"
#include "reachcast/corpus/corpus.hpp"
#include "reachcast/motion/encode.hpp"
#include "reachcast/posture/hold.hpp"
#include "reachcast/posture/linkage.hpp"
#include "reachcast/predict/predict.hpp"

namespace {

using namespace reachcast;

constexpr std::size_t kMotions = 3000;
const std::vector<Phase> kFourPhases{Phase::transfer, Phase::return_, Phase::reach, Phase::retrieve};
const Task kTask{.home = {0.0, 0.42, 0.0}, .target = {0.1, 0.42, 1.0}, .object = {}};
const Subject kSubject{.stature_m = 1.72, .sex = {}, .age_years = {}, .mass_kg = {}};

Reach made_motion(Phase phase) {
  if (is_loaded(phase)) {
    const Reach lift = tests::made_lift(1.72, {0.0, 0.42, 0.15}, {0.05, 0.42, 1.1});
    return phase == Phase::transfer ? lift : reversed(lift);
  }
  Reach reach = tests::made_lift(1.72, {0.0, 0.32, 0.7}, {0.05, 0.42, 1.1});
  reach.phase = Phase::reach;
  return phase == Phase::reach ? reach : reversed(reach);
}

/// A corpus of `phases`, equally many motions of each.
std::vector<MotionCode> varied_codes(const std::vector<Phase>& phases) {
  std::mt19937_64 random(2004);
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  std::vector<MotionCode> made;
  for (const Phase phase : phases) made.push_back(encode_reach(made_motion(phase)));
  std::vector<MotionCode> codes;
  for (std::size_t i = 0; i < kMotions; ++i) {
    MotionCode& code = codes.emplace_back(made[i % made.size()]);
    code.origin = "made " + std::to_string(i);
    code.subject.stature_m = between(1.5, 1.95);
    const Vec3 low(between(-0.1, 0.1), between(0.35, 0.5), between(0.1, 0.9));
    const Vec3 high(between(-0.4, 0.4), between(0.25, 0.5), between(0.4, 1.7));
    code.home = code.phase == Phase::retrieve || code.phase == Phase::return_ ? high : low;
    code.target = code.phase == Phase::retrieve || code.phase == Phase::return_ ? low : high;
    code.duration_s = between(0.8, 2.0);
    for (double& value : code.coefficients) value *= between(0.98, 1.02);
  }
  return codes;
}

/// In a temporary folder that goes with the process.
class BenchCorpus {
 public:
  explicit BenchCorpus(const std::vector<Phase>& phases) {
    std::string pattern = (std::filesystem::temp_directory_path() / "reachcast-bench-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder at " + pattern);
    folder_ = pattern;
    Corpus::create(folder_ / "bench.sqlite").add(varied_codes(phases));
    corpus.emplace(Corpus::open(folder_ / "bench.sqlite"));
  }
  ~BenchCorpus() {
    corpus.reset();
    std::filesystem::remove_all(folder_);
  }
  BenchCorpus(const BenchCorpus&) = delete;
  BenchCorpus& operator=(const BenchCorpus&) = delete;
  std::optional<Corpus> corpus;

 private:
  std::filesystem::path folder_;
};

const Corpus& bench_corpus() {
  static const BenchCorpus bench({Phase::transfer});
  return *bench.corpus;
}

const Corpus& four_phase_corpus() {
  static const BenchCorpus bench(kFourPhases);
  return *bench.corpus;
}

void bm_predict(benchmark::State& state) {
  const Body body = Body::from_stature(1.72);
  const Corpus& corpus = bench_corpus();
  std::size_t frames = 0;
  for (auto _ : state) frames = predict(corpus, kSubject, kTask, body).postures.size();
  state.counters["frames"] = static_cast<double>(frames);
}
BENCHMARK(bm_predict)->Unit(benchmark::kMillisecond);

/// The 2004 paper (p. 551) takes 0.01 s on an 850 MHz Pentium III for its motions. Here four phases of some 20 frames
/// each, as one motion with its pauses, from 750 motions of each phase.
void bm_predict_four_phases(benchmark::State& state) {
  const Body body = Body::from_stature(1.72);
  const Corpus& corpus = four_phase_corpus();
  PredictOptions options;
  options.frame_rate = 15.0;
  options.phases = kFourPhases;
  for (const Phase phase : kFourPhases) options.durations_s[phase] = 20.0 / options.frame_rate;
  Motion motion;
  for (auto _ : state) motion = predict(corpus, kSubject, kTask, body, options);
  state.counters["frames"] = static_cast<double>(motion.postures.size());
}
BENCHMARK(bm_predict_four_phases)->Unit(benchmark::kMicrosecond);

/// More frames of the same motion.
void bm_predict_frames(benchmark::State& state) {
  const Body body = Body::from_stature(1.72);
  const Corpus& corpus = bench_corpus();
  PredictOptions options;
  options.frame_rate = static_cast<double>(state.range(0));
  std::size_t frames = 0;
  for (auto _ : state) frames = predict(corpus, kSubject, kTask, body, options).postures.size();
  state.SetComplexityN(static_cast<benchmark::IterationCount>(frames));
}
BENCHMARK(bm_predict_frames)->RangeMultiplier(2)->Range(30, 960)->Complexity(benchmark::oN);

/// A chain of so many links, its pivots halving it.
void bm_decode_links(benchmark::State& state) {
  const auto links = static_cast<std::size_t>(state.range(0));
  std::vector<std::size_t> pivots;
  for (std::size_t step = links / 2; step > 0; step /= 2) {
    for (std::size_t joint = step; joint < links; joint += 2 * step) pivots.push_back(joint);
  }
  const Chain chain(std::vector<double>(links, 0.1), pivots);
  const std::vector<double> coordinates(chain.coordinate_count(), 0.3);
  Points points(links + 1);
  const Vec3 end(0.05 * static_cast<double>(links), 0.0, 0.0);
  for (auto _ : state) {
    chain.decode(Vec3(0.0), end, coordinates, points);
    benchmark::DoNotOptimize(points.data());
  }
  state.SetComplexityN(state.range(0));
}
BENCHMARK(bm_decode_links)->RangeMultiplier(2)->Range(4, 256)->Complexity(benchmark::oN);

void bm_neighbours(benchmark::State& state) {
  const std::shared_ptr<const MotionTable> table = bench_corpus().table();
  const Query query{Phase::transfer, {0.0, 0.42, 0.12}, {0.1, 0.42, 1.12}, kSubject, {}};
  for (auto _ : state) benchmark::DoNotOptimize(nearest_motions(*table, query, End::target, Scheme{.k = 5}));
}
BENCHMARK(bm_neighbours)->Unit(benchmark::kMicrosecond);

/// The first prediction after the file has changed reads the table again.
void bm_open_and_read_table(benchmark::State& state) {
  const std::filesystem::path path = bench_corpus().path();
  for (auto _ : state) benchmark::DoNotOptimize(Corpus::open(path).table());
}
BENCHMARK(bm_open_and_read_table)->Unit(benchmark::kMillisecond);

void bm_encode_posture(benchmark::State& state) {
  const Posture posture = tests::holding_posture(Body::from_stature(1.72), {0.05, 0.42, 0.8}, 0.4);
  for (auto _ : state) benchmark::DoNotOptimize(encode_posture(two_handed_linkage(), posture));
}
BENCHMARK(bm_encode_posture)->Unit(benchmark::kMicrosecond);

void bm_encode_reach(benchmark::State& state) {
  const Reach reach = tests::made_lift(1.72, {0.0, 0.42, 0.15}, {0.05, 0.42, 1.1});
  for (auto _ : state) benchmark::DoNotOptimize(encode_reach(reach));
}
BENCHMARK(bm_encode_reach)->Unit(benchmark::kMicrosecond);

/// One frame: decode the trunk, bring it within reach, span the limbs.
void bm_decode_and_hold(benchmark::State& state) {
  const Body body = Body::from_stature(1.72);
  const Posture posture = tests::holding_posture(body, {0.05, 0.42, 0.8}, 0.4);
  const Eigen::VectorXd coordinates = encode_posture(two_handed_linkage(), posture);
  const BodyLinkage linkage(two_handed_linkage(), body);
  const Holder holder(two_handed_linkage(), body, 71.0);
  Anchors anchors = anchors_of(posture);
  for (Vec3& grip : anchors.grip) grip += Vec3(0.03, 0.02, 0.05);
  for (auto _ : state) {
    HoldReport report;
    benchmark::DoNotOptimize(holder.hold(linkage.decode(coordinates, anchors), anchors, {}, report));
  }
}
BENCHMARK(bm_decode_and_hold)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
