// SPDX-License-Identifier: GPL-3.0-or-later
/// What a prediction of 50 frames costs on a rig: joint centres to turns, forward again, and to key values.
#include <benchmark/benchmark.h>

#include "../tests/rig/rig_cases.hpp"
#include "reachcast/rig/retarget.hpp"
#include "reachcast/rig/rotation_values.hpp"

namespace {

using namespace reachcast;

constexpr std::size_t kFrames = 50;

struct Case {
  tests::RigParts parts = tests::made_rig();
  RestRig rest = parts.rig();
  std::vector<Posture> motion = tests::made_motion(parts, 1, kFrames);
  RigPose pose = retarget(rest, motion);
};

const Case& rig_case() {
  static const Case made;
  return made;
}

void bm_retarget(benchmark::State& state) {
  const Case& c = rig_case();
  for (auto _ : state) benchmark::DoNotOptimize(retarget(c.rest, c.motion));
  state.counters["bones"] = static_cast<double>(c.rest.keyed().size());
}
BENCHMARK(bm_retarget)->Unit(benchmark::kMicrosecond);

void bm_posed_joints(benchmark::State& state) {
  const Case& c = rig_case();
  for (auto _ : state) benchmark::DoNotOptimize(posed_joints(c.rest, c.pose));
}
BENCHMARK(bm_posed_joints)->Unit(benchmark::kMicrosecond);

/// Retargeting and the values of every keyed bone.
void bm_keys(benchmark::State& state, const char* mode_name) {
  const Case& c = rig_case();
  const RotationMode mode = rotation_mode(mode_name);
  for (auto _ : state) {
    const RigPose pose = retarget(c.rest, c.motion);
    for (const int bone : c.rest.keyed()) {
      benchmark::DoNotOptimize(rotation_values(local_rotations(c.rest, pose, bone), mode));
    }
  }
}
BENCHMARK_CAPTURE(bm_keys, quaternion, "QUATERNION")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(bm_keys, axis_angle, "AXIS_ANGLE")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(bm_keys, euler, "XYZ")->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
