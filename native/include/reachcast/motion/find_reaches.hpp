// SPDX-License-Identifier: GPL-3.0-or-later
/// Cuts the phases out of a whole recording and names them, without anybody's labels.
///
/// - Movements lie between moments at which the hold point (middle of the grips) is still. Where one hand hangs at the
///   side whenever there is work, all reaches are of the other and the hold point is its grip. With an object's track
///   the hands hold it from lift-off to where it is placed; without one the hands tell: once they have come to a place,
///   they hold something as long as they keep their distance from each other and do not sink to the sides.
/// - Names: empty to the object, or to the first place, is `reach`; holding is `transfer`; holding back to where the
///   object was picked up is `retrieve`; empty afterwards is `return`.
/// - A way on which a foot steps is cut to the part in which both stand, at the end where the hands grasp or let go.
/// - Every movement becomes a reach or a rejection with its reason. Nothing found at all is one rejection.
///
/// Frames include both ends. The clip is canonical (see to_canonical).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reachcast/mocap/clip.hpp"
#include "reachcast/mocap/tracking.hpp"
#include "reachcast/motion/cut_reach.hpp"
#include "reachcast/motion/reach.hpp"

namespace reachcast {

struct FindOptions {
  double still_part = 0.10;       ///< 0 to 1, of a movement's peak speed: below it has not begun, or is over
  double still_speed = 0.05;      ///< m/s, > 0: hands slower than this stand still, whatever the peak
  double pause_s = 0.3;           ///< >= 0: a shorter stop does not part a way in two, unless the hands turn back
  double least_s = 0.4;           ///< >= 0: a phase lasts at least this long
  double least_travel_m = 0.15;   ///< > 0: and its hold point ends at least this far from where it began
  double fastest_end = 0.75;      ///< 0 to 1, of the peak speed: hands faster than this when a step cuts a phase off
  double step_m = 0.08;           ///< > 0: a ball of the foot that has moved this far has stepped
  double ankle_step_m = 0.15;     ///< > 0: the same for ankles, where the balls were not recorded
  double slip_m = 0.08;           ///< > 0: a hand whose distance from the object varies more does not hold it
  double parted_m = 0.16;         ///< > 0: hands whose distance varies more do not hold one thing between them
  double uneven_m = 0.15;         ///< > 0: one hand this much higher than the other does not hold as the other does
  double longest_filled_s = 0.2;  ///< >= 0: a longer gap that was filled (see fill_gaps) rejects its phase
  CutOptions cut;                 ///< how the phases are cut out (see cut_reach)
};

/// An object's place over time: F points, metres, z up, world of the recording; NaN where missing.
struct ObjectTrack {
  std::string name;
  Points positions;
};

/// The point `name` of a recording; without a name the first of obj, object and box in any letter case that it has, and
/// nothing when it has none. Throws std::invalid_argument naming the points when there is no point `name`.
[[nodiscard]] std::optional<ObjectTrack> object_track(const Clip& recorded,
                                                      const std::optional<std::string>& name = std::nullopt);

/// What else is known about a recording.
struct Evidence {
  std::optional<ObjectTrack> object;  ///< as many frames as the clip
  std::vector<TrackingFault> faults;  ///< frames not to be believed (see check_tracking); each rejects its phase only
  std::string origin;                 ///< goes before ":first-last" in a reach's origin; empty: the clip's source
};

/// A part of the recording that is no reach.
struct Rejection {
  std::string what;  ///< the phase that it would have been, else "movement" or "recording"
  std::string reason;
  std::size_t first = 0;
  std::size_t last = 0;
};

/// Something that happens to the object at a frame.
struct ObjectEvent {
  std::string name;  ///< "grasp", "lift-off", "placed" or "release"
  std::size_t frame = 0;
};

struct FoundReaches {
  std::vector<Reach> reaches;      ///< in order of time
  std::vector<FrameRange> frames;  ///< of each reach, in the same order
  std::vector<Rejection> rejections;
  std::vector<ObjectEvent> events;  ///< in order of time
};

/// Throws std::invalid_argument for a clip that is not canonical, a stature outside 0.5 to 2.6 m, an object with
/// another number of frames, and options out of range.
[[nodiscard]] FoundReaches find_reaches(const Clip& clip, const Subject& subject, const FindOptions& options = {},
                                        const Evidence& evidence = {});

}  // namespace reachcast
