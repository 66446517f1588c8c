// SPDX-License-Identifier: GPL-3.0-or-later
/// How fast recordings are read on one core, from text or bytes in memory to joint centres, in MB/s of the file.
/// bm_bvh_numbers_by_stream only takes the same numbers out with operator>>, without computing anything: the yardstick.
#include <benchmark/benchmark.h>

#include <cmath>
#include <sstream>
#include <string>

#include "../tests/mocap/c3d_writer.hpp"
#include "reachcast/mocap/bvh.hpp"
#include "reachcast/mocap/c3d.hpp"
#include "reachcast/mocap/csv_motion.hpp"
#include "reachcast/mocap/trc.hpp"

namespace {

using namespace reachcast;

constexpr std::size_t kJoints = 40;
constexpr std::size_t kFrames = 20'000;  // 166 s at 120 Hz

const MotionFileOptions kGiven{.metres_per_unit = 0.01, .up = "y", .rate_hz = 120.0, .interval = {}};

std::string skeleton() {
  std::ostringstream text;
  text << "HIERARCHY\nROOT joint0\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
          "Yrotation\n";
  for (std::size_t i = 1; i < kJoints; ++i) {
    text << "JOINT joint" << i << "\n{\nOFFSET 0.5 4.25 -0.125\nCHANNELS 3 Zrotation Xrotation Yrotation\n";
  }
  text << "End Site\n{\nOFFSET 0 4 0\n}\n";
  for (std::size_t i = 0; i < kJoints; ++i) text << "}\n";
  return text.str();
}

/// Six decimals, as most tools write.
const std::string& bvh() {
  static const std::string made = [] {
    std::string text = skeleton() + "MOTION\nFrames: " + std::to_string(kFrames) + "\nFrame Time: 0.008333\n";
    for (std::size_t frame = 0; frame < kFrames; ++frame) {
      for (std::size_t i = 0; i < 3 + 3 * kJoints; ++i) {
        text += std::to_string(60.0 * std::sin(0.01 * static_cast<double>(frame) + static_cast<double>(i))) + ' ';
      }
      text.back() = '\n';
    }
    return text;
  }();
  return made;
}

void set_speed(benchmark::State& state, std::size_t bytes) {
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * bytes));
  state.counters["MB"] = static_cast<double>(bytes) * 1e-6;
}

void bm_bvh(benchmark::State& state) {
  const std::string& text = bvh();
  for (auto _ : state) benchmark::DoNotOptimize(parse_bvh(text, "made.bvh", kGiven));
  set_speed(state, bvh().size());
}
BENCHMARK(bm_bvh)->Unit(benchmark::kMillisecond);

void bm_bvh_numbers_by_stream(benchmark::State& state) {
  const std::string numbers = bvh().substr(bvh().find("0.008333\n") + 9);
  for (auto _ : state) {
    std::istringstream stream(numbers);
    double value = 0.0, sum = 0.0;
    while (stream >> value) sum += value;
    benchmark::DoNotOptimize(sum);
  }
  set_speed(state, numbers.size());
}
BENCHMARK(bm_bvh_numbers_by_stream)->Unit(benchmark::kMillisecond);

std::vector<Vec3> points() {
  std::vector<Vec3> made;
  for (std::size_t i = 0; i < kJoints * kFrames; ++i) {
    const double t = 0.001 * static_cast<double>(i);
    made.emplace_back(800 * std::sin(t), 900 * std::cos(t), 900 + 850 * std::sin(3 * t));
  }
  return made;
}

void bm_c3d(benchmark::State& state) {
  test::C3dContent content;
  for (std::size_t i = 0; i < kJoints; ++i) content.names.push_back(std::to_string(i) + "M");
  content.points = points();
  const std::string bytes = test::C3dWriter({state.range(0) != 0, state.range(1) != 0}).write(content);
  for (auto _ : state) benchmark::DoNotOptimize(parse_c3d(bytes, "made.c3d", kGiven));
  set_speed(state, bytes.size());
}
BENCHMARK(bm_c3d)->ArgNames({"dec", "real"})->ArgsProduct({{0, 1}, {0, 1}})->Unit(benchmark::kMillisecond);

void bm_trc(benchmark::State& state) {
  std::ostringstream text;
  text << "PathFileType\t4\t(X/Y/Z)\tmade.trc\nDataRate\tNumFrames\tNumMarkers\tUnits\n120\t" << kFrames << '\t'
       << kJoints << "\tmm\nFrame#\tTime";
  for (std::size_t i = 0; i < kJoints; ++i) text << "\tM" << i << "\t\t";
  text << "\n\t\tX1\tY1\tZ1\n";
  const std::vector<Vec3> made = points();
  for (std::size_t frame = 0; frame < kFrames; ++frame) {
    text << frame + 1 << "\t0.0";
    for (std::size_t i = 0; i < kJoints; ++i) {
      const Vec3& p = made[frame * kJoints + i];
      text << '\t' << p.x << '\t' << p.y << '\t' << p.z;
    }
    text << '\n';
  }
  const std::string whole = text.str();
  for (auto _ : state) benchmark::DoNotOptimize(parse_trc(whole, "made.trc", kGiven));
  set_speed(state, whole.size());
}
BENCHMARK(bm_trc)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
