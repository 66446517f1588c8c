// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/predict/plan.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace reachcast {
namespace {

constexpr double kPause_s = 0.25;      // hands on the object before it leaves and after it stands
constexpr double kRest_s = 0.4;        // between one errand and the next
constexpr double kAfter_s = 0.4;       // letting go, when nothing follows
constexpr double kAnticipation = 0.2;  // share of a phase over which the body gets going, and comes to rest
constexpr std::size_t kFewestFrames = 4;

std::size_t frames_in(double seconds, double rate) {
  return static_cast<std::size_t>(std::max(1L, std::lround(seconds * rate)));
}

[[noreturn]] void refuse(std::span<const Phase> phases, std::size_t at, const std::string& why) {
  std::string text;
  for (const Phase p : phases) text += (text.empty() ? "" : ", ") + std::string(phase_name(p));
  throw std::invalid_argument("phases (" + text + "): " + std::string(phase_name(phases[at])) + " " + why);
}

/// Collects events and numbers those that come again.
class EventList {
 public:
  void add(const std::string& name, std::size_t frame) {
    const auto times = std::count_if(events.begin(), events.end(),
                                     [&](const Event& e) { return e.name == name || e.name.starts_with(name + "_"); });
    events.push_back({times == 0 ? name : name + "_" + std::to_string(times + 1), frame});
  }
  std::vector<Event> events;
};

}  // namespace

Place other(Place place) {
  return place == Place::home ? Place::target : Place::home;
}

std::optional<std::size_t> Plan::frame_of(std::string_view event) const {
  const auto found = std::find_if(events.begin(), events.end(), [&](const Event& e) { return e.name == event; });
  return found == events.end() ? std::nullopt : std::optional(found->frame);
}

Place first_place(std::span<const Phase> phases) {
  if (phases.empty()) throw std::invalid_argument("phases is empty; it needs at least one phase");
  const auto loaded = std::find_if(phases.begin(), phases.end(), is_loaded);
  const Place first = loaded != phases.end() && *loaded == Phase::transfer ? Place::home : Place::target;
  Place object = first;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const bool hands_at_rest = i > 0 && phases[i - 1] == Phase::return_;
    if (phases[i] == Phase::reach && i > 0 && !hands_at_rest)
      refuse(phases, i, "begins with empty hands at rest, which only return brings about");
    if (phases[i] != Phase::reach && hands_at_rest)
      refuse(phases, i, "begins with the hands on the object, but return has taken them to rest; reach comes between");
    if (!is_loaded(phases[i])) continue;
    if ((phases[i] == Phase::transfer) != (object == Place::home))
      refuse(phases, i,
             object == Place::home ? "takes the object from the target, but it is at home"
                                   : "takes the object from home, but it is at the target");
    object = other(object);
  }
  return first;
}

Plan plan_phases(std::span<const Phase> phases, std::span<const double> seconds, double frame_rate) {
  Place object = first_place(phases);
  const std::size_t pause = frames_in(kPause_s, frame_rate), rest = frames_in(kRest_s, frame_rate);
  Plan plan;
  EventList events;
  std::size_t now = 0;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const bool loaded = is_loaded(phases[i]), is_last = i + 1 == phases.size();
    Stage stage{phases[i], object, 0, 0, 0.0, 0.0};
    if (i == 0 && loaded) events.add("grasp", now), now += pause;
    if (i == 0 && phases[i] == Phase::return_) events.add("release", now);
    if (loaded) events.add("lift_off", now);
    stage.first = now;
    now += std::max(kFewestFrames, frames_in(seconds[i], frame_rate));
    stage.last = now;
    if (phases[i] == Phase::reach) events.add("grasp", now);
    if (loaded) events.add("placed", now), object = other(object);
    now += phases[i] == Phase::return_ && !is_last ? rest : pause;
    const bool lets_go = is_last ? loaded : phases[i + 1] == Phase::return_;
    if (lets_go) events.add("release", now);
    plan.stages.push_back(stage);
  }
  for (std::size_t i = 0; i < plan.stages.size(); ++i) {
    Stage& stage = plan.stages[i];
    const bool is_last = i + 1 == plan.stages.size();
    stage.body_first = i == 0 ? 0.0 : plan.stages[i - 1].body_last;
    stage.body_last =
        is_last ? static_cast<double>(now) : 0.5 * static_cast<double>(stage.last + plan.stages[i + 1].first);
  }
  plan.end = now + (is_loaded(phases.back()) ? frames_in(kAfter_s, frame_rate) : 0);
  events.add("end", plan.end);
  plan.events = std::move(events.events);
  return plan;
}

double eased(double first, double last, double moment) {
  const double t = std::clamp((moment - first) / (last - first), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

double posture_time(const Stage& stage, double moment) {
  const double whole = stage.body_last - stage.body_first;
  const double anticipation = kAnticipation * static_cast<double>(stage.last - stage.first);
  const double up = static_cast<double>(stage.first) - stage.body_first + anticipation;
  const double down = stage.body_last - static_cast<double>(stage.last) + anticipation;
  const double speed = 1.0 / (whole - 0.5 * (up + down));
  const double t = std::clamp(moment - stage.body_first, 0.0, whole);
  if (t < up) return 0.5 * speed * t * t / up;
  if (t > whole - down) return 1.0 - 0.5 * speed * (whole - t) * (whole - t) / down;
  return speed * (t - 0.5 * up);
}

double load_share(const Plan& plan, double frame_rate, double moment) {
  const auto pause = static_cast<double>(frames_in(kPause_s, frame_rate));
  double share = 0.0;
  for (const Stage& stage : plan.stages) {
    if (!is_loaded(stage.phase)) continue;
    const auto first = static_cast<double>(stage.first), last = static_cast<double>(stage.last);
    share += eased(first - pause, first, moment) - eased(last, last + pause, moment);
  }
  return share;
}

}  // namespace reachcast
