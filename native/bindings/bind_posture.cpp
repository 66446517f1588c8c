// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <sstream>

#include "array_checks.hpp"
#include "module.hpp"
#include "reachcast/posture/chain.hpp"

namespace py = pybind11;
using namespace reachcast;
using namespace reachcast::bindings;

namespace {

constexpr double kLengthTolerance = 1e-6;  // of the link's length: a recording's own lengths belong in its own Chain

Chain make_chain(const DoubleArray& lengths, std::vector<std::size_t> pivots,
                 const std::optional<std::map<std::size_t, std::pair<double, double>>>& limits) {
  std::map<std::size_t, FlexionLimit> flexion;
  if (limits) {
    for (const auto& [joint, range] : *limits) flexion[joint] = {range.first, range.second};
  }
  return {to_numbers(lengths, "lengths"), std::move(pivots), std::move(flexion)};
}

py::array_t<double> encode(const Chain& chain, const DoubleArray& points) {
  const auto joints = static_cast<py::ssize_t>(chain.links() + 1);
  require_shape(points, "points", {kAnySize, joints, 3});
  require_finite(points, "points");
  const py::ssize_t frames = points.shape(0);
  py::array_t<double> out({frames, static_cast<py::ssize_t>(chain.coordinate_count())});
  Points one(chain.links() + 1);
  for (py::ssize_t f = 0; f < frames; ++f) {
    for (py::ssize_t j = 0; j < joints; ++j)
      one[static_cast<std::size_t>(j)] = {points.at(f, j, 0), points.at(f, j, 1), points.at(f, j, 2)};
    for (std::size_t i = 0; i < chain.links(); ++i) {
      const double length = glm::distance(one[i], one[i + 1]);
      if (std::abs(length - chain.lengths()[i]) > kLengthTolerance * chain.lengths()[i]) {
        std::ostringstream text;
        text << "points: link " << i << " of frame " << f << " is " << length << " m; the chain's is "
             << chain.lengths()[i];
        throw std::invalid_argument(text.str());
      }
    }
    chain.encode(
        one, {out.mutable_data() + f * static_cast<py::ssize_t>(chain.coordinate_count()), chain.coordinate_count()});
  }
  return out;
}

py::array_t<double> decode(const Chain& chain, const DoubleArray& start, const DoubleArray& end,
                           const DoubleArray& coordinates) {
  require_shape(coordinates, "coordinates", {kAnySize, static_cast<py::ssize_t>(chain.coordinate_count())});
  require_finite(coordinates, "coordinates");
  const Points from = to_points(start, "start"), to = to_points(end, "end");
  const py::ssize_t frames = coordinates.shape(0);
  for (const auto& [name, given] : {std::pair<const char*, std::size_t>{"start", from.size()}, {"end", to.size()}}) {
    if (given != static_cast<std::size_t>(frames)) {
      throw std::invalid_argument(std::string(name) + " has " + std::to_string(given) + " frames, coordinates has " +
                                  std::to_string(frames));
    }
  }
  py::array_t<double> out({frames, static_cast<py::ssize_t>(chain.links() + 1), py::ssize_t{3}});
  Points one(chain.links() + 1);
  for (py::ssize_t f = 0; f < frames; ++f) {
    const auto frame = static_cast<std::size_t>(f);
    chain.decode(
        from[frame], to[frame],
        {coordinates.data() + f * static_cast<py::ssize_t>(chain.coordinate_count()), chain.coordinate_count()}, one);
    for (std::size_t j = 0; j < one.size(); ++j) {
      for (int axis = 0; axis < 3; ++axis) out.mutable_at(f, static_cast<py::ssize_t>(j), axis) = one[j][axis];
    }
  }
  return out;
}

}  // namespace

void bind_posture(py::module_& m) {
  py::class_<Chain>(
      m, "Chain",
      "Stretch-pivot coordinates of a chain of links whose ends are given (Faraway 2004, section 2): any weighted "
      "mean of coordinates decodes to a valid chain.")
      .def(py::init(&make_chain), py::arg("lengths"), py::arg("pivots"), py::arg("limits") = py::none(),
           "lengths: n link lengths, metres. pivots: interior joints 1 to n-1 in order of precedence. limits: {joint: "
           "(least, "
           "most flexion in radians)} for joints that pivot between two single links.")
      .def_property_readonly("lengths", [](const Chain& c) { return numbers_array(c.lengths()); })
      .def_property_readonly("coordinate_count", [](const Chain& c) { return c.coordinate_count(); })
      .def_property_readonly(
          "reach", [](const Chain& c) { return std::pair(c.reach().lo, c.reach().hi); },
          "(lo, hi): the distances that the two ends can have, metres")
      .def("encode", &encode, py::arg("points"), "points (F, n+1, 3) -> coordinates (F, p)")
      .def("decode", &decode, py::arg("start"), py::arg("end"), py::arg("coordinates"),
           "start (F, 3), end (F, 3), coordinates (F, p) -> points (F, n+1, 3)")
      .def("__repr__", [](const Chain& c) {
        std::ostringstream out;
        out << "Chain(" << c.links() << " links, reach " << c.reach().lo << " to " << c.reach().hi << " m)";
        return out.str();
      });
}
