// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstring>
#include <memory>

#include "array_checks.hpp"
#include "body_conversions.hpp"
#include "module.hpp"
#include "reachcast/rig/retarget.hpp"
#include "reachcast/rig/rotation_values.hpp"

namespace py = pybind11;
using namespace reachcast;
using namespace reachcast::bindings;

namespace {

static_assert(sizeof(Posture) == 3 * kJointCount * sizeof(double), "a posture is as contiguous as a row of an array");
constexpr auto kJoints = static_cast<py::ssize_t>(kJointCount);

/// A pose and the rig that it is of.
struct PosedRig {
  std::shared_ptr<const RestRig> rest;
  RigPose pose;
};

/// (n, 3, 3) to n matrices, all finite; rows of the array are rows of the matrix.
std::vector<Mat3> to_matrices(const DoubleArray& array, std::string_view name) {
  require_shape(array, name, {kAnySize, 3, 3});
  require_finite(array, name);
  std::vector<Mat3> matrices(static_cast<std::size_t>(array.shape(0)));
  const double* value = array.data();
  for (Mat3& matrix : matrices) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) matrix[column][row] = *value++;
    }
  }
  return matrices;
}

Mat3 to_axes(const DoubleArray& array) {
  require_shape(array, "axes", {3, 3});
  require_finite(array, "axes");
  const double* const v = array.data();
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}};  // rows of the array are right, forward, up
}

std::shared_ptr<RestRig> make_rest_rig(std::vector<int> parents, const DoubleArray& heads, const DoubleArray& rotations,
                                       const std::map<std::string, int>& segments, const DoubleArray& joints,
                                       const DoubleArray& axes) {
  return std::make_shared<RestRig>(
      RestBones{std::move(parents), to_points(heads, "heads"), to_matrices(rotations, "rotations")}, segments,
      to_posture(joints, "joints"), to_axes(axes));
}

PosedRig pose_rig(std::shared_ptr<const RestRig> rest, const DoubleArray& joints, const std::vector<double>& bends) {
  require_shape(joints, "joints", {kAnySize, kJoints, 3});
  require_finite(joints, "joints");
  std::vector<Posture> postures(static_cast<std::size_t>(joints.shape(0)));
  if (!postures.empty()) {
    std::memcpy(static_cast<void*>(postures.data()), joints.data(), postures.size() * sizeof(Posture));
  }
  const py::gil_scoped_release without_gil;
  RigPose pose = retarget(*rest, postures, bends);
  return {std::move(rest), std::move(pose)};
}

/// Heads of the bones of the back but the first.
Points back_joints(const RestRig& rest) {
  Points heads;
  for (const int bone : rest.back()) heads.push_back(rest.bones().heads[static_cast<std::size_t>(bone)]);
  heads.erase(heads.begin());
  return heads;
}

py::array_t<double> turns_array(const PosedRig& posed) {
  const auto frames = static_cast<py::ssize_t>(posed.pose.frames);
  py::array_t<double> out(
      {static_cast<py::ssize_t>(posed.rest->keyed().size()), frames, py::ssize_t{3}, py::ssize_t{3}});
  double* value = out.mutable_data();
  for (const Mat3& turn : posed.pose.turns) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) *value++ = turn[column][row];
    }
  }
  return out;
}

py::array_t<double> heads_array(const PosedRig& posed) {
  return points_array(posed.pose.heads)
      .reshape(std::vector<py::ssize_t>{static_cast<py::ssize_t>(posed.rest->keyed().size()),
                                        static_cast<py::ssize_t>(posed.pose.frames), 3});
}

py::array_t<double> joints_array(const PosedRig& posed) {
  std::vector<Posture> postures;
  {
    const py::gil_scoped_release without_gil;
    postures = posed_joints(*posed.rest, posed.pose);
  }
  py::array_t<double> out({static_cast<py::ssize_t>(postures.size()), kJoints, py::ssize_t{3}});
  std::memcpy(out.mutable_data(), postures.data(), postures.size() * sizeof(Posture));
  return out;
}

py::array_t<double> values_array(const std::vector<double>& values, RotationMode mode) {
  const auto width = static_cast<py::ssize_t>(value_count(mode));
  py::array_t<double> out({static_cast<py::ssize_t>(values.size()) / width, width});
  std::copy(values.begin(), values.end(), out.mutable_data());
  return out;
}

py::array_t<double> bone_values(const PosedRig& posed, int bone, std::string_view mode_name) {
  const RotationMode mode = rotation_mode(mode_name);
  std::vector<double> values;
  {
    const py::gil_scoped_release without_gil;
    values = rotation_values(local_rotations(*posed.rest, posed.pose, bone), mode);
  }
  return values_array(values, mode);
}

py::array_t<double> free_values(const DoubleArray& rotations, std::string_view mode_name) {
  const RotationMode mode = rotation_mode(mode_name);
  const std::vector<Mat3> matrices = to_matrices(rotations, "rotations");
  std::vector<double> values;
  {
    const py::gil_scoped_release without_gil;
    values = rotation_values(matrices, mode);
  }
  return values_array(values, mode);
}

}  // namespace

void bind_rig(py::module_& m) {
  py::class_<RestRig, std::shared_ptr<RestRig>>(
      m, "RestRig", "A rig at rest in the world: its bones, which of them are which segment, and its joint centres.")
      .def(
          py::init(&make_rest_rig), py::arg("parents"), py::arg("heads"), py::arg("rotations"), py::arg("segments"),
          py::arg("joints"), py::arg("axes"),
          "Metres, world. parents: index of each bone's parent, which stands before it, or -1. heads (B, 3). rotations "
          "(B, 3, 3): columns are the bone's own axes. segments: {segment: bone index} such as 'upper_arm.L'; all but "
          "the toes are needed. joints (27, 3): rest joint centres. axes (3, 3): rows are the body's right, forward, "
          "up. ValueError names what does not fit.")
      .def_property_readonly(
          "keyed", [](const RestRig& rest) { return py::tuple(py::cast(rest.keyed())); },
          "indices of the bones that get keys: the mapped ones and all above them, parents first")
      .def(
          "retarget",
          [](std::shared_ptr<RestRig> rest, const DoubleArray& joints, const std::vector<double>& bends) {
            return pose_rig(std::move(rest), joints, bends);
          },
          py::arg("joints"), py::arg("bends") = std::vector<double>(),
          "joints (F, 27, 3), world, of a body with this rig's own measures -> RigPose. bends (F,): how far the back "
          "is "
          "bent, radians, which the bones of the back share evenly; none for a straight one. ValueError when F is 0, "
          "for another number of bends, or when a number is not finite.")
      .def_property_readonly(
          "back_joints", [](const RestRig& rest) { return points_array(back_joints(rest)); },
          "(n - 1, 3), world: where the n bones between spine and chest meet, at which the back bends; see "
          "Body.bending_at")
      .def("__repr__", [](const RestRig& rest) {
        return "RestRig(" + std::to_string(rest.bones().parents.size()) + " bones, " +
               std::to_string(rest.keyed().size()) + " keyed)";
      });

  py::class_<PosedRig>(m, "RigPose", "The keyed bones of a rig over time.")
      .def_property_readonly(
          "keyed", [](const PosedRig& posed) { return py::tuple(py::cast(posed.rest->keyed())); },
          "indices of the K keyed bones, in the order of turns and heads")
      .def_property_readonly("turns", &turns_array,
                             "(K, F, 3, 3), world: carries a bone's rest orientation to its posed one")
      .def_property_readonly("heads", &heads_array, "(K, F, 3), world, metres: where the heads of the bones are")
      .def("joints", &joints_array,
           "(F, 27, 3), world: the joint centres that the posed bones carry, by forward kinematics")
      .def("rotation_values", &bone_values, py::arg("bone"), py::arg("mode"),
           "Values (F, 4 or 3) that key a bone's own rotation in a Blender rotation mode; see the function "
           "rotation_values. bone: one of `keyed`, else ValueError.")
      .def("__len__", [](const PosedRig& posed) { return posed.pose.frames; })
      .def("__repr__", [](const PosedRig& posed) {
        return "RigPose(" + std::to_string(posed.rest->keyed().size()) + " bones, " +
               std::to_string(posed.pose.frames) + " frames)";
      });

  m.def("rotation_values", &free_values, py::arg("rotations"), py::arg("mode"),
        "rotations (F, 3, 3) -> values without jumps from frame to frame. mode: 'QUATERNION' (F, 4) w, x, y, z; "
        "'AXIS_ANGLE' (F, 4) radians, then the axis; an Euler order such as 'XYZ' (F, 3) radians about x, y, z. "
        "ValueError for another mode.");
}
