// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/simulate/experiment.hpp"

#include <array>
#include <cmath>

#include "reachcast/curves/normal_numbers.hpp"
#include "reachcast/posture/twist.hpp"

namespace reachcast::simulate {
namespace {

// Where the handles are, in statures. The papers say "ankle to eye level", "near and far", "in front of the body at
// waist height"; the numbers are this project's.
constexpr std::array<double, kTowers> kTower_rad{0.0, 0.25 * kPi, 0.5 * kPi};
constexpr std::array<double, kLevels> kLevel{0.125, 0.33, 0.54, 0.74, 0.93};
constexpr std::array<double, kDepths> kNear_and_far{0.25, 0.33};
constexpr double kFarthestAcross = 0.45;  // of an arm's reach from a shoulder that need not lean: see depth_of
constexpr Vec3 kHome(0.0, 0.23, 0.57), kFloor(0.0, 0.235, 0.135);
constexpr double kPlacing_m = 0.015;  // how much people's placing varies: nobody was asked to be precise
constexpr double kPaperLoad_kg = 4.5, kFloorLoad_kg = 8.0;

BoxSpot spot_at(const Vec3& hold) {
  return {hold, facing_yaw(Vec3(0.0), hold)};
}

/// High and low shelves are less deep.
double depth_of(std::size_t level, std::size_t depth) {
  const double off = std::abs(kLevel[level] - 0.6);
  return depth == 0 ? kNear_and_far[0] : kNear_and_far[1] - (kNear_and_far[1] - 0.27) * (off / kFarthestAcross);
}

Vec3 target_of(std::size_t tower, std::size_t level, std::size_t depth) {
  const double ahead = depth_of(level, depth);
  return {ahead * std::sin(kTower_rad[tower]), ahead * std::cos(kTower_rad[tower]), kLevel[level]};
}

Vec3 placed(const Vec3& in_statures, double stature_m, std::uint64_t seed) {
  const Eigen::VectorXd normal = normal_numbers(seed, 3);
  return in_statures * stature_m + kPlacing_m * Vec3(normal[0], normal[1], 0.5 * normal[2]);
}

std::string numbered(const char* series, std::size_t person, std::size_t target, std::size_t replicate, Phase phase) {
  return std::string(series) + "/p" + std::to_string(person + 1) + "/t" + std::to_string(target + 1) + "/r" +
         std::to_string(replicate + 1) + "/" + std::string(phase_name(phase));
}

/// Adds motions of one series at one target.
class Series {
 public:
  Series(const Person& person, std::size_t number, std::uint64_t seed, std::vector<Errand>& out)
      : stature_m_(person.subject.stature_m), number_(number), seed_(seed), out_(out) {}

  void add(const char* series, const Vec3& home, const Vec3& target, std::size_t target_number, std::size_t replicate,
           double load_kg, std::initializer_list<Phase> phases) {
    const BoxSpot from = spot_at(placed(home, stature_m_, next())), to = spot_at(placed(target, stature_m_, next()));
    for (const Phase phase : phases) {
      out_.push_back({phase, from, to, load_kg, numbered(series, number_, target_number, replicate, phase), next()});
    }
  }

 private:
  std::uint64_t next() { return derived_seed(seed_, count_++); }
  double stature_m_;
  std::size_t number_;
  std::uint64_t seed_, count_ = 0;
  std::vector<Errand>& out_;
};

}  // namespace

std::vector<Errand> errands_of(const Person& person, std::size_t number, std::uint64_t seed) {
  using enum Phase;
  std::vector<Errand> out;
  Series series(person, number, seed, out);
  std::size_t count = 0;
  for (std::size_t tower = 0; tower < kTowers; ++tower) {
    for (std::size_t level = 0; level < kLevels; ++level) {
      for (std::size_t depth = 0; depth < kDepths; ++depth, ++count) {
        const Vec3 target = target_of(tower, level, depth);
        for (std::size_t replicate = 0; replicate < kReplicates; ++replicate) {
          series.add("paper", kHome, target, count, replicate, kPaperLoad_kg, {transfer, return_, reach, retrieve});
        }
        if (kLevel[level] > 0.2) series.add("floor", kFloor, target, count, 0, kFloorLoad_kg, {transfer, retrieve});
      }
    }
  }
  // People also come for a box on the floor and leave one there.
  for (std::size_t replicate = 0; replicate < kReplicates; ++replicate) {
    series.add("floor", kHome, kFloor, count, replicate, kFloorLoad_kg, {return_, reach});
  }
  return out;
}

}  // namespace reachcast::simulate
