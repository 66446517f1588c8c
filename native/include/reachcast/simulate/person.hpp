// SPDX-License-Identifier: GPL-3.0-or-later
/// The people of the simulated experiment: who they are and how each of them likes to lift.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "reachcast/body/body.hpp"
#include "reachcast/body/subject.hpp"

namespace reachcast::simulate {

inline constexpr std::size_t kPeople = 20;  ///< 10 women and 10 men, as in the 2004 and 2007 papers

struct Person {
  Subject subject;           ///< all four values are known
  Body body;                 ///< published proportions
  double squatting = 0.0;    ///< -1 stoops (spares the knees) to 1 squats (spares the back)
  double strength = 1.0;     ///< of an average man of 30 years; > 0
  double flexibility = 1.0;  ///< share of the joint ranges of an average person of 30 years; > 0
  double tempo = 1.0;        ///< times of motions relative to the published ones; > 0
  Eigen::Matrix<double, 6, 1> habit{Eigen::Matrix<double, 6, 1>::Zero()};  ///< of the hand's path, see hand_motion.hpp
};

/// The same people for the same seed on every machine. Statures 1.47 to 1.95 m and ages 20 to 70 years are spread
/// evenly, with both ends taken; stature, age and liking for the squat do not go together.
[[nodiscard]] std::vector<Person> make_people(std::uint64_t seed);

/// A seed for one use among many of a master seed: neighbouring numbers give unlike seeds (SplitMix64).
[[nodiscard]] std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t number);

}  // namespace reachcast::simulate
