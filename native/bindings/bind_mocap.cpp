// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <stdexcept>

#include "module.hpp"
#include "reachcast/mocap/gaps.hpp"
#include "reachcast/mocap/joint_map.hpp"
#include "reachcast/mocap/motion_file.hpp"
#include "reachcast/mocap/tracking.hpp"
#include "reachcast/motion/cut_reach.hpp"

namespace py = pybind11;
using namespace py::literals;

namespace {

using reachcast::Clip;
using reachcast::CutOptions;
using reachcast::Guess;
using reachcast::Joint;
using reachcast::JointMap;
using reachcast::JointSource;
using reachcast::kJointCount;
using reachcast::MotionFile;
using reachcast::MotionFileOptions;
using reachcast::Reach;
using reachcast::Subject;
using reachcast::Vec3;

static_assert(sizeof(Vec3) == 3 * sizeof(double), "points are copied to arrays as they lie in memory");

/// Names come from files and may hold any bytes.
py::str text(const std::string& bytes) {
  PyObject* decoded = PyUnicode_DecodeUTF8(bytes.data(), static_cast<py::ssize_t>(bytes.size()), "replace");
  if (!decoded) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

py::array_t<double> points_array(const Vec3* points, std::size_t frames, std::size_t joints) {
  py::array_t<double> array({frames, joints, std::size_t{3}});
  if (frames * joints > 0) std::copy_n(&points[0].x, frames * joints * 3, array.mutable_data());
  return array;
}

py::list clip_names(const Clip& clip) {
  py::list names;
  for (const std::string& name : clip.names) names.append(text(name));
  return names;
}

py::dict clip_channels(const Clip& clip) {
  py::dict channels;
  for (const auto& [name, values] : clip.channels) {
    channels[text(name)] = py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
  }
  return channels;
}

py::array_t<bool> clip_filled(const Clip& clip) {
  py::array_t<bool> array({clip.frames(), clip.joints()});
  bool* const to = array.mutable_data();
  for (std::size_t i = 0; i < clip.positions.size(); ++i) to[i] = !clip.filled.empty() && clip.filled[i] != 0;
  return array;
}

Clip make_clip(const std::vector<std::string>& names,
               const py::array_t<double, py::array::c_style | py::array::forcecast>& positions, double rate_hz,
               const std::string& source) {
  if (positions.ndim() != 3 || positions.shape(2) != 3 ||
      positions.shape(1) != static_cast<py::ssize_t>(names.size())) {
    throw std::invalid_argument("positions must have the shape (frames, " + std::to_string(names.size()) +
                                ", 3), one joint per name");
  }
  if (!(rate_hz > 0.0 && rate_hz <= 1e5))
    throw std::invalid_argument("rate must be over 0 and at most 100000 Hz, not " + std::to_string(rate_hz));
  Clip clip{source, rate_hz, names, std::vector<bool>(names.size(), false), {}, {}};
  const double* value = positions.data();
  for (py::ssize_t i = 0; i < positions.shape(0) * positions.shape(1); ++i, value += 3) {
    clip.positions.emplace_back(value[0], value[1], value[2]);
  }
  return clip;
}

MotionFile read_motion(const std::string& path, std::optional<double> metres_per_unit,
                       const std::optional<std::string>& up, std::optional<double> rate, std::optional<long> interval,
                       const std::optional<std::string>& facing, const std::optional<std::string>& skeleton) {
  const MotionFileOptions options{metres_per_unit, up, rate, interval, facing, skeleton};
  const py::gil_scoped_release release;
  return reachcast::read_motion(path, options);
}

using Names = std::vector<std::string>;

/// A dict with "points" and, where they are not the joint itself, "offset" and its axes.
JointSource joint_source(const py::dict& given) {
  JointSource source;
  for (const auto& [key_object, value] : given) {
    const auto key = key_object.cast<std::string>();
    if (key == "points") {
      const bool is_text = py::isinstance<py::str>(value);
      source.points = is_text ? reachcast::parse_mean(value.cast<std::string>()) : value.cast<Names>();
    } else if (key == "offset") {
      const auto offset = value.cast<std::array<double, 3>>();
      source.offset = {offset[0], offset[1], offset[2]};
    } else if (key == "scale" || key == "across" || key == "ahead" || key == "along") {
      reachcast::PointSpan& span = key == "scale"    ? source.scale
                                   : key == "across" ? source.across
                                   : key == "ahead"  ? source.ahead
                                                     : source.along;
      span = reachcast::parse_span(value.cast<std::string>());
    } else {
      throw std::invalid_argument("map: a source has points, offset, scale, across, ahead and along, not '" + key +
                                  "'");
    }
  }
  return source;
}

/// A name, names to be averaged, a dict, or dicts of which the first that is recorded is taken.
std::vector<JointSource> joint_sources(const py::object& given) {
  if (py::isinstance<py::str>(given)) return {JointSource(Names{given.cast<std::string>()})};
  if (py::isinstance<py::dict>(given)) return {joint_source(given)};
  const auto list = given.cast<std::vector<py::object>>();
  const auto is_dict = [](const py::object& item) { return py::isinstance<py::dict>(item); };
  if (list.empty() || !std::all_of(list.begin(), list.end(), is_dict)) return {JointSource(given.cast<Names>())};
  std::vector<JointSource> alternatives;
  for (const py::object& item : list) alternatives.push_back(joint_source(item));
  return alternatives;
}

/// A preset's name, the path of a JSON file, or a dict or pairs of a canonical joint and its sources.
JointMap joint_map(const py::object& map) {
  if (py::isinstance<py::str>(map)) {
    const auto name = map.cast<std::string>();
    std::string known;
    if (name.ends_with(".json")) {
      const py::object file = py::module_::import("pathlib").attr("Path")(name);
      return joint_map(py::module_::import("json").attr("loads")(file.attr("read_text")("encoding"_a = "utf-8")));
    }
    for (const JointMap& preset : reachcast::joint_map_presets()) {
      if (preset.name == name) return preset;
      known += (known.empty() ? "" : ", ") + preset.name;
    }
    throw std::invalid_argument("map must be one of " + known + ", a .json file, or pairs, not '" + name + "'");
  }
  if (py::isinstance<py::dict>(map)) return joint_map(map.attr("items")());
  JointMap result{"given", {}};
  for (const py::handle pair : map) try {
      const auto [joint_name, sources] = pair.cast<std::pair<std::string, py::object>>();
      const std::optional<Joint> joint = reachcast::find_joint(joint_name);
      if (!joint) throw std::invalid_argument("map: '" + joint_name + "' is not a canonical joint");
      for (JointSource& source : joint_sources(sources)) result.sources.emplace_back(*joint, std::move(source));
    } catch (const py::cast_error&) {
      throw std::invalid_argument("map: each entry is a canonical joint and the name or names of its points; found " +
                                  py::repr(pair).cast<std::string>());
    }
  return result;
}

Clip canonical(const Clip& clip, const py::object& map) {
  return map.is_none() ? reachcast::to_canonical(clip) : reachcast::to_canonical(clip, joint_map(map));
}

Reach cut_reach(const Clip& clip, std::size_t first, std::size_t last, const Subject& subject, const std::string& phase,
                const std::string& origin, std::optional<double> floor_z, double longest_gap_s) {
  const std::optional<reachcast::Phase> known = reachcast::find_phase(phase);
  if (!known) throw std::invalid_argument("phase must be transfer, return, reach or retrieve, not '" + phase + "'");
  return reachcast::cut_reach(clip, first, last, subject, *known, origin, CutOptions{floor_z, longest_gap_s});
}

std::pair<std::size_t, std::size_t> trim(const Clip& clip, std::size_t first, std::size_t last, double fraction) {
  const reachcast::FrameRange range = reachcast::trim_by_hand_speed(clip, first, last, fraction);
  return {range.first, range.last};
}

py::array_t<double> reach_positions(const Reach& reach) {
  py::array_t<double> array({reach.frames(), kJointCount, std::size_t{3}});
  double* to = array.mutable_data();
  for (const reachcast::Posture& posture : reach.postures) to = std::copy_n(&posture[0].x, kJointCount * 3, to);
  return array;
}

py::array_t<double> hold_points(const Reach& reach) {
  py::array_t<double> array({reach.frames(), std::size_t{3}});
  double* to = array.mutable_data();
  for (std::size_t frame = 0; frame < reach.frames(); ++frame) {
    const Vec3 point = reach.hold_point(frame);
    to = std::copy_n(&point.x, 3, to);
  }
  return array;
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
          "positions",
          [](const Clip& clip) { return points_array(clip.positions.data(), clip.frames(), clip.joints()); },
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

void bind_reach(py::module_& m) {
  py::class_<Reach>(m, "Reach", "One labelled phase in the body frame, in the canonical joints.")
      .def_property_readonly("positions", &reach_positions, "A new array (frames, 27, 3), joints as in joint_names.")
      .def_property_readonly("hold_points", &hold_points, "A new array (frames, 3): midpoints of the two grips.")
      .def_readonly("subject", &Reach::subject)
      .def_property_readonly("phase",
                             [](const Reach& reach) { return std::string(reachcast::phase_name(reach.phase)); })
      .def_readonly("origin", &Reach::origin)
      .def_readonly("duration", &Reach::duration_s, "Seconds from the first to the last frame.")
      .def_readonly("derived", &Reach::derived, "27 flags: joints that the recording lacked.")
      .def(
          "mirrored", [](const Reach& reach) { return reachcast::mirrored(reach); },
          "The same motion by the mirror image of the person.")
      .def(
          "reversed", [](const Reach& reach) { return reachcast::reversed(reach); },
          "The same motion played backwards: a transfer becomes a retrieve, a reach a return, and the other way round.")
      .def("__len__", &Reach::frames)
      .def("__repr__", [](const Reach& reach) {
        return "<Reach " + std::string(reachcast::phase_name(reach.phase)) + " of " + reach.origin + ": " +
               std::to_string(reach.frames()) + " frames>";
      });
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
  bind_reach(m);
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
  m.def("cut_reach", &cut_reach, "clip"_a, "first"_a, "last"_a, "subject"_a, "phase"_a, "origin"_a = "", py::kw_only(),
        "floor_z"_a = py::none(), "longest_gap_s"_a = CutOptions{}.longest_gap_s,
        "Frames first to last of a canonical clip as a Reach in the body frame of frame first.");
  m.def("trim_by_hand_speed", &trim, "clip"_a, "first"_a, "last"_a, "fraction"_a = 0.1,
        "(first, last) of the part in which the hold point moves at least at a fraction of its peak speed.");
}
