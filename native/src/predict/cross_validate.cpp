// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/cross_validate.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>

#include "reachcast/motion/encode.hpp"
#include "reachcast/posture/hold.hpp"
#include "reachcast/predict/blend.hpp"

namespace reachcast {
namespace {

constexpr int kTimes = 21;

using Postures = std::vector<Posture>;
using CoordinatesAt = std::function<Eigen::VectorXd(double)>;

/// A level pair of grips at the recorded distance goes along the path; the body follows. Nothing where it cannot.
std::optional<Postures> perform(const MotionSummary& motion, const EndpointPath& path,
                                const CoordinatesAt& coordinates) {
  if (motion.subject.stature_m < 1.2 || motion.subject.stature_m > 2.2)
    return std::nullopt;  // no published proportions
  const Body body = Body::from_stature(motion.subject.stature_m, motion.subject.sex);
  const BodyLinkage linkage(two_handed_linkage(), body);
  const Holder holder(two_handed_linkage(), body, usual_mass_kg(motion.subject.stature_m));
  const Vec3 half(0.5 * motion.grip_distance_m, 0.0, 0.0);
  Postures postures;
  for (int i = 0; i < kTimes; ++i) {
    const double t = static_cast<double>(i) / (kTimes - 1);
    const Vec3 hold = point_at(path, motion.home, motion.target, t);
    Anchors anchors = anchors_of(body.posture());
    anchors.grip = {hold - half, hold + half};
    HoldReport report;
    postures.push_back(holder.hold(linkage.decode(coordinates(t), anchors), anchors, {hold, 0.0}, report));
    if (report.shortfall_m > 0.0) return std::nullopt;
  }
  return postures;
}

double mean_distance(const Postures& a, const Postures& b) {
  double sum = 0.0;
  for (std::size_t f = 0; f < a.size(); ++f) {
    for (std::size_t j = 0; j < kRecordedJointCount; ++j) sum += glm::distance(a[f][j], b[f][j]);
  }
  return sum / static_cast<double>(a.size() * kRecordedJointCount);
}

double quantile(const std::vector<double>& sorted, double q) {
  const double at = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

bool is_left_out(const MotionSummary& motion, const MotionSummary& predicted, LeaveOut leave_out) {
  return leave_out == LeaveOut::motion ? motion.origin == predicted.origin : motion.subject_id == predicted.subject_id;
}

}  // namespace

std::vector<SchemeError> cross_validate(const Corpus& corpus, std::span<const Scheme> schemes, LeaveOut leave_out) {
  const std::shared_ptr<const MotionTable> table = corpus.table();
  const PhaseColumns& transfers = table->of(Phase::transfer);
  const CodeOf code_of = [&](std::int64_t id) { return corpus.code(id); };
  std::vector<SchemeError> rows;
  for (const Scheme& scheme : schemes) {
    SchemeError row{.scheme = scheme};
    std::vector<double> errors;
    for (const std::uint32_t at : transfers.rows) {
      const MotionSummary& motion = table->motions()[at];
      if (motion.is_mirrored) continue;
      const auto is_out = [&](const MotionSummary& other) { return is_left_out(other, motion, leave_out); };
      const Blend blend =
          blend_neighbours(*table, {Phase::transfer, motion.home, motion.target, motion.subject.stature_m},
                           scheme.neighbours, code_of, is_out);
      const std::shared_ptr<const MotionCode> own = code_of(motion.id);
      const auto truth = perform(motion, path_of(*own), [&](double t) { return coordinates_at(*own, t); });
      const auto guess = perform(motion, path_of(blend.whole), [&](double t) { return coordinates_at(blend, t); });
      if (truth && guess) {
        errors.push_back(mean_distance(*truth, *guess));
      } else {
        ++row.out_of_reach;
      }
    }
    if (errors.empty())
      throw std::invalid_argument("the corpus holds no transfer that can be predicted from the others");
    std::sort(errors.begin(), errors.end());
    row.motions = errors.size();
    row.median_m = quantile(errors, 0.5);
    row.lower_quartile_m = quantile(errors, 0.25);
    row.upper_quartile_m = quantile(errors, 0.75);
    rows.push_back(row);
  }
  return rows;
}

}  // namespace reachcast
