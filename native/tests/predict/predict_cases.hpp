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

/// A corpus of lifts made up from formulas: three statures, three homes, nine targets, with mirror images.
class MadeCorpus {
 public:
  MadeCorpus() {
    std::vector<MotionCode> codes;
    for (const double stature : {1.55, 1.72, 1.9}) {
      for (const Vec3& home : {Vec3(0.03, 0.40, 0.15), Vec3(-0.05, 0.42, 0.6)}) {
        for (const double x : {-0.02, 0.15}) {
          for (const double z : {0.85, 1.1, 1.35}) add(codes, made_lift(stature, home, {x, 0.40, z}));
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

}  // namespace reachcast::tests
