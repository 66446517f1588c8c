// SPDX-License-Identifier: GPL-3.0-or-later
#include "clip_conversions.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace py = pybind11;
using namespace py::literals;

namespace reachcast::bindings {
namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double), "points are copied to arrays as they lie in memory");

using Names = std::vector<std::string>;

/// A dict with "points" and, where they are not the joint itself, "offset" and its axes.
JointSource joint_source(const py::dict& given) {
  JointSource source;
  for (const auto& [key_object, value] : given) {
    const auto key = key_object.cast<std::string>();
    if (key == "points") {
      const bool is_text = py::isinstance<py::str>(value);
      source.points = is_text ? parse_mean(value.cast<std::string>()) : value.cast<Names>();
    } else if (key == "offset") {
      const auto offset = value.cast<std::array<double, 3>>();
      source.offset = {offset[0], offset[1], offset[2]};
    } else if (key == "scale" || key == "across" || key == "ahead" || key == "along") {
      PointSpan& span = key == "scale"    ? source.scale
                        : key == "across" ? source.across
                        : key == "ahead"  ? source.ahead
                                          : source.along;
      span = parse_span(value.cast<std::string>());
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

}  // namespace

/// Names come from files and may hold any bytes.
py::str text(const std::string& bytes) {
  PyObject* decoded = PyUnicode_DecodeUTF8(bytes.data(), static_cast<py::ssize_t>(bytes.size()), "replace");
  if (!decoded) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

py::array_t<double> clip_array(const Vec3* points, std::size_t frames, std::size_t joints) {
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

/// A preset's name, the path of a JSON file, or a dict or pairs of a canonical joint and its sources.
JointMap joint_map(const py::object& map) {
  if (py::isinstance<py::str>(map)) {
    const auto name = map.cast<std::string>();
    std::string known;
    if (name.ends_with(".json")) {
      const py::object file = py::module_::import("pathlib").attr("Path")(name);
      return joint_map(py::module_::import("json").attr("loads")(file.attr("read_text")("encoding"_a = "utf-8")));
    }
    for (const JointMap& preset : joint_map_presets()) {
      if (preset.name == name) return preset;
      known += (known.empty() ? "" : ", ") + preset.name;
    }
    throw std::invalid_argument("map must be one of " + known + ", a .json file, or pairs, not '" + name + "'");
  }
  if (py::isinstance<py::dict>(map)) return joint_map(map.attr("items")());
  JointMap result{"given", {}};
  for (const py::handle pair : map) try {
      const auto [joint_name, sources] = pair.cast<std::pair<std::string, py::object>>();
      const std::optional<Joint> joint = find_joint(joint_name);
      if (!joint) throw std::invalid_argument("map: '" + joint_name + "' is not a canonical joint");
      for (JointSource& source : joint_sources(sources)) result.sources.emplace_back(*joint, std::move(source));
    } catch (const py::cast_error&) {
      throw std::invalid_argument("map: each entry is a canonical joint and the name or names of its points; found " +
                                  py::repr(pair).cast<std::string>());
    }
  return result;
}

}  // namespace reachcast::bindings
