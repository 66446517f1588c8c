// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <stdexcept>

#include "check_way.hpp"
#include "keep_reach.hpp"
#include "reachcast/motion/labels.hpp"

namespace reachcast {
namespace {

/// What the label says of the person before what is known otherwise; nothing without a stature.
std::optional<Subject> subject_of(const PhaseLabel& label, const std::optional<Subject>& known) {
  Subject subject = known.value_or(Subject{});
  if (label.stature_m) subject.stature_m = *label.stature_m;
  if (label.sex) subject.sex = label.sex;
  if (label.age_years) subject.age_years = label.age_years;
  if (label.mass_kg) subject.mass_kg = label.mass_kg;
  if (!known && !label.stature_m) return std::nullopt;
  return subject;
}

std::optional<ObjectTrack> object_of(const PhaseLabel& label, const Clip* recorded, const Evidence& evidence) {
  if (label.object && recorded && recorded->find(*label.object)) return object_track(*recorded, label.object);
  return evidence.object;
}

void cut_label(const Clip& clip, const HandTracks& hands, const PhaseLabel& label, const Subject& subject,
               const Clip* recorded, const FindOptions& options, Evidence evidence, FoundReaches& found) {
  const FrameRange range = label.frames(clip);
  evidence.object = object_of(label, recorded, evidence);
  const Keeper keeper(clip, subject, options, evidence);
  std::optional<Points> object;
  if (evidence.object && is_loaded(label.phase)) {
    object = bridged(evidence.object->positions, "the object '" + evidence.object->name + "'");
  }
  const Tracked all{clip, hands, object ? &*object : nullptr, object ? &evidence.object->positions : nullptr,
                    evidence.faults};
  std::string reason = standing_about(clip, range.first, range, options).moved;
  if (reason.empty()) reason = why_not(all, range, label.phase, options);
  keeper.keep(range, label.phase, label.hands, reason, found);
}

}  // namespace

FoundReaches cut_labelled(const Clip& clip, const std::vector<PhaseLabel>& labels,
                          const std::optional<Subject>& subject, const Clip* recorded, const FindOptions& options,
                          const Evidence& evidence) {
  const Subject anybody{1.75, {}, {}, {}};
  const Keeper checked(clip, subject.value_or(anybody), options, evidence);
  FoundReaches found;
  const std::array<HandTracks, kHandsCount> tracks{hand_tracks(clip), hand_tracks(clip, Hands::left),
                                                   hand_tracks(clip, Hands::right)};
  for (const PhaseLabel& label : labels) {
    const HandTracks& hands = tracks[static_cast<std::size_t>(label.hands)];
    const std::size_t first = label.first.value_or(0), last = label.last.value_or(0);
    const std::string phase(phase_name(label.phase));
    const std::optional<Subject> person = subject_of(label, subject);
    found.events.insert(found.events.end(), label.events.begin(), label.events.end());
    if (!person) {
      const std::string where = label.table + ":" + std::to_string(label.line);
      found.rejections.push_back({phase, where + ": the stature of the person is not known", first, last});
      continue;
    }
    try {
      cut_label(clip, hands, label, *person, recorded, options, evidence, found);
    } catch (const std::invalid_argument& refusal) {
      found.rejections.push_back({phase, refusal.what(), first, last});
    }
  }
  std::stable_sort(found.events.begin(), found.events.end(),
                   [](const ObjectEvent& a, const ObjectEvent& b) { return a.frame < b.frame; });
  return found;
}

}  // namespace reachcast
