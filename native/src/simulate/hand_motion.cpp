// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/simulate/hand_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "reachcast/curves/bezier.hpp"
#include "reachcast/curves/normal_numbers.hpp"
#include "reachcast/posture/twist.hpp"

namespace reachcast::simulate {
namespace {

// Exponents of the speed profile vary about the published medians by this share. The paper says that fitted exponents
// reduce the error from 6.9 to 3.2 cm, not how they vary; a fifth is this project's figure.
constexpr double kExponentSpread = 0.2;

// MTM-1, one time measurement unit (TMU) is 0.036 s. Move B and Reach B by inches: the published data card, times for
// 10, 20 and 30 inches and what is added per inch beyond. Weights: factor and constant by pounds in each hand.
// Bend 29.0 and arise 31.9 TMU: cited from memory, could not be checked; turn of the body 18.6 TMU: from the card.
constexpr double kTmu_s = 0.036, kInch_m = 0.0254, kPound_kg = 0.4536;
struct Row {
  double inches, move, reach;
};
constexpr std::array<Row, 8> kRows{{{1, 2.9, 2.5},
                                    {4, 6.9, 6.4},
                                    {10, 12.2, 11.5},
                                    {14, 14.6, 14.4},
                                    {20, 18.2, 18.6},
                                    {26, 21.8, 22.9},
                                    {30, 24.3, 25.8},
                                    {60, 42.3, 46.8}}};
struct Weight {
  double pounds, factor, constant;
};
constexpr std::array<Weight, 5> kWeights{
    {{2.5, 1.0, 0.0}, {7.5, 1.06, 2.2}, {12.5, 1.11, 3.9}, {22.5, 1.22, 7.4}, {47.5, 1.5, 16.0}}};
constexpr double kBend = 29.0, kArise = 31.9, kTurnBody = 18.6;
constexpr double kNoBend = 0.40, kFullBend = 0.22;  // of stature: hands this high need no bend, or a full one
constexpr double kNoTurn_rad = 0.35, kFullTurn_rad = 1.2;

/// Linear between rows, constant outside them.
template <class Rows, class Key, class Value>
double looked_up(const Rows& rows, double at, Key key, Value value) {
  if (at <= key(rows.front())) return value(rows.front());
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (at > key(rows[i])) continue;
    const double share = (at - key(rows[i - 1])) / (key(rows[i]) - key(rows[i - 1]));
    return value(rows[i - 1]) + share * (value(rows[i]) - value(rows[i - 1]));
  }
  return value(rows.back());
}

double share_between(double none, double full, double value) {
  return std::clamp((value - none) / (full - none), 0.0, 1.0);
}

}  // namespace

HandPath draw_hand_path(const Person& person, const Vec3& start, const Vec3& end, std::uint64_t seed) {
  HandPath path = HandPathModel::published().predict(start, end);
  const Eigen::VectorXd normal = normal_numbers(seed, 8);
  const double distance = glm::distance(start, end);
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < 3; ++k) {
      path.control[static_cast<std::size_t>(i + 1)][k] +=
          distance * (person.habit[3 * i + k] + kWithinPeople * normal[3 * i + k]);
    }
    // Both hands carry: the published step to the right is that of a right hand alone.
    path.control[static_cast<std::size_t>(i + 1)].x -=
        distance * HandPathModel::published().offsets()[static_cast<std::size_t>(i)].x;
  }
  path.speed.alpha *= std::max(0.4, 1.0 + kExponentSpread * normal[6]);
  path.speed.beta *= std::max(0.4, 1.0 + kExponentSpread * normal[7]);
  return path;
}

double largest_deviation(const HandPath& path) {
  const Vec3 start = path.control.front(), axis = path.control.back() - start;
  const double distance = glm::length(axis);
  double most = 0.0;
  for (int i = 1; i < 40; ++i) {
    const Vec3 away = eval_bezier(path.control, i / 40.0) - start;
    most = std::max(most, glm::length(away - axis * (glm::dot(away, axis) / (distance * distance))));
  }
  return most / distance;
}

double motion_seconds(const Person& person, Phase phase, const Vec3& start, const Vec3& end, double load_kg) {
  const double inches = glm::distance(start, end) / kInch_m;
  const auto by_inches = [](const Row& row) { return row.inches; };
  double hands = looked_up(kRows, inches, by_inches, [](const Row& row) { return row.reach; });
  if (is_loaded(phase)) {
    const double pounds = 0.5 * load_kg / kPound_kg;
    const auto by_pounds = [](const Weight& row) { return row.pounds; };
    hands = looked_up(kRows, inches, by_inches, [](const Row& row) { return row.move; }) *
                looked_up(kWeights, pounds, by_pounds, [](const Weight& row) { return row.factor; }) +
            looked_up(kWeights, pounds, by_pounds, [](const Weight& row) { return row.constant; });
  }
  const double stature = person.subject.stature_m;
  const auto depth = [&](const Vec3& hold) { return share_between(kNoBend * stature, kFullBend * stature, hold.z); };
  const double change = depth(end) - depth(start);
  const double trunk = change > 0.0 ? kBend * change : -kArise * change;
  const double turn = std::abs(facing_yaw(Vec3(0.0), end) - facing_yaw(Vec3(0.0), start));
  const double turning = kTurnBody * share_between(kNoTurn_rad, kFullTurn_rad, turn);
  return kTmu_s * person.tempo * std::max({hands, trunk, turning});
}

}  // namespace reachcast::simulate
