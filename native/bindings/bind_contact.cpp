// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/pybind11.h>

#include "array_checks.hpp"
#include "module.hpp"
#include "reachcast/posture/contact.hpp"
#include "reachcast/predict/task.hpp"

namespace py = pybind11;
using namespace reachcast;
using namespace reachcast::bindings;

namespace {

std::vector<Posture> to_postures(const DoubleArray& joints) {
  require_shape(joints, "joints", {kAnySize, static_cast<py::ssize_t>(kJointCount), 3});
  require_finite(joints, "joints");
  std::vector<Posture> postures(static_cast<std::size_t>(joints.shape(0)));
  const double* value = joints.data();
  for (Posture& posture : postures) {
    for (Vec3& joint : posture) {
      for (int axis = 0; axis < 3; ++axis) joint[axis] = *value++;
    }
  }
  return postures;
}

py::dict body_contacts(const DoubleArray& joints, double stature, const Box& box, const DoubleArray& box_positions,
                       const DoubleArray& box_quaternions) {
  const std::vector<Posture> postures = to_postures(joints);
  const Points places = to_points(box_positions, "box_positions");
  const auto frames = static_cast<py::ssize_t>(postures.size());
  require_shape(box_positions, "box_positions", {frames, 3});
  require_shape(box_quaternions, "box_quaternions", {frames, 4});
  require_finite(box_quaternions, "box_quaternions");
  if (!(stature >= 0.5 && stature <= 2.6))
    throw std::invalid_argument("stature is " + std::to_string(stature) + " m; it must lie between 0.5 and 2.6 m");
  std::array<std::vector<double>, kMoverCount> depths;
  for (std::size_t f = 0; f < postures.size(); ++f) {
    const double* q = box_quaternions.data() + 4 * f;
    const Mat3 axes = glm::mat3_cast(glm::normalize(Quat(q[0], q[1], q[2], q[3])));
    const Vec3 half = 0.5 * Vec3(box.width_m, box.depth_m, box.height_m);
    const OrientedBox there{places[f] + axes * Vec3(0, 0, half.z), half, axes};
    const Depths now = depths_of(capsules_of(postures[f], stature), there);
    for (std::size_t i = 0; i < kMoverCount; ++i) depths[i].push_back(now[i]);
  }
  py::dict out;
  for (std::size_t i = 0; i < kMoverCount; ++i)
    out[py::str(std::string(mover_name(static_cast<Mover>(i))))] = numbers_array(depths[i]);
  return out;
}

}  // namespace

void bind_contact(py::module_& m) {
  m.def("body_contacts", &body_contacts, py::arg("joints"), py::arg("stature"), py::arg("box"),
        py::arg("box_positions"), py::arg("box_quaternions"),
        "How deep forearms, hands and box lie in trunk, head, neck, thighs and shanks, all taken as capsules: dict of "
        "(n,) metres by 'left forearm', 'right forearm', 'left hand', 'right hand', 'box'; 0 where they do not. "
        "joints: (n, 27, 3), body frame; box_positions (n, 3) and box_quaternions (n, 4) as a Motion has them.");
}
