// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/pybind11.h>

#include <algorithm>
#include <vector>

#include "array_checks.hpp"
#include "module.hpp"
#include "reachcast/corpus/corpus.hpp"
#include "reachcast/predict/replay.hpp"

namespace py = pybind11;
using namespace pybind11::literals;

namespace {

using namespace reachcast;

std::vector<Posture> replayed(const Corpus& corpus, std::int64_t id, std::size_t frames) {
  if (frames < 2 || frames > 100'000)
    throw std::invalid_argument("frames is " + std::to_string(frames) + "; it must be 2 to 100000");
  const std::shared_ptr<const MotionTable> table = corpus.table();
  const auto& motions = table->motions();
  const auto found = std::lower_bound(motions.begin(), motions.end(), id,
                                      [](const MotionSummary& m, std::int64_t wanted) { return m.id < wanted; });
  if (found == motions.end() || found->id != id)
    throw std::invalid_argument("the corpus " + corpus.path().string() + " has no motion " + std::to_string(id));
  std::vector<double> times(frames);
  for (std::size_t i = 0; i < frames; ++i) times[i] = static_cast<double>(i) / static_cast<double>(frames - 1);
  std::vector<Posture> postures(frames);
  const std::optional<Replay> replay = Replay::of(*found);
  if (!replay || !replay->perform(*corpus.code(id), PathForm::deviation, times, postures)) {
    throw std::invalid_argument("motion " + std::to_string(id) + " cannot be held by a body of published proportions " +
                                "that is " + std::to_string(found->subject.stature_m) + " m tall");
  }
  return postures;
}

py::array_t<double> replay(const Corpus& corpus, std::int64_t id, std::size_t frames) {
  const std::vector<Posture> postures = [&] {
    const py::gil_scoped_release release;
    return replayed(corpus, id, frames);
  }();
  py::array_t<double> out(
      {static_cast<py::ssize_t>(postures.size()), static_cast<py::ssize_t>(kJointCount), static_cast<py::ssize_t>(3)});
  double* value = out.mutable_data();
  for (const Posture& posture : postures) {
    for (const Vec3& point : posture) {
      for (int k = 0; k < 3; ++k) *value++ = point[k];
    }
  }
  return out;
}

}  // namespace

void bind_replay(py::module_& m) {
  m.def("replay", &replay, "corpus"_a, "id"_a, "frames"_a = static_cast<std::size_t>(kReplayTimes),
        "Postures of one stored motion on a body of its subject's stature, between its own home and target: (frames, "
        "27, 3), evenly spaced in time, metres, body frame. ValueError for an unknown id and where that body cannot.");
}
