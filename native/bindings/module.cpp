// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/pybind11.h>

#include "module.hpp"

PYBIND11_MODULE(reachcast_core, m) {
  m.doc() =
      "Predicts how a person moves when they carry a box to a shelf. Metres, seconds, kilograms, radians; z up; body "
      "frame: origin on the floor midway between the ankles, x to the subject's right, y forward. Quaternions are "
      "w, x, y, z. Arrays are C-ordered, frames first. A caller's mistake raises ValueError.";
  m.attr("__version__") = REACHCAST_VERSION;
  bind_body(m);
  bind_posture(m);
  bind_weight(m);
  bind_curves(m);
  bind_hand_path(m);
  bind_variation(m);
  bind_mocap(m);
  bind_reaches(m);
  bind_corpus(m);
  bind_task(m);
  bind_contact(m);
  bind_predict(m);
  bind_cross_validate(m);
  bind_rig(m);
  bind_replay(m);
}
