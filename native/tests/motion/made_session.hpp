// SPDX-License-Identifier: GPL-3.0-or-later
/// A person made up from formulas who works for a while: the hands rest, go to places and carry a box between them, at
/// times that are known. Every move has the speed of smooth_step.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "made_lift.hpp"
#include "reachcast/motion/find_reaches.hpp"

namespace reachcast::tests {

struct Stage {
  std::string phase;  ///< empty: nothing moves
  double seconds = 0.0;
  bool to_rest = false;
  Vec3 to{0.0};  ///< hold point at the end, where the hands do not go to rest
};

struct Session {
  Clip clip;
  ObjectTrack object{"box", {}};
  struct Truth {
    std::string phase;
    double start_s = 0.0, end_s = 0.0;
  };
  std::vector<Truth> truths;
};

inline Posture mixed(const Posture& a, const Posture& b, double share) {
  Posture out;
  for (std::size_t j = 0; j < kJointCount; ++j) out[j] = glm::mix(a[j], b[j], share);
  return out;
}

inline Vec3 hold_of(const Posture& p) {
  return 0.5 * (p[index(Joint::left_grip)] + p[index(Joint::right_grip)]);
}

inline Session made_session(const std::vector<Stage>& stages, double rate_hz = 60.0) {
  constexpr double width = 0.40;
  const Vec3 below_hands(0.0, 0.0, -0.1);
  const Body body = Body::from_stature(1.75);
  Session session;
  session.clip.source = "made";
  session.clip.rate_hz = rate_hz;
  for (const std::string_view name : joint_names()) session.clip.names.emplace_back(name);
  session.clip.derived.assign(kJointCount, false);
  double begin_s = 0.0;
  Posture from = body.posture();
  Vec3 box(0.0);
  for (const Stage& stage : stages) {
    if (stage.phase == "reach") {  // the box stands where the first reach ends
      box = stage.to + below_hands;
      break;
    }
  }
  for (const Stage& stage : stages) {
    const bool loaded = stage.phase == "transfer" || stage.phase == "retrieve";
    const Vec3 start = hold_of(from);
    const Posture to = stage.phase.empty() ? from
                       : stage.to_rest     ? body.posture()
                                           : holding_posture(body, stage.to, width);
    const double end_s = begin_s + stage.seconds;
    for (auto f = session.object.positions.size(); static_cast<double>(f) / rate_hz < end_s; ++f) {
      const double share = smooth_step((static_cast<double>(f) / rate_hz - begin_s) / stage.seconds);
      const Posture now =
          loaded ? holding_posture(body, glm::mix(start, stage.to, share), width) : mixed(from, to, share);
      session.clip.positions.insert(session.clip.positions.end(), now.begin(), now.end());
      if (loaded) box = hold_of(now) + below_hands;
      session.object.positions.push_back(box);
    }
    if (!stage.phase.empty()) session.truths.push_back({stage.phase, begin_s, end_s});
    from = to;
    begin_s = end_s;
  }
  return session;
}

inline const Vec3 kHome(0.0, 0.42, 0.75), kShelf(0.1, 0.45, 1.35), kHalfway(0.0, 0.42, 1.05);

inline Stage still(double seconds) {
  return {"", seconds, false, {}};
}

/// There and back: reach, transfer, return, reach, retrieve, return.
inline std::vector<Stage> there_and_back() {
  return {still(0.6), {"reach", 1.2, false, kHome},    still(0.4), {"transfer", 1.4, false, kShelf},
          still(0.4), {"return", 1.2, true, {}},       still(0.7), {"reach", 1.2, false, kShelf},
          still(0.4), {"retrieve", 1.4, false, kHome}, still(0.4), {"return", 1.2, true, {}},
          still(0.6)};
}

}  // namespace reachcast::tests
