// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/posture/linkage.hpp"

namespace reachcast {
namespace {

// How far people bend: elbow to 150 degrees (American Academy of Orthopaedic Surgeons, 1965), ten less with a load;
// knee to 135, with the heels on the floor as deep as the recorded squats go. The lower bounds keep a bend in the limb:
// a straight limb has no plane, and people do not lock elbows or knees under a load.
constexpr FlexionLimit kElbow{0.12, 2.45};
constexpr FlexionLimit kKnee{0.07, 2.35};

Linkage make_two_handed() {
  using enum Joint;
  Linkage linkage;
  linkage.primary = {"primary",
                     {left_ball, left_ankle, left_knee, left_hip, l5s1, right_clavicle, right_shoulder, right_elbow,
                      right_wrist, right_grip},
                     {right_clavicle, left_hip, right_shoulder, right_wrist, left_ankle},
                     {{right_elbow, kElbow}, {left_knee, kKnee}}};
  linkage.parts = {{{"pelvis", left_hip, l5s1, right_hip, {}},
                    {"chest", l5s1, right_clavicle, c7t1, {suprasternale, left_clavicle}}}};
  linkage.limbs = {{{left_hip, left_knee, left_ankle, kKnee, 0.2},
                    {right_hip, right_knee, right_ankle, kKnee, 0.2},
                    {left_shoulder, left_elbow, left_wrist, kElbow, 1.0},
                    {right_shoulder, right_elbow, right_wrist, kElbow, 1.0}}};
  linkage.pointers = {{left_clavicle, left_shoulder, kChest},
                      {right_clavicle, right_shoulder, kChest},
                      {c7t1, tragion, kChest},
                      {tragion, nasion, kChest},
                      {left_grip, left_wrist, PointerSpec::kObject},
                      {right_grip, right_wrist, PointerSpec::kObject}};
  return linkage;
}

}  // namespace

const Linkage& two_handed_linkage() {
  static const Linkage linkage = make_two_handed();
  return linkage;
}

}  // namespace reachcast
