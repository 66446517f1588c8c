// SPDX-License-Identifier: GPL-3.0-or-later
/// People and boxes to hold for the tests of the simulation.
#pragma once

#include <algorithm>
#include <random>

#include "reachcast/posture/twist.hpp"
#include "reachcast/simulate/solve.hpp"

namespace reachcast::simulate::tests {

inline const std::vector<Person>& people() {
  static const std::vector<Person> made = make_people(2004);
  return made;
}

/// The person whose liking for the squat comes nearest.
inline const Person& who_squats(double liking) {
  return *std::min_element(people().begin(), people().end(), [&](const Person& a, const Person& b) {
    return std::abs(a.squatting - liking) < std::abs(b.squatting - liking);
  });
}

/// A box held between both hands at `place`, in statures.
inline Holding holding_at(const PoseModel& model, const Vec3& place, double load_kg) {
  const Vec3 hold = place * model.body().stature_m();
  const double yaw = facing_yaw(Vec3(0.0), hold);
  const Vec3 half = turned(Vec3(0.2, 0.0, 0.0), yaw);
  Holding out;
  out.anchors = model.anchors({hold - half, hold + half});
  out.load = {hold, load_kg};
  out.looked_at = hold;
  out.box = BoxPlace{hold, yaw};
  return out;
}

inline const Vec3 kOnFloor(0.0, 0.235, 0.135), kAtWaist(0.0, 0.23, 0.57), kAtEyes(0.0, 0.26, 0.93),
    kAtSide(0.25, 0.0, 0.54);

/// Any numbers at all.
inline Unknowns random_unknowns(std::mt19937_64& random, double spread) {
  Unknowns x;
  for (Eigen::Index i = 0; i < kUnknowns; ++i)
    x[i] = spread * (2.0 * static_cast<double>(random() >> 11) * 0x1.0p-53 - 1.0);
  return x;
}

}  // namespace reachcast::simulate::tests
