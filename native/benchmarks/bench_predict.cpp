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

constexpr int kMotions = 3000;
const Task kTask{.home = {0.0, 0.42, 0.0}, .target = {0.1, 0.42, 1.0}, .object = {}};
const Subject kSubject{.stature_m = 1.72, .sex = {}, .age_years = {}, .mass_kg = {}};

std::vector<MotionCode> varied_codes() {
  std::mt19937_64 random(2004);
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  const MotionCode made = encode_reach(tests::made_lift(1.72, {0.0, 0.42, 0.15}, {0.05, 0.42, 1.1}));
  std::vector<MotionCode> codes(kMotions, made);
  for (std::size_t i = 0; i < codes.size(); ++i) {
    MotionCode& code = codes[i];
    code.origin = "made " + std::to_string(i);
    code.subject.stature_m = between(1.5, 1.95);
    code.home = {between(-0.1, 0.1), between(0.35, 0.5), between(0.1, 0.9)};
    code.target = {between(-0.4, 0.4), between(0.25, 0.5), between(0.4, 1.7)};
    code.duration_s = between(0.8, 2.0);
    for (double& value : code.coefficients) value *= between(0.98, 1.02);
  }
  return codes;
}

/// In a temporary folder that goes with the process.
class BenchCorpus {
 public:
  BenchCorpus() {
    std::string pattern = (std::filesystem::temp_directory_path() / "reachcast-bench-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder at " + pattern);
    folder_ = pattern;
    Corpus::create(folder_ / "bench.sqlite").add(varied_codes());
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
  static const BenchCorpus bench;
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
