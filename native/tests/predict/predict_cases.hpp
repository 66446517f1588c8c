// SPDX-License-Identifier: GPL-3.0-or-later
/// A corpus of made-up lifts, and tasks for it.
#pragma once

#include "corpus/corpus_cases.hpp"
#include "motion/made_lift.hpp"
#include "reachcast/motion/encode.hpp"
#include "reachcast/predict/predict.hpp"

namespace reachcast::tests {

inline const Box kBox;  // grips 0.40 m apart, 0.12 m above the base
inline const Vec3 kUp(0.0, 0.0, kBox.handle_height_m);

/// A corpus of lifts made up from formulas: three statures, two homes, six targets, with mirror images; the same played
/// backwards; and reaches to where they begin, from hands held low.
class MadeCorpus {
 public:
  MadeCorpus() {
    std::vector<MotionCode> codes;
    for (const double stature : {1.55, 1.72, 1.9}) {
      for (const Vec3& home : {Vec3(0.03, 0.40, 0.15), Vec3(-0.05, 0.42, 0.6)}) {
        for (const double x : {-0.02, 0.15}) {
          for (const double z : {0.85, 1.1, 1.35}) {
            const Reach lift = made_lift(stature, home, {x, 0.40, z});
            add(codes, lift);
            add(codes, reversed(lift));
          }
        }
      }
    }
    for (const double stature : {1.55, 1.72, 1.9}) {
      for (const double x : {-0.02, 0.15}) {
        for (const double z : {0.15, 0.6, 1.1}) {
          Reach reach = made_lift(stature, {0.0, 0.32, 0.7}, {x, 0.40, z}, 31, 0.9);
          reach.phase = Phase::reach;
          add(codes, reach);
          add(codes, reversed(reach));
        }
      }
    }
    corpus_.add(codes);
  }
  [[nodiscard]] const Corpus& operator*() const { return corpus_; }

 private:
  static void add(std::vector<MotionCode>& codes, Reach reach) {
    reach.origin += " from " + std::to_string(reach.hold_point(0).z);
    codes.push_back(encode_reach(reach));
    codes.push_back(encode_reach(mirrored(reach)));
    codes.back().is_mirrored = true;
  }
  TemporaryFolder folder_;
  Corpus corpus_ = Corpus::create(folder_ / "made.sqlite");
};

inline const Corpus& made_corpus() {
  static const MadeCorpus made;  // nothing writes to it
  return *made;
}

inline Subject subject(double stature) {
  return {.stature_m = stature, .sex = {}, .age_years = {}, .mass_kg = {}};
}

inline Task task(const Vec3& home, const Vec3& target) {
  return {.home = home, .target = target, .object = kBox};
}

inline PredictOptions options(double frame_rate, int k = 5, std::map<Phase, double> durations_s = {}) {
  return {
      .frame_rate = frame_rate, .scheme = {.k = k}, .phases = {Phase::transfer}, .durations_s = std::move(durations_s)};
}

/// Links, and the sides of the rigid triangles of pelvis and chest.
inline const std::vector<std::pair<Joint, Joint>> kRigid = [] {
  using enum Joint;
  return std::vector<std::pair<Joint, Joint>>{{left_ball, left_ankle},
                                              {left_ankle, left_knee},
                                              {left_knee, left_hip},
                                              {right_ball, right_ankle},
                                              {right_ankle, right_knee},
                                              {right_knee, right_hip},
                                              {left_hip, right_hip},
                                              {left_hip, l5s1},
                                              {right_hip, l5s1},
                                              {l5s1, c7t1},
                                              {l5s1, left_clavicle},
                                              {l5s1, right_clavicle},
                                              {c7t1, left_clavicle},
                                              {left_clavicle, right_clavicle},
                                              {left_clavicle, left_shoulder},
                                              {right_clavicle, right_shoulder},
                                              {left_shoulder, left_elbow},
                                              {right_shoulder, right_elbow},
                                              {left_elbow, left_wrist},
                                              {right_elbow, right_wrist},
                                              {left_wrist, left_grip},
                                              {right_wrist, right_grip},
                                              {c7t1, tragion},
                                              {tragion, nasion}};
}();

inline std::size_t frame(const Motion& motion, std::string_view event) {
  return motion.plan.frame_of(event).value();
}

inline double worst_link(const Body& body, const Motion& motion) {
  double worst = 0.0;
  for (const Posture& p : motion.postures) {
    for (const auto& [a, b] : kRigid) {
      worst = std::max(worst, std::abs(glm::distance(p[index(a)], p[index(b)]) - body.distance(a, b)));
    }
  }
  return worst;
}

}  // namespace reachcast::tests
