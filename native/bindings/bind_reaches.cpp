// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "clip_conversions.hpp"
#include "module.hpp"
#include "reachcast/motion/cut_reach.hpp"
#include "reachcast/motion/find_reaches.hpp"
#include "reachcast/motion/labels.hpp"

namespace py = pybind11;
using namespace py::literals;

namespace {

using reachcast::Clip;
using reachcast::CutOptions;
using reachcast::Evidence;
using reachcast::FindOptions;
using reachcast::FoundReaches;
using reachcast::kJointCount;
using reachcast::ObjectEvent;
using reachcast::PhaseLabel;
using reachcast::Reach;
using reachcast::Rejection;
using reachcast::Subject;
using reachcast::Vec3;
using reachcast::bindings::text;

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

void bind_reach(py::module_& m) {
  py::class_<Reach>(m, "Reach", "One labelled phase in the body frame, in the canonical joints.")
      .def_property_readonly("positions", &reach_positions, "A new array (frames, 27, 3), joints as in joint_names.")
      .def_property_readonly("hold_points", &hold_points, "A new array (frames, 3): midpoints of the two grips.")
      .def_readonly("subject", &Reach::subject)
      .def_property_readonly("phase",
                             [](const Reach& reach) { return std::string(reachcast::phase_name(reach.phase)); })
      .def_property_readonly("hands",
                             [](const Reach& reach) { return std::string(reachcast::hands_name(reach.hands)); })
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

/// Keywords beyond those named in the signature, each a field of FindOptions.
FindOptions find_options(const py::kwargs& given) {
  FindOptions options;
  const std::array<std::pair<const char*, double*>, 13> fields{{{"still_part", &options.still_part},
                                                                {"still_speed", &options.still_speed},
                                                                {"pause_s", &options.pause_s},
                                                                {"least_s", &options.least_s},
                                                                {"least_travel_m", &options.least_travel_m},
                                                                {"fastest_end", &options.fastest_end},
                                                                {"step_m", &options.step_m},
                                                                {"ankle_step_m", &options.ankle_step_m},
                                                                {"slip_m", &options.slip_m},
                                                                {"parted_m", &options.parted_m},
                                                                {"uneven_m", &options.uneven_m},
                                                                {"longest_filled_s", &options.longest_filled_s},
                                                                {"longest_gap_s", &options.cut.longest_gap_s}}};
  for (const auto& [key, value] : given) {
    const auto name = key.cast<std::string>();
    if (name == "floor_z") {
      options.cut.floor_z = value.cast<std::optional<double>>();
      continue;
    }
    const auto found =
        std::find_if(fields.begin(), fields.end(), [&](const auto& field) { return field.first == name; });
    if (found == fields.end()) {
      std::string known = "floor_z";
      for (const auto& field : fields) known += std::string(", ") + field.first;
      throw std::invalid_argument("option '" + name + "' is not known; the options are " + known);
    }
    *found->second = value.cast<double>();
  }
  return options;
}

Evidence evidence_of(const Clip& body, const Clip* recorded, const std::optional<std::string>& object,
                     const std::string& origin, bool check) {
  if (object && !recorded) throw std::invalid_argument("object '" + *object + "' was given without recorded");
  if (recorded && recorded->frames() != body.frames()) {
    throw std::invalid_argument("recorded has " + std::to_string(recorded->frames()) + " frames, body " +
                                std::to_string(body.frames()));
  }
  Evidence evidence;
  evidence.origin = origin;
  if (recorded) evidence.object = reachcast::object_track(*recorded, object);
  if (check) evidence.faults = reachcast::check_tracking(body);
  return evidence;
}

FoundReaches find_reaches(const Clip& body, const Subject& subject, const Clip* recorded,
                          const std::optional<std::string>& object, const std::string& origin, bool check,
                          const py::kwargs& keywords) {
  const FindOptions options = find_options(keywords);
  const py::gil_scoped_release release;
  return reachcast::find_reaches(body, subject, options, evidence_of(body, recorded, object, origin, check));
}

FoundReaches cut_labelled(const Clip& body, const std::vector<PhaseLabel>& labels,
                          const std::optional<Subject>& subject, const Clip* recorded,
                          const std::optional<std::string>& object, const std::string& origin, bool check,
                          const py::kwargs& keywords) {
  const FindOptions options = find_options(keywords);
  const py::gil_scoped_release release;
  return reachcast::cut_labelled(body, labels, subject, recorded, options,
                                 evidence_of(body, recorded, object, origin, check));
}

void bind_found(py::module_& m) {
  py::class_<ObjectEvent>(m, "ObjectEvent",
                          "What happens to the object at a frame: grasp, lift-off, placed or release.")
      .def_readonly("name", &ObjectEvent::name)
      .def_readonly("frame", &ObjectEvent::frame)
      .def("__repr__",
           [](const ObjectEvent& e) { return "<ObjectEvent " + e.name + " at " + std::to_string(e.frame) + ">"; });
  py::class_<Rejection>(m, "Rejection", "A part of a recording that is no reach, and why.")
      .def_property_readonly(
          "what", [](const Rejection& r) { return text(r.what); },
          "The phase that it would have been, else 'movement' or 'recording'.")
      .def_property_readonly("reason", [](const Rejection& r) { return text(r.reason); })
      .def_readonly("first", &Rejection::first, "Frame, from 0.")
      .def_readonly("last", &Rejection::last, "Frame, included.")
      .def("__repr__", [](const Rejection& r) {
        return text("<Rejection " + r.what + " " + std::to_string(r.first) + "-" + std::to_string(r.last) + ": " +
                    r.reason + ">");
      });
  py::class_<FoundReaches>(m, "FoundReaches", "The phases of one recording, and all that is none with its reason.")
      .def_readonly("reaches", &FoundReaches::reaches, "A list of Reach, in order of time.")
      .def_property_readonly(
          "spans",
          [](const FoundReaches& found) {
            std::vector<std::pair<std::size_t, std::size_t>> spans;
            for (const auto& range : found.frames) spans.emplace_back(range.first, range.last);
            return spans;
          },
          "(first, last) frame of each reach, in the same order.")
      .def_readonly("rejections", &FoundReaches::rejections, "A list of Rejection.")
      .def_readonly("events", &FoundReaches::events, "A list of ObjectEvent, in order of time.")
      .def("__repr__", [](const FoundReaches& found) {
        return "<FoundReaches: " + std::to_string(found.reaches.size()) + " reaches, " +
               std::to_string(found.rejections.size()) + " rejections>";
      });
}

std::optional<std::string> sex_text(const PhaseLabel& label) {
  if (!label.sex) return std::nullopt;
  return *label.sex == reachcast::Sex::female ? "female" : "male";
}

void bind_labels(py::module_& m) {
  py::class_<PhaseLabel>(m, "PhaseLabel", "One row of a table of labels; what its cells left empty is None.")
      .def_property_readonly("file", [](const PhaseLabel& label) { return text(label.file); })
      .def_readonly("row", &PhaseLabel::line, "Line of the table, from 1.")
      .def_property_readonly(
          "subject",
          [](const PhaseLabel& label) { return label.subject ? py::object(text(*label.subject)) : py::none(); })
      .def_readonly("stature", &PhaseLabel::stature_m, "Metres.")
      .def_property_readonly("sex", &sex_text, "'female' or 'male'.")
      .def_readonly("age", &PhaseLabel::age_years)
      .def_readonly("mass", &PhaseLabel::mass_kg, "Kilograms.")
      .def_property_readonly("phase",
                             [](const PhaseLabel& label) { return std::string(reachcast::phase_name(label.phase)); })
      .def_readonly("first", &PhaseLabel::first, "Frame, from 0.")
      .def_readonly("last", &PhaseLabel::last, "Frame, included.")
      .def_readonly("start_s", &PhaseLabel::start_s)
      .def_readonly("end_s", &PhaseLabel::end_s)
      .def_property_readonly(
          "object", [](const PhaseLabel& label) { return label.object ? py::object(text(*label.object)) : py::none(); })
      .def_property_readonly("events",
                             [](const PhaseLabel& label) {
                               py::dict events;
                               for (const ObjectEvent& event : label.events) events[py::str(event.name)] = event.frame;
                               return events;
                             })
      .def(
          "frames",
          [](const PhaseLabel& label, const Clip& clip) {
            const reachcast::FrameRange range = label.frames(clip);
            return std::make_pair(range.first, range.last);
          },
          "clip"_a, "(first, last): seconds are rounded to the nearest frame of the clip.")
      .def("__repr__", [](const PhaseLabel& label) { return text("<PhaseLabel " + label.text() + ">"); });
  m.def(
      "read_labels", &reachcast::read_labels, "path"_a,
      "A list of PhaseLabel, one per row of a table with the columns file, phase, and first and last (frames from 0)\n"
      "or start_s and end_s; and, where known, subject, stature_m, sex, age, mass_kg, object, grasp_frame,\n"
      "lift_off_frame, placed_frame and release_frame. Comma, semicolon or tab between cells, which may be quoted.");
}

}  // namespace

void bind_reaches(py::module_& m) {
  bind_reach(m);
  bind_found(m);
  bind_labels(m);
  m.def("cut_reach", &cut_reach, "clip"_a, "first"_a, "last"_a, "subject"_a, "phase"_a, "origin"_a = "", py::kw_only(),
        "floor_z"_a = py::none(), "longest_gap_s"_a = CutOptions{}.longest_gap_s,
        "Frames first to last of a canonical clip as a Reach in the body frame of frame first.");
  m.def("trim_by_hand_speed", &trim, "clip"_a, "first"_a, "last"_a, "fraction"_a = 0.1,
        "(first, last) of the part in which the hold point moves at least at a fraction of its peak speed.");
  m.def(
      "find_reaches", &find_reaches, "body"_a, "subject"_a, py::kw_only(), "recorded"_a = py::none(),
      "object"_a = py::none(), "origin"_a = "", "check"_a = true,
      "Cuts the phases out of a recording and names them, as FoundReaches. body: a Clip in the 27 canonical joints, F\n"
      "frames; recorded: the clip as read, F frames, in which the object is the point named by object (None: obj,\n"
      "object or box if it has one, else the hands tell what they hold); origin: goes before ':first-last' in each\n"
      "reach's origin ('': the clip's source); check: what check_tracking finds in body rejects the phases it is in.\n"
      "Options: still_part (0.1 of the peak speed), still_speed (0.05 m/s), pause_s (0.3), least_s (0.4),\n"
      "least_travel_m (0.15), fastest_end (0.75 of the peak speed, where a step cuts off), step_m (0.08),\n"
      "ankle_step_m (0.15, where no balls were recorded), slip_m (0.08), parted_m (0.16), uneven_m (0.15),\n"
      "longest_filled_s (0.2), longest_gap_s (0.1), floor_z (m; None: seen in the data).");
  m.def("cut_labelled", &cut_labelled, "body"_a, "labels"_a, "subject"_a = py::none(), py::kw_only(),
        "recorded"_a = py::none(), "object"_a = py::none(), "origin"_a = "", "check"_a = true,
        "The phases that labels of this recording name, as FoundReaches, held to the rules and with the keywords of\n"
        "find_reaches. What a label says of the person goes before subject.");
}
