// SPDX-License-Identifier: GPL-3.0-or-later
/// One function per concept; each adds its classes and functions to reachcast_core.
#pragma once

#include <pybind11/pybind11.h>

void bind_body(pybind11::module_& m);
void bind_posture(pybind11::module_& m);
void bind_weight(pybind11::module_& m);
void bind_contact(pybind11::module_& m);
void bind_curves(pybind11::module_& m);
void bind_hand_path(pybind11::module_& m);
void bind_variation(pybind11::module_& m);
void bind_mocap(pybind11::module_& m);
void bind_reaches(pybind11::module_& m);
void bind_corpus(pybind11::module_& m);
void bind_task(pybind11::module_& m);
void bind_predict(pybind11::module_& m);
void bind_cross_validate(pybind11::module_& m);
void bind_rig(pybind11::module_& m);
void bind_replay(pybind11::module_& m);
