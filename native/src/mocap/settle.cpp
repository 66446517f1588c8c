// SPDX-License-Identifier: GPL-3.0-or-later
#include "settle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "joint_sources.hpp"
#include "text_scanner.hpp"
#include "units.hpp"

namespace reachcast {
namespace {

using enum Joint;

constexpr double kShortestPlausible_m = 0.9;  // a stated unit is believed for children and for inexact statures
constexpr double kTallestPlausible_m = 2.4;
constexpr double kWidest_m = 20.0;  // markers of one frame spread less than this
constexpr double kNarrowest_m = 0.01;
constexpr std::size_t kCrowd = 8;        // fewer points than this do not show which way a body stands
constexpr double kToesBackwards = -0.5;  // feet that point this much backwards belong to a person seen the wrong way
constexpr double kUprightShape = 1.25;   // a standing crowd of points is this much longer than wide

/// Median over frames of the extent of all finite points along each axis; NaN without any.
Vec3 typical_extent(const MotionFile& file) {
  std::array<std::vector<double>, 3> extents;
  for (std::size_t frame = 0; frame < file.frames(); ++frame) {
    Vec3 low(HUGE_VAL), high(-HUGE_VAL);
    for (std::size_t joint = 0; joint < file.joints(); ++joint) {
      const Vec3& point = file.at(frame, joint);
      if (!is_finite(point)) continue;
      low = glm::min(low, point);
      high = glm::max(high, point);
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (high[axis] >= low[axis]) extents[static_cast<std::size_t>(axis)].push_back(high[axis] - low[axis]);
    }
  }
  return {median_of(extents[0]), median_of(extents[1]), median_of(extents[2])};
}

/// The axis along which the crowd of points is clearly longest. Which way along it is up is told by the floor, which
/// lies nearer to zero than the head.
std::optional<std::string> up_of_crowd(const MotionFile& file, const Vec3& extent) {
  if (file.joints() < kCrowd) return std::nullopt;
  int axis = 0;
  for (int other = 1; other < 3; ++other) {
    if (extent[other] > extent[axis]) axis = other;
  }
  for (int other = 0; other < 3; ++other) {
    if (other != axis && !(extent[axis] > kUprightShape * extent[other])) return std::nullopt;
  }
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Vec3& point : file.positions) {
    if (!is_finite(point)) continue;
    low = std::min(low, point[axis]);
    high = std::max(high, point[axis]);
  }
  return signed_axis(axis, std::abs(low) > std::abs(high));
}

/// Up from the shoulders above the ankles of a known set of joints, else from names; along the file's axes.
std::optional<std::string> up_of_body(const MotionFile& file, const std::optional<JointSources>& body) {
  if (!body) return guess_up(file.names, file.positions);
  const std::vector<std::string> names{"shoulder", "shoulder", "ankle", "ankle"};
  Points poses;
  for (std::size_t frame = 0; frame < file.frames(); ++frame) {
    for (const Joint joint : {left_shoulder, right_shoulder, left_ankle, right_ankle}) {
      poses.push_back(plain_mean(file, frame, (*body)[index(joint)].points));
    }
  }
  return guess_up(names, poses);
}

void settle_up(const MotionFileOptions& options, const FileSays& says, const std::optional<JointSources>& body,
               MotionFile& file) {
  Guess& guess = file.guess;
  if (options.up) {
    guess.up = *options.up;
    guess.up_from = From::argument;
  } else if (const auto seen = up_of_body(file, body)) {
    guess.up = *seen;
    guess.up_from = From::data;
    if (says.up && *says.up != *seen) {
      add_note(file.note, "The file says that " + *says.up + " is up, but head and feet say " + *seen + ".");
    }
  } else if (says.up) {
    guess.up = *says.up;
    guess.up_from = From::file;
  } else if (const auto crowd = up_of_crowd(file, typical_extent(file))) {
    guess.up = *crowd;
    guess.up_from = From::data;
  } else {
    guess.up = says.usual_up;
    guess.up_from = From::usual;
  }
  const char* why = guess.up_from == From::data ? ", from head and feet." : ", as usual.";
  const bool is_worth_saying = guess.up_from == From::data || guess.up_from == From::usual;
  if (is_worth_saying && (guess.up != "z" || says.usual_up != "z")) {
    add_note(file.note, "Up is taken to be " + guess.up + why);
  }
}

[[noreturn]] void fail_unit(const MotionFile& file, const std::string& found) {
  throw std::invalid_argument(file.source + ": expected a skeleton 1.15 to 2.1 m tall in some known unit, found " +
                              found + "; give metres_per_unit");
}

bool is_plausible(double stature_m) {
  return stature_m >= kShortestPlausible_m && stature_m <= kTallestPlausible_m;
}

void take_unit(MotionFile& file, double metres, From from) {
  file.guess.metres_per_unit = metres;
  file.guess.unit = unit_name(metres);
  file.guess.unit_from = from;
}

/// The file's or the format's own unit, unless it makes a giant or a dwarf of the person.
void settle_unit_of_person(const FileSays& says, double height, MotionFile& file) {
  const std::optional<double> assumed = says.metres_per_unit ? says.metres_per_unit : says.usual_unit;
  const From from = says.metres_per_unit ? From::file : From::usual;
  const std::optional<Unit> fitting = guess_unit(height);
  const auto shown_m = [&](double unit) { return show(std::round(height * unit * 1e3) / 1e3) + " m"; };
  if (says.metres_per_unit && is_plausible(height * *says.metres_per_unit)) {
    take_unit(file, *says.metres_per_unit, From::file);
  } else if (fitting) {
    take_unit(file, fitting->metres, From::data);
    if (says.metres_per_unit) {
      add_note(file.note, "The file states " + unit_name(*says.metres_per_unit) + ", but the person would be " +
                              shown_m(*says.metres_per_unit) + " tall.");
    }
    if (fitting->metres != says.usual_unit) {
      add_note(file.note, "The unit is taken to be " + std::string(fitting->name) + ": the skeleton is " +
                              shown_m(fitting->metres) + " from foot to head.");
    }
  } else if (assumed && is_plausible(height * *assumed)) {
    take_unit(file, *assumed, from);
  } else {
    fail_unit(file, show(height) + " units from foot to head");
  }
}

/// Without a body whose parts are known: the crowd of points must be of a size that can be.
void settle_unit_of_crowd(const FileSays& says, MotionFile& file) {
  const Vec3 extent = typical_extent(file);
  const double size = std::max({extent.x, extent.y, extent.z});
  if (says.metres_per_unit || says.usual_unit) {
    const double unit = says.metres_per_unit.value_or(says.usual_unit.value_or(1.0));
    take_unit(file, unit, says.metres_per_unit ? From::file : From::usual);
    if (says.metres_per_unit && file.joints() >= kCrowd && !(size * unit < kWidest_m && size * unit > kNarrowest_m)) {
      fail_unit(file, "points that spread over " + show(size * unit) + " m in the file's " + unit_name(unit));
    }
    if (!says.metres_per_unit && unit != 1.0) {
      add_note(file.note, "The unit is taken to be " + file.guess.unit + ".");
    }
    return;
  }
  const std::optional<Unit> fitting = file.joints() >= kCrowd ? guess_unit(size) : std::nullopt;
  if (!fitting) fail_unit(file, "points that spread over " + show(size) + " units");
  take_unit(file, fitting->metres, From::data);
  add_note(file.note, "The unit is taken to be " + file.guess.unit + ", from the spread of the points.");
}

Vec3 axis_vector(const std::string& axis) {
  Vec3 vector(0.0);
  vector[axis_index(axis.back())] = axis.front() == '-' ? -1.0 : 1.0;
  return vector;
}

/// Horizontal and forward at the first frame that shows hips and ankles, z up; zero when none does.
Vec3 first_heading(const MotionFile& file, const JointSources& body) {
  const auto point = [&](std::size_t frame, Joint joint) { return plain_mean(file, frame, body[index(joint)].points); };
  for (std::size_t frame = 0; frame < file.frames(); ++frame) {
    const Vec3 across =
        point(frame, right_hip) - point(frame, left_hip) + point(frame, right_shoulder) - point(frame, left_shoulder);
    const Vec3 ahead = glm::cross(Vec3(0.0, 0.0, 1.0), across);
    if (is_finite(ahead) && glm::length(ahead) > 0.0) return glm::normalize(ahead);
  }
  return Vec3(0.0);
}

/// How far ankle to ball points ahead as the hips face, as a part of its length, over all frames: 1 for feet straight
/// ahead, negative when they point backwards. NaN without feet.
double toes_ahead(const MotionFile& file, const JointSources& body) {
  const auto point = [&](std::size_t frame, Joint joint) { return plain_mean(file, frame, body[index(joint)].points); };
  double ahead = 0.0, length = 0.0;
  for (std::size_t frame = 0; frame < file.frames(); ++frame) {
    const Vec3 right = point(frame, right_hip) - point(frame, left_hip);
    const Vec3 heading = glm::normalize(glm::cross(Vec3(0.0, 0.0, 1.0), right));
    for (const auto& [ankle, ball] : {std::pair{left_ankle, left_ball}, {right_ankle, right_ball}}) {
      const Vec3 foot = point(frame, ball) - point(frame, ankle);
      if (!is_finite(foot) || !is_finite(heading)) continue;
      ahead += glm::dot(heading, foot);
      length += glm::length(foot);
    }
  }
  return ahead / length;
}

void settle_facing(const MotionFileOptions& options, const std::optional<JointSources>& body, MotionFile& file) {
  Guess& guess = file.guess;
  if (body && first_heading(file, *body) != Vec3(0.0)) {
    const Vec3 heading = first_heading(file, *body);
    double best = -1.0;
    for (const std::string axis : {"x", "y", "z", "-x", "-y", "-z"}) {
      const double along = glm::dot(to_z_up(axis_vector(axis), guess.up), heading);
      if (along <= best) continue;
      best = along;
      guess.facing = axis;
    }
    guess.facing_from = From::data;
    if (toes_ahead(file, *body) < kToesBackwards) {
      add_note(file.note,
               "The toes point the other way than the hips: left and right are exchanged, or up is upside down.");
    }
  }
  if (!options.facing) return;
  guess.facing = *options.facing;
  guess.facing_from = From::argument;
  const Vec3 ahead = to_z_up(axis_vector(*options.facing), guess.up);
  if (std::abs(ahead.z) > 0.5) {
    throw std::invalid_argument("facing must be a horizontal axis of the file, not '" + *options.facing +
                                "' where up is '" + guess.up + "'");
  }
  for (Vec3& p : file.positions) p = {ahead.y * p.x - ahead.x * p.y, ahead.x * p.x + ahead.y * p.y, p.z};
}

}  // namespace

void settle(const MotionFileOptions& options, const FileSays& says, MotionFile& file) {
  const JointMap* map = best_joint_map(file);
  const std::optional<JointSources> body = map ? std::optional(find_sources(file, *map)) : std::nullopt;
  const double stature = body ? stature_in_units(file, *body) : kMissing;
  const double height = says.skeleton_height.value_or(stature);
  if (options.metres_per_unit) {
    take_unit(file, *options.metres_per_unit, From::argument);
  } else if (height > 0.0) {
    settle_unit_of_person(says, height, file);
  } else {
    settle_unit_of_crowd(says, file);
  }
  settle_up(options, says, body, file);
  for (Vec3& point : file.positions) point = to_z_up(point, file.guess.up) * file.guess.metres_per_unit;
  settle_facing(options, body, file);
  file.guess.stature_m = stature * file.guess.metres_per_unit;
}

void settle_rate(const MotionFileOptions& options, std::optional<double> stated_hz, MotionFile& file) {
  constexpr double lowest_hz = 1e-3, highest_hz = 1e6;
  file.guess.rate_from = options.rate_hz ? From::argument : From::file;
  if (options.rate_hz) stated_hz = options.rate_hz;
  if (!stated_hz) throw std::invalid_argument(file.source + ": the file states no frame rate; give rate");
  if (!(*stated_hz >= lowest_hz && *stated_hz <= highest_hz)) {
    throw std::invalid_argument(file.source + ": the frame rate must be 0.001 to 1e6 Hz, not " + show(*stated_hz) +
                                "; give rate");
  }
  file.guess.rate_hz = file.rate_hz = *stated_hz;
}

std::optional<double> metres_of_unit(std::string_view word) {
  struct Word {
    std::string_view word;
    double metres;
  };
  constexpr std::array<Word, 22> words{{{"mm", 0.001},
                                        {"millimeter", 0.001},
                                        {"millimeters", 0.001},
                                        {"millimetre", 0.001},
                                        {"millimetres", 0.001},
                                        {"cm", 0.01},
                                        {"centimeter", 0.01},
                                        {"centimeters", 0.01},
                                        {"centimetre", 0.01},
                                        {"centimetres", 0.01},
                                        {"m", 1.0},
                                        {"meter", 1.0},
                                        {"meters", 1.0},
                                        {"metre", 1.0},
                                        {"metres", 1.0},
                                        {"in", 0.0254},
                                        {"inch", 0.0254},
                                        {"inches", 0.0254},
                                        {"ft", 0.3048},
                                        {"foot", 0.3048},
                                        {"feet", 0.3048},
                                        {"dm", 0.1}}};
  for (const Word& known : words) {
    if (equal_ignoring_case(word, known.word)) return known.metres;
  }
  return std::nullopt;
}

const char* name_of(From from) {
  constexpr std::array names{"argument", "file", "data", "usual", "unknown"};
  return names.at(static_cast<std::size_t>(from));
}

std::string Guess::summary() const {
  const auto with = [](const std::string& text, From from) { return text + " (" + name_of(from) + ')'; };
  std::string text = with(unit, unit_from) + ", up " + with(up, up_from) + ", facing " +
                     with(facing.empty() ? "unknown" : facing, facing_from) + ", " +
                     with(show(rate_hz) + " Hz", rate_from);
  if (std::isfinite(stature_m)) text += ", stature " + show(std::round(stature_m * 100.0) / 100.0) + " m";
  return text;
}

}  // namespace reachcast
