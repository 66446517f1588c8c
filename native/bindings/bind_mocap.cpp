// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "clip_conversions.hpp"
#include "module.hpp"
#include "reachcast/mocap/gaps.hpp"
#include "reachcast/mocap/joint_map.hpp"
#include "reachcast/mocap/motion_file.hpp"
#include "reachcast/mocap/tracking.hpp"

namespace py = pybind11;
using namespace py::literals;

namespace {

using reachcast::Clip;
using reachcast::Guess;
using reachcast::JointMap;
using reachcast::MotionFile;
using reachcast::MotionFileOptions;
using reachcast::bindings::clip_array;
using reachcast::bindings::clip_channels;
using reachcast::bindings::clip_filled;
using reachcast::bindings::clip_names;
using reachcast::bindings::joint_map;
using reachcast::bindings::make_clip;
using reachcast::bindings::text;

MotionFile read_motion(const std::string& path, std::optional<double> metres_per_unit,
                       const std::optional<std::string>& up, std::optional<double> rate, std::optional<long> interval,
                       const std::optional<std::string>& facing, const std::optional<std::string>& skeleton) {
  const MotionFileOptions options{metres_per_unit, up, rate, interval, facing, skeleton};
  const py::gil_scoped_release release;
  return reachcast::read_motion(path, options);
}

Clip canonical(const Clip& clip, const py::object& map) {
  return map.is_none() ? reachcast::to_canonical(clip) : reachcast::to_canonical(clip, joint_map(map));
}

void bind_guess(py::module_& m) {
  const auto from = [](reachcast::From Guess::*field) {
    return [field](const Guess& guess) { return std::string(reachcast::name_of(guess.*field)); };
  };
  py::class_<Guess>(
      m, "Guess",
      "How a file was understood. Each *_from is 'argument', 'file', 'data' (seen in the points), 'usual'\n"
      "(for the format) or 'unknown'. str() gives it all in one line.")
      .def_readonly("metres_per_unit", &Guess::metres_per_unit)
      .def_readonly("unit", &Guess::unit, "In words: 'millimetres'.")
      .def_property_readonly("unit_from", from(&Guess::unit_from))
      .def_readonly("up", &Guess::up, "The file's axis that points up: 'y', '-z', ...")
      .def_property_readonly("up_from", from(&Guess::up_from))
      .def_readonly("facing", &Guess::facing, "The file's axis nearest to where the person faces at first; '' unknown.")
      .def_property_readonly("facing_from", from(&Guess::facing_from))
      .def_readonly("rate", &Guess::rate_hz, "Frames per second.")
      .def_property_readonly("rate_from", from(&Guess::rate_from))
      .def_readonly("stature", &Guess::stature_m, "Metres, from the lengths of legs and trunk; NaN when not known.")
      .def("__str__", &Guess::summary)
      .def("__repr__", [](const Guess& guess) { return "<Guess: " + guess.summary() + ">"; });
}

void bind_clip(py::module_& m) {
  py::class_<Clip>(m, "Clip", "Named points over time: metres, z up, the world of the recording; NaN is missing.")
      .def(py::init(&make_clip), "names"_a, "positions"_a, "rate"_a, "source"_a = "", "positions: (frames, joints, 3).")
      .def_property_readonly("names", &clip_names)
      .def_property_readonly(
          "positions", [](const Clip& clip) { return clip_array(clip.positions.data(), clip.frames(), clip.joints()); },
          "A new array (frames, joints, 3).")
      .def_readonly("rate", &Clip::rate_hz, "Frames per second.")
      .def_property_readonly("filled", &clip_filled,
                             "A new array of bool (frames, joints): true where a gap was filled (see fill_gaps).")
      .def_readonly("derived", &Clip::derived, "One flag per joint: computed from others, not recorded.")
      .def_property_readonly("channels", &clip_channels, "Other numeric columns: name to a new array (frames,).")
      .def_readonly("source", &Clip::source)
      .def("__len__", &Clip::frames)
      .def("__repr__", [](const Clip& clip) {
        return "<Clip " + clip.source + ": " + std::to_string(clip.frames()) + " frames, " +
               std::to_string(clip.joints()) + " joints, " + py::str(py::float_(clip.rate_hz)).cast<std::string>() +
               " Hz>";
      });
  py::class_<MotionFile, Clip>(m, "MotionFile", "A Clip together with how its file was understood.")
      .def_readonly("guess", &MotionFile::guess)
      .def_property_readonly("metres_per_unit", [](const MotionFile& file) { return file.guess.metres_per_unit; })
      .def_property_readonly("up", [](const MotionFile& file) { return file.guess.up; })
      .def_property_readonly(
          "note", [](const MotionFile& file) { return text(file.note); },
          "What was guessed or noticed, in sentences; empty when nothing was.");
}

MotionFile fill_gaps_of_file(const MotionFile& file, double limit_s) {
  MotionFile result = file;
  static_cast<Clip&>(result) = reachcast::fill_gaps(file, limit_s);
  return result;
}

void bind_repair(py::module_& m) {
  constexpr const char* help =
      "The clip with gaps of at most limit_s seconds filled by cubics and marked in .filled; longer ones, and those "
      "at\n"
      "an end of the recording, stay NaN.";
  m.def("fill_gaps", &fill_gaps_of_file, "clip"_a, "limit_s"_a = 0.2, help);
  m.def("fill_gaps", &reachcast::fill_gaps, "clip"_a, "limit_s"_a = 0.2, help);
  const reachcast::TrackingLimits usual;
  m.def(
      "check_tracking",
      [](const Clip& clip, double acceleration, double jump, double frozen, double stretch) {
        py::list faults;
        for (const auto& fault : reachcast::check_tracking(clip, {acceleration, jump, frozen, stretch})) {
          faults.append(py::make_tuple(text(fault.joint), fault.first, fault.last, text(fault.reason)));
        }
        return faults;
      },
      "clip"_a, py::kw_only(), "acceleration"_a = usual.acceleration, "jump"_a = usual.jump_m,
      "frozen"_a = usual.frozen_s, "stretch"_a = usual.stretch,
      "What no body does, as a list of (joint, first frame, last frame, reason): points that jump (more than\n"
      "acceleration m/s^2 and jump m off), stand exactly still for frozen s while others move, or change places with\n"
      "the other side; in canonical clips also limbs off their median length by more than the part stretch.");
}

}  // namespace

void bind_mocap(py::module_& m) {
  bind_guess(m);
  bind_clip(m);
  m.def(
      "read_motion", &read_motion, "path"_a, py::kw_only(), "metres_per_unit"_a = py::none(), "up"_a = py::none(),
      "rate"_a = py::none(), "interval"_a = py::none(), "facing"_a = py::none(), "skeleton"_a = py::none(),
      "Reads a .bvh, .csv, .c3d, .trc or .amc file as a MotionFile (a Clip) in metres, z up. What is not given is\n"
      "taken from the file or guessed from the data: .guess says what and from where, .note in sentences.\n"
      "up: the file's axis that points up, 'x', 'y', 'z', '-x', '-y' or '-z'; rate: frames per second (an .amc needs\n"
      "it); interval: a group of rows of an interval_label table; facing: the file's horizontal axis that becomes +y\n"
      "(None: nothing is turned); skeleton: the .asf of an .amc (None: looked for beside it).");
  m.def(
      "canonical", &canonical, "clip"_a, "map"_a = py::none(),
      "The clip in the 27 canonical joints, missing ones derived. map: the name of a preset, the path of a .json file, "
      "or\n"
      "a dict or pairs of a canonical joint and where it comes from; None detects the preset. A joint comes from a\n"
      "recorded name, several (their mean), or a dict {'points': 'A+B', 'offset': [right, forward, up], 'across': "
      "'L>R',\n"
      "'ahead': 'BACK>FRONT' or 'along': 'BELOW>ABOVE', 'scale': 'A>B'}: the mean moved by an offset in metres, or in\n"
      "the median distance of 'scale', in axes that lead from points to points (without ahead and along, up is\n"
      "vertical). A list of dicts gives alternatives: the first whose points are all recorded is taken.");
  m.def(
      "joint_map_names",
      [] {
        std::vector<std::string> names;
        for (const JointMap& preset : reachcast::joint_map_presets()) names.push_back(preset.name);
        return names;
      },
      "Names of the joint maps built in.");
  bind_repair(m);
}
