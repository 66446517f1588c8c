// SPDX-License-Identifier: GPL-3.0-or-later
#include "rows.hpp"

#include <bit>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "compact.hpp"
#include "reachcast/motion/encode.hpp"
#include "reachcast/motion/mirror_code.hpp"

namespace reachcast::rows {

namespace {

enum Column {
  kId,
  kSubject,
  kStature,
  kSex,
  kAge,
  kMass,
  kPhase,
  kHands,
  kOrigin,
  kMirrored,
  kDuration,
  kHome,
  kTarget = kHome + 3,
  kGripDistance = kTarget + 3,
  kData,
  kOriginal,
  kOriginalData,
};

[[noreturn]] void damaged(const sqlite::Statement& row, const std::string& what) {
  throw std::runtime_error("motion " + std::to_string(row.integer(kId)) + " " + what);
}

double finite(const sqlite::Statement& row, int column, const char* name) {
  const double value = row.real(column);
  if (row.is_null(column) || !std::isfinite(value)) {
    damaged(row, std::string("has ") + (row.is_null(column) ? "no" : "an infinite") + " " + name);
  }
  return value;
}

std::optional<double> optional_finite(const sqlite::Statement& row, int column, const char* name) {
  if (row.is_null(column)) return std::nullopt;
  return finite(row, column, name);
}

Vec3 finite_point(const sqlite::Statement& row, int column, const char* name) {
  return {finite(row, column, name), finite(row, column + 1, name), finite(row, column + 2, name)};
}

Subject read_subject(const sqlite::Statement& row) {
  Subject subject;
  subject.stature_m = finite(row, kStature, "stature");
  if (!row.is_null(kSex)) subject.sex = row.text(kSex) == "female" ? Sex::female : Sex::male;
  subject.age_years = optional_finite(row, kAge, "age");
  subject.mass_kg = optional_finite(row, kMass, "mass");
  return subject;
}

Eigen::VectorXd read_compact(const sqlite::Statement& row, std::int64_t code_length) {
  const auto count = static_cast<Eigen::Index>(code_length);
  Eigen::VectorXd base;
  try {
    if (!row.is_null(kOriginal)) {
      if (count != reachcast::code_length()) throw std::runtime_error("has an original of another version");
      base = mirror_image(compact::unpack(row.blob(kOriginalData), count, {}));
    }
    return compact::unpack(row.blob(kData), count, base);
  } catch (const std::runtime_error& error) {
    damaged(row, error.what());
  }
}

Eigen::VectorXd read_exact(const sqlite::Statement& row, std::int64_t code_length) {
  const std::span<const std::byte> bytes = row.blob(kData);
  if (std::cmp_not_equal(bytes.size(), 8 * code_length)) {
    damaged(row, "has " + std::to_string(bytes.size()) + " bytes of coefficients, expected " +
                     std::to_string(8 * code_length));
  }
  Eigen::VectorXd coefficients(code_length);
  for (std::size_t i = 0; i < bytes.size(); i += 8) {
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < 8; ++k) bits |= std::to_integer<std::uint64_t>(bytes[i + k]) << (8 * k);
    coefficients[static_cast<Eigen::Index>(i / 8)] = std::bit_cast<double>(bits);
  }
  if (!coefficients.allFinite()) damaged(row, "has a coefficient that is not finite");
  return coefficients;
}

std::string number_complaint(const char* name, double value, bool zero_is_legal) {
  if (std::isfinite(value) && (value > 0.0 || (zero_is_legal && value == 0.0))) return "";
  return std::string(name) + " is " + std::to_string(value) + ", expected a finite number " +
         (zero_is_legal ? ">= 0" : "> 0");
}

std::optional<std::string_view> sex_name(const std::optional<Sex>& sex) {
  if (!sex) return std::nullopt;
  return *sex == Sex::female ? "female" : "male";
}

}  // namespace

std::string select(bool with_coefficients, const std::string& condition) {
  // Outer joins keep a motion whose subject or source is gone, so that it is reported and not skipped.
  return std::string(
             "SELECT m.id, m.subject, s.stature_m, s.sex, s.age_years, s.mass_kg, m.phase, m.hands, o.origin, m.mirrored,"
             " m.duration_s, m.home_x, m.home_y, m.home_z, m.target_x, m.target_y, m.target_z, m.grip_distance_m") +
         (with_coefficients ? ", c.data, c.original, d.data" : "") +
         " FROM motions m LEFT JOIN subjects s ON s.id = m.subject LEFT JOIN clips o ON o.id = m.clip" +
         (with_coefficients ? " LEFT JOIN codes c ON c.motion = m.id LEFT JOIN codes d ON d.motion = c.original "
                            : " ") +
         condition + " ORDER BY m.id";
}

Format format_of(sqlite::Connection& connection) {
  Format format;
  format.code_length = connection.integer("SELECT CAST(value AS INTEGER) FROM meta WHERE key = 'code_length'");
  const std::int64_t is_compact =
      connection.integer("SELECT count(*) FROM meta WHERE key = 'precision' AND value = 'compact'");
  format.precision = is_compact != 0 ? Precision::compact : Precision::exact;
  return format;
}

std::string complaint(const MotionCode& code, Precision precision) {
  if (code.origin.empty()) return "origin is empty, expected the file and frames that identify the motion";
  if (!is_finite(code.home)) return "home is not finite";
  if (!is_finite(code.target)) return "target is not finite";
  if (code.coefficients.size() == 0) return "coefficients is empty, expected at least 1 value";
  for (Eigen::Index i = 0; i < code.coefficients.size(); ++i) {
    const double value = code.coefficients[i];
    if (std::isfinite(value) && (precision == Precision::exact || std::abs(value) <= compact::kLargest)) continue;
    if (std::isfinite(value)) {
      return "coefficients[" + std::to_string(i) + "] is " + std::to_string(value) +
             ", a compact corpus holds no value beyond " + std::to_string(compact::kLargest);
    }
    return "coefficients[" + std::to_string(i) + "] is " + std::to_string(code.coefficients[i]) +
           ", expected a finite number";
  }
  std::string found = number_complaint("duration_s", code.duration_s, false);
  if (found.empty()) found = number_complaint("grip_distance_m", code.grip_distance_m, true);
  if (found.empty()) found = number_complaint("subject.stature_m", code.subject.stature_m, false);
  if (found.empty()) found = number_complaint("subject.age_years", code.subject.age_years.value_or(0.0), true);
  if (found.empty()) found = number_complaint("subject.mass_kg", code.subject.mass_kg.value_or(1.0), false);
  return found;
}

namespace {

/// Little-endian on every machine, eight bytes per number.
std::vector<std::byte> exact_blob(const Eigen::VectorXd& coefficients) {
  std::vector<std::byte> bytes(static_cast<std::size_t>(coefficients.size()) * 8);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto bits = std::bit_cast<std::uint64_t>(coefficients[static_cast<Eigen::Index>(i / 8)]);
    bytes[i] = static_cast<std::byte>((bits >> (8 * (i % 8))) & 0xFFU);
  }
  return bytes;
}

}  // namespace

MotionSummary read_summary(const sqlite::Statement& row) {
  MotionSummary motion;
  motion.id = row.integer(kId);
  motion.subject_id = row.integer(kSubject);
  motion.subject = read_subject(row);
  const std::optional<Phase> phase = find_phase(row.text(kPhase));
  if (!phase) damaged(row, "has the unknown phase '" + std::string(row.text(kPhase)) + "'");
  motion.phase = *phase;
  const std::optional<Hands> hands = find_hands(row.text(kHands));
  if (!hands) damaged(row, "has the unknown hands '" + std::string(row.text(kHands)) + "'");
  motion.hands = *hands;
  if (row.is_null(kOrigin)) damaged(row, "has no origin");
  motion.origin = row.text(kOrigin);
  motion.is_mirrored = row.integer(kMirrored) != 0;
  motion.duration_s = finite(row, kDuration, "duration");
  motion.home = finite_point(row, kHome, "home");
  motion.target = finite_point(row, kTarget, "target");
  motion.grip_distance_m = finite(row, kGripDistance, "grip distance");
  return motion;
}

StoredMotion read_motion(const sqlite::Statement& row, const Format& format) {
  MotionSummary summary = read_summary(row);
  MotionCode code;
  code.subject = summary.subject;
  code.phase = summary.phase;
  code.hands = summary.hands;
  code.origin = std::move(summary.origin);
  code.is_mirrored = summary.is_mirrored;
  code.duration_s = summary.duration_s;
  code.home = summary.home;
  code.target = summary.target;
  code.grip_distance_m = summary.grip_distance_m;
  code.coefficients = format.precision == Precision::compact ? read_compact(row, format.code_length)
                                                             : read_exact(row, format.code_length);
  return {summary.id, std::move(code)};
}

Writer::Writer(sqlite::Connection& connection, const Format& format, std::optional<std::int64_t> source)
    : connection_(connection),
      format_(format),
      source_(source),
      find_subject_(connection,
                    "SELECT id FROM subjects WHERE stature_m = ? AND sex IS ? AND age_years IS ? AND mass_kg IS ?"),
      insert_subject_(connection, "INSERT INTO subjects (stature_m, sex, age_years, mass_kg) VALUES (?, ?, ?, ?)"),
      find_clip_(connection, "SELECT id FROM clips WHERE origin = ?"),
      insert_clip_(connection, "INSERT INTO clips (origin, source) VALUES (?, ?)"),
      find_motion_(connection, "SELECT id FROM motions WHERE clip = ? AND mirrored = ? AND phase = ?"),
      insert_motion_(connection,
                     "INSERT INTO motions (clip, mirrored, phase, subject, duration_s, home_x, home_y, home_z,"
                     " target_x, target_y, target_z, grip_distance_m, hands) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
      insert_coefficients_(connection, "INSERT INTO codes (motion, data, original) VALUES (?, ?, ?)"),
      find_coefficients_(connection, "SELECT data FROM codes WHERE motion = ? AND original IS NULL") {}

namespace {

/// The id that `find` yields; if it yields none, runs `insert` with the same parameters and takes the new id.
template <typename Bind>
std::int64_t find_or_insert(sqlite::Connection& connection, sqlite::Statement& find, sqlite::Statement& insert,
                            const Bind& bind) {
  bind(find);
  const bool found = find.step();
  const std::int64_t id = found ? find.integer(0) : 0;
  find.reset();
  if (found) return id;
  bind(insert);
  insert.run();
  return connection.last_id();
}

}  // namespace

std::int64_t Writer::subject_id(const Subject& subject) {
  return find_or_insert(connection_, find_subject_, insert_subject_, [&](sqlite::Statement& statement) {
    statement.bind(1, subject.stature_m);
    statement.bind(2, sex_name(subject.sex));
    statement.bind(3, subject.age_years);
    statement.bind(4, subject.mass_kg);
  });
}

std::int64_t Writer::clip_id(const std::string& origin) {
  find_clip_.bind(1, std::string_view(origin));
  const std::int64_t id = find_clip_.step() ? find_clip_.integer(0) : 0;
  find_clip_.reset();
  if (id != 0) return id;
  insert_clip_.bind(1, std::string_view(origin));
  insert_clip_.bind(2, source_);
  insert_clip_.run();
  return connection_.last_id();
}

std::int64_t Writer::add(const MotionCode& code) {
  const std::int64_t clip = clip_id(code.origin);
  const std::int64_t id = find_motion(clip, code.is_mirrored, code.phase);
  return id != 0 ? id : insert(code, clip);
}

std::int64_t Writer::find_motion(std::int64_t clip, bool mirrored, Phase phase) {
  find_motion_.bind(1, clip);
  find_motion_.bind(2, std::int64_t{mirrored});
  find_motion_.bind(3, phase_name(phase));
  const std::int64_t id = find_motion_.step() ? find_motion_.integer(0) : 0;
  find_motion_.reset();
  return id;
}

std::int64_t Writer::original_of(const MotionCode& code, std::int64_t clip) {
  const bool may_have_one =
      format_.precision == Precision::compact && code.is_mirrored && code.coefficients.size() == code_length();
  return may_have_one ? find_motion(clip, false, code.phase) : 0;
}

std::vector<std::byte> Writer::to_blob(const MotionCode& code, std::int64_t original) {
  if (format_.precision == Precision::exact) return exact_blob(code.coefficients);
  const Eigen::VectorXd coefficients = compact::rounded(code.coefficients);
  if (original == 0) return compact::pack(coefficients, {});
  find_coefficients_.bind(1, original);
  if (!find_coefficients_.step())
    throw std::runtime_error("motion " + std::to_string(original) + " has no coefficients");
  const Eigen::VectorXd base = mirror_image(compact::unpack(find_coefficients_.blob(0), code.coefficients.size(), {}));
  find_coefficients_.reset();
  return compact::pack(coefficients, base);
}

std::int64_t Writer::insert(const MotionCode& code, std::int64_t clip) {
  insert_motion_.bind(1, clip);
  insert_motion_.bind(2, std::int64_t{code.is_mirrored});
  insert_motion_.bind(3, phase_name(code.phase));
  insert_motion_.bind(4, subject_id(code.subject));
  insert_motion_.bind(5, code.duration_s);
  for (int axis = 0; axis < 3; ++axis) {
    insert_motion_.bind(6 + axis, code.home[axis]);
    insert_motion_.bind(9 + axis, code.target[axis]);
  }
  insert_motion_.bind(12, code.grip_distance_m);
  insert_motion_.bind(13, hands_name(code.hands));
  insert_motion_.run();
  const std::int64_t id = connection_.last_id();
  const std::int64_t original = original_of(code, clip);
  const std::vector<std::byte> data = to_blob(code, original);
  insert_coefficients_.bind(1, id);
  insert_coefficients_.bind(2, std::span<const std::byte>(data));
  insert_coefficients_.bind(3, original == 0 ? std::nullopt : std::optional(original));
  insert_coefficients_.run();
  return id;
}

}  // namespace reachcast::rows
