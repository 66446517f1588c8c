// SPDX-License-Identifier: GPL-3.0-or-later
/// Which movements of a recording are which phases. Private to motion/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "movements.hpp"

namespace reachcast {

/// A way of the hands; without a phase `why_not` says what is amiss.
struct Way {
  FrameRange frames;
  std::optional<Phase> phase;
  std::string why_not;
};

struct WayPlan {
  std::vector<Way> ways;            ///< in order of time
  std::vector<ObjectEvent> events;  ///< in order of time
  std::string nothing;              ///< why there are no ways at all
};

/// The object tells when it is held: from lift-off to where it is placed.
[[nodiscard]] WayPlan plan_by_object(const HandTracks& hands, const Points& object, const std::string& name,
                                     const FindOptions& options);

/// The hands tell: having come to a place they hold something until they part or sink to the sides.
[[nodiscard]] WayPlan plan_by_hands(const HandTracks& hands, const Clip& clip, const FindOptions& options);

/// Transfer or retrieve: remembers where an object was picked up.
class Home {
 public:
  /// A new object, unless it is picked up where the last one was put.
  void pick_up(const Vec3& place);
  [[nodiscard]] Phase loaded_way(const Vec3& from, const Vec3& to);

 private:
  std::optional<Vec3> home_, put_;
};

}  // namespace reachcast
