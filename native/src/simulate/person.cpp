// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/simulate/person.hpp"

#include <algorithm>
#include <array>

#include "reachcast/curves/normal_numbers.hpp"
#include "reachcast/simulate/hand_motion.hpp"

namespace reachcast::simulate {
namespace {

constexpr std::size_t kOfEachSex = kPeople / 2;
constexpr double kShortestWoman_m = 1.47, kTallestWoman_m = 1.80;
constexpr double kShortestMan_m = 1.61, kTallestMan_m = 1.95;
constexpr double kYoungest = 20.0, kOldest = 70.0;

// Orders that keep stature, age and style apart: each is a permutation, correlations with 0, 1, ..., 9 below 0.1.
constexpr std::array<std::size_t, kOfEachSex> kAgeOrder{5, 0, 8, 3, 9, 1, 6, 2, 7, 4};
constexpr std::array<std::size_t, kOfEachSex> kStyleOrder{3, 8, 1, 6, 9, 0, 4, 7, 2, 5};

// Women have some 0.6 to 0.65 of men's strength in the trunk and legs. From about the fifth decade on, 12 to 15 % are
// lost in ten years (Hurley 1995). Joint ranges shrink a little with age (Soucie et al. 2011, Stubbs et al. 1993: 4 to
// 30 % from 25 to 54 years, by joint); women's are a little larger.
constexpr double kWomensStrength = 0.63;
constexpr double kStrengthLostPerYear = 0.0125, kStrengthFalls_years = 45.0;
constexpr double kRangeLostPerYear = 0.0025, kWomensRange = 1.03;

// 100 % of MTM-1 is a trained worker's pace; people in a laboratory take their time, and older ones more of it.
constexpr double kLaboratoryPace = 1.15, kSlowerPerYear = 0.003, kPaceSpread = 0.10;

double spread_over(double first, double last, std::size_t i) {
  return first + (last - first) * static_cast<double>(i) / static_cast<double>(kOfEachSex - 1);
}

Person make_person(Sex sex, std::size_t i, std::uint64_t seed) {
  const bool woman = sex == Sex::female;
  const Eigen::VectorXd normal = normal_numbers(seed, 10);
  const double stature =
      woman ? spread_over(kShortestWoman_m, kTallestWoman_m, i) : spread_over(kShortestMan_m, kTallestMan_m, i);
  const std::size_t other_way = woman ? i : kOfEachSex - 1 - i;
  const double age = spread_over(kYoungest, kOldest, kAgeOrder[other_way]);
  const double mass_index = std::clamp(24.5 + 2.8 * normal[0], 19.0, 32.0);
  const Subject subject{stature, sex, age, mass_index * stature * stature};
  Person person{.subject = subject, .body = Body::from_stature(stature, sex)};
  person.squatting = spread_over(-1.0, 1.0, kStyleOrder[other_way]);
  person.strength = (woman ? kWomensStrength : 1.0) *
                    (1.0 - kStrengthLostPerYear * std::max(0.0, age - kStrengthFalls_years)) *
                    std::clamp(1.0 + 0.12 * normal[1], 0.7, 1.3);
  person.flexibility = (woman ? kWomensRange : 1.0) * (1.0 - kRangeLostPerYear * (age - 30.0));
  person.tempo =
      kLaboratoryPace * (1.0 + kSlowerPerYear * (age - 30.0)) * std::clamp(1.0 + kPaceSpread * normal[2], 0.75, 1.3);
  person.habit = kBetweenPeople * normal.segment<6>(3);
  return person;
}

}  // namespace

std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t number) {
  std::uint64_t z = seed + (number + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

std::vector<Person> make_people(std::uint64_t seed) {
  std::vector<Person> people;
  for (const Sex sex : {Sex::female, Sex::male}) {
    for (std::size_t i = 0; i < kOfEachSex; ++i)
      people.push_back(make_person(sex, i, derived_seed(seed, people.size())));
  }
  return people;
}

}  // namespace reachcast::simulate
