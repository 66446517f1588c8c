// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/learned_stage.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "reachcast/curves/normal_numbers.hpp"
#include "reachcast/motion/encode.hpp"
#include "reachcast/posture/free_arm.hpp"
#include "reachcast/predict/stand.hpp"

namespace reachcast {
namespace {

constexpr double kFarFromData_m = 0.25;
constexpr double kStatureMargin_m = 0.03;

/// What serves in the stead of a phase, whether it is played backwards for that, and whose hands it is of.
struct Substitute {
  Phase phase = Phase::transfer;
  bool backwards = false;
  Hands hands = Hands::both;
};

/// Best first. Phases that bring the hands to a place: transfer and reach; the others take them from one.
std::array<Substitute, 4> substitutes_for(Phase phase, Hands hands) {
  const bool arrives = phase == Phase::reach || phase == Phase::transfer;
  const bool loaded = is_loaded(phase);
  const Phase other = arrives ? (loaded ? Phase::reach : Phase::transfer) : (loaded ? Phase::return_ : Phase::retrieve);
  return {
      {{phase, false, hands}, {opposite(phase), true, hands}, {other, false, hands}, {opposite(other), true, hands}}};
}

/// Motions of other hands come last.
Substitute substitute_in(const MotionTable& table, const Query& query) {
  for (const Hands hands : {query.hands, Hands::both}) {
    for (const Substitute& substitute : substitutes_for(query.phase, hands)) {
      if (!table.of(substitute.phase, substitute.hands).rows.empty()) return substitute;
    }
  }
  if (!table.motions().empty()) {
    throw std::invalid_argument("the corpus holds motions of one hand only; it has nothing to say about " +
                                std::string(query.hands == Hands::both ? "both" : "the other"));
  }
  throw std::invalid_argument("the corpus holds no motions; import some first");
}

/// `recorded` holds at least one motion.
std::vector<std::string> why_outside(const PhaseColumns& recorded, const Query& query) {
  const auto nearest = [](const std::vector<Vec3>& places, const Vec3& wanted) {
    double square = 1e18;
    for (const Vec3& place : places) square = std::min(square, glm::dot(place - wanted, place - wanted));
    return std::sqrt(square);
  };
  const double target = nearest(recorded.target, query.target), home = nearest(recorded.home, query.home);
  std::vector<std::string> reasons;
  const auto add = [&](const auto&... parts) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(2);
    (out << ... << parts);
    reasons.push_back(out.str());
  };
  if (target > kFarFromData_m) add("the nearest recorded target is ", target, " m away");
  if (home > kFarFromData_m) add("the nearest recorded home is ", home, " m away");
  const std::vector<double>& statures = recorded.all.by(Trait::stature);
  const double shortest = statures.front(), tallest = statures.back();
  if (query.subject.stature_m < shortest - kStatureMargin_m || query.subject.stature_m > tallest + kStatureMargin_m) {
    add("stature ", query.subject.stature_m, " m lies outside the recorded ", shortest, " to ", tallest, " m");
  }
  return reasons;
}

/// Postures of both hands serve one: the trunk as it comes to the working one, the other arm at ease.
void lend(const Query& query, Blend& blend) {
  const Posture ease = standing_at_ease(Body::from_stature(query.subject.stature_m, query.subject.sex));
  const Vec3 hang = relative_hang(ease, query.hands);
  for (MotionCode* code : {&blend.from, &blend.to, &blend.whole}) {
    code->hands = query.hands;
    set_hang(*code, hang);
  }
}

std::string why_borrowed(const Query& query, const Substitute& substitute) {
  const std::string phase(phase_name(query.phase));
  std::string hand, with;
  if (query.hands != Hands::both) hand = " with the " + std::string(hands_name(query.hands)) + " hand";
  if (query.hands != substitute.hands) with = " with both hands";
  return "no " + phase + hand + " was recorded; postures are those of a " + std::string(phase_name(substitute.phase)) +
         with + (substitute.backwards ? " played backwards" : "");
}

/// The motions whose covariance is drawn from, in the order of their ids.
std::vector<std::shared_ptr<const MotionCode>> varying_codes(const Corpus& corpus, const MotionTable& table,
                                                             const Query& query, Scheme scheme) {
  scheme.k = kVaryingMotions;
  std::vector<std::int64_t> ids;
  for (const Neighbour& near : nearest_motions(table, query, End::both, scheme)) ids.push_back(near.id);
  std::sort(ids.begin(), ids.end());
  std::vector<std::shared_ptr<const MotionCode>> codes;
  for (const std::int64_t id : ids) codes.push_back(corpus.code(id));
  return codes;
}

void draw_variation(const Corpus& corpus, const MotionTable& table, const Query& query, const Scheme& scheme,
                    const Variation& variation, std::uint64_t draw, Blend& blend) {
  const auto codes = varying_codes(corpus, table, query, scheme);
  if (codes.size() < 2) {
    throw std::invalid_argument("a variation needs at least 2 recorded motions of phase " +
                                std::string(phase_name(query.phase)) + ", not " + std::to_string(codes.size()));
  }
  // Seeds of a person's choice are small numbers; a draw's are far from all of them.
  const std::uint64_t seed = variation.seed + 0x9E3779B97F4A7C15ULL * draw;
  const Eigen::VectorXd normal = variation.amount * normal_numbers(seed, static_cast<Eigen::Index>(codes.size()));
  vary(codes, {normal.data(), codes.size()}, query, blend);
}

}  // namespace

LearnedStage learn_stage(const Corpus& corpus, const MotionTable& table, const Query& query, const Scheme& scheme,
                         const std::optional<Variation>& variation, std::uint64_t draw) {
  const Substitute substitute = substitute_in(table, query);
  Query asked = query;
  asked.phase = substitute.phase;
  asked.hands = substitute.hands;
  if (substitute.backwards) std::swap(asked.home, asked.target);
  LearnedStage out;
  out.blend = blend_neighbours(table, asked, scheme, [&](std::int64_t id) { return corpus.code(id); });
  if (variation) draw_variation(corpus, table, asked, scheme, *variation, draw, out.blend);
  out.outside = why_outside(table.of(asked.phase, asked.hands), asked);
  if (substitute.backwards) reverse(out.blend);
  if (substitute.phase == query.phase && substitute.hands == query.hands) return out;
  if (substitute.hands != query.hands) lend(query, out.blend);
  out.borrowed = substitute.phase;
  out.outside.insert(out.outside.begin(), why_borrowed(query, substitute));
  return out;
}

LearnedStage retargeted_stage(const Corpus& corpus, const MotionTable& table, const Query& query, std::int64_t id) {
  const auto& motions = table.motions();
  const auto found =
      std::lower_bound(motions.begin(), motions.end(), id,
                       [](const MotionSummary& motion, std::int64_t wanted) { return motion.id < wanted; });
  if (found == motions.end() || found->id != id) {
    throw std::invalid_argument("the corpus " + corpus.path().string() + " has no motion " + std::to_string(id));
  }
  if (found->phase != query.phase) {
    throw std::invalid_argument("motion " + std::to_string(id) + " is a " + std::string(phase_name(found->phase)) +
                                "; it cannot serve as a " + std::string(phase_name(query.phase)));
  }
  if (found->hands != query.hands) {
    const auto of = [](Hands hands) {
      return hands == Hands::both ? "both hands" : "the " + std::string(hands_name(hands)) + " hand";
    };
    throw std::invalid_argument("motion " + std::to_string(id) + " is one of " + of(found->hands) +
                                "; it cannot serve for " + of(query.hands));
  }
  const std::vector<std::uint32_t>& rows = table.of(query.phase, query.hands).rows;
  const auto at = std::lower_bound(rows.begin(), rows.end(), static_cast<std::uint32_t>(found - motions.begin()));
  const std::shared_ptr<const MotionCode> code = corpus.code(id);
  const WeightedCode alone{code.get(), 1.0};
  LearnedStage out;
  blend_codes({&alone, 1}, {}, query, Average::coordinates, out.blend);
  out.blend.neighbours = {named(table, query, {static_cast<std::uint32_t>(at - rows.begin()), 1.0})};
  return out;
}

}  // namespace reachcast
