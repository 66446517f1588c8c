// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "made_session.hpp"

namespace reachcast {
namespace {

using namespace tests;

const Subject kPerson{1.75, {}, {}, {}};
// smooth_step is below a tenth of its peak speed for 0.09 of a move at either end, and has gone 1 cm after 0.12 of it;
// moves last up to 1.4 s, and a frame up to 0.03 s.
constexpr double kTolerance_s = 0.25;

Evidence with_object(const Session& session) {
  return {session.object, {}, "made"};
}

std::vector<std::string> phases_of(const FoundReaches& found) {
  std::vector<std::string> phases;
  for (const Reach& reach : found.reaches) phases.emplace_back(phase_name(reach.phase));
  return phases;
}

std::vector<std::string> phases_of(const Session& session) {
  std::vector<std::string> phases;
  for (const auto& truth : session.truths) phases.push_back(truth.phase);
  return phases;
}

std::string reasons_of(const FoundReaches& found) {
  std::string text;
  for (const Rejection& r : found.rejections) text += r.what + ": " + r.reason + "\n";
  return text;
}

void expect_as_made(const FoundReaches& found, const Session& session) {
  ASSERT_EQ(phases_of(found), phases_of(session)) << reasons_of(found);
  EXPECT_EQ(found.rejections.size(), 0u) << reasons_of(found);
  for (std::size_t i = 0; i < found.frames.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(found.frames[i].first) / session.clip.rate_hz, session.truths[i].start_s,
                kTolerance_s);
    EXPECT_NEAR(static_cast<double>(found.frames[i].last) / session.clip.rate_hz, session.truths[i].end_s,
                kTolerance_s);
  }
}

std::size_t frame_at(const Session& session, double seconds) {
  return static_cast<std::size_t>(std::lround(seconds * session.clip.rate_hz));
}

class AtRate : public testing::TestWithParam<double> {};

TEST_P(AtRate, PhasesAreFoundWhereTheyWereMadeWithAnObject) {
  const Session session = made_session(there_and_back(), GetParam());
  expect_as_made(find_reaches(session.clip, kPerson, {}, with_object(session)), session);
}

TEST_P(AtRate, TheHandsTellTheSameWithoutAnObject) {
  const Session session = made_session(there_and_back(), GetParam());
  expect_as_made(find_reaches(session.clip, kPerson), session);
}

INSTANTIATE_TEST_SUITE_P(Rates, AtRate, testing::Values(30.0, 60.0, 120.0));

TEST(FindReaches, EventsComeInOrderAtTheirFrames) {
  const Session session = made_session(there_and_back());
  const FoundReaches found = find_reaches(session.clip, kPerson, {}, with_object(session));
  const std::vector<std::string> names{"grasp", "lift-off", "placed", "release"};
  ASSERT_EQ(found.events.size(), 8u);
  const std::vector<double> seconds{1.8, 2.2, 3.6, 4.0, 7.1, 7.5, 8.9, 9.3};
  for (std::size_t i = 0; i < found.events.size(); ++i) {
    EXPECT_EQ(found.events[i].name, names[i % 4]);
    EXPECT_NEAR(static_cast<double>(found.events[i].frame) / session.clip.rate_hz, seconds[i], 0.35) << i;
    if (i == 0) continue;
    EXPECT_GE(found.events[i].frame, found.events[i - 1].frame);
  }
}

TEST(FindReaches, SlowerPeopleGiveTheSamePhases) {
  std::vector<Stage> stages = there_and_back();
  for (Stage& stage : stages) stage.seconds *= 1.5;
  const Session session = made_session(stages);
  for (const Evidence& evidence : {with_object(session), Evidence{}}) {
    const FoundReaches found = find_reaches(session.clip, kPerson, {}, evidence);
    EXPECT_EQ(phases_of(found), phases_of(session)) << reasons_of(found);
  }
}

TEST(FindReaches, TheMirrorImageGivesTheMirrorImages) {
  const Session session = made_session(there_and_back());
  Session image = session;
  for (std::size_t f = 0; f < session.clip.frames(); ++f) {
    image.object.positions[f].x *= -1.0;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      Vec3 point = session.clip.at(f, j);
      point.x *= -1.0;
      image.clip.at(f, index(mirrored(static_cast<Joint>(j)))) = point;
    }
  }
  const FoundReaches found = find_reaches(session.clip, kPerson, {}, with_object(session));
  const FoundReaches seen = find_reaches(image.clip, kPerson, {}, with_object(image));
  ASSERT_EQ(phases_of(seen), phases_of(found));
  for (std::size_t i = 0; i < found.reaches.size(); ++i) {
    EXPECT_EQ(seen.frames[i].first, found.frames[i].first);
    EXPECT_EQ(seen.frames[i].last, found.frames[i].last);
    const Vec3 apart = seen.reaches[i].hold_point(3) - mirrored(found.reaches[i]).hold_point(3);
    EXPECT_LT(glm::length(apart), 1e-9);
  }
}

TEST(FindReaches, OnlyALongPauseMakesTwoWays) {
  const auto carried = [](double pause_s) {
    return made_session({still(0.6),
                         {"reach", 1.2, false, kHome},
                         still(0.4),
                         {"transfer", 1.2, false, kHalfway},
                         still(pause_s),
                         {"transfer", 1.2, false, kShelf},
                         still(0.4),
                         {"return", 1.2, true, {}},
                         still(0.5)});
  };
  const auto transfers = [](const Session& session, const FindOptions& options, const Evidence& evidence) {
    const FoundReaches found = find_reaches(session.clip, kPerson, options, evidence);
    SCOPED_TRACE(reasons_of(found));
    const std::vector<std::string> phases = phases_of(found);
    if (!found.rejections.empty()) ADD_FAILURE();
    return std::count(phases.begin(), phases.end(), "transfer");
  };
  const Session pausing = carried(0.8);
  for (const Evidence& evidence : {with_object(pausing), Evidence{}}) {
    EXPECT_EQ(transfers(pausing, {}, evidence), 2);
    FindOptions patient;
    patient.pause_s = 2.0;
    EXPECT_EQ(transfers(pausing, patient, evidence), 1);
  }
}

TEST(FindReaches, AFaultRejectsOnlyItsPhase) {
  const Session session = made_session(there_and_back());
  Evidence evidence = with_object(session);
  const std::size_t frame = frame_at(session, 2.9);  // in the transfer
  evidence.faults = {{"left_elbow", frame, frame + 3, "jumps 0.31 m"}};
  const FoundReaches found = find_reaches(session.clip, kPerson, {}, evidence);
  EXPECT_EQ(phases_of(found), (std::vector<std::string>{"reach", "return", "reach", "retrieve", "return"}));
  ASSERT_EQ(found.rejections.size(), 1u);
  EXPECT_EQ(found.rejections[0].what, "transfer");
  EXPECT_NE(found.rejections[0].reason.find("left_elbow jumps 0.31 m"), std::string::npos);
}

TEST(FindReaches, ALongFilledGapRejectsOnlyItsPhase) {
  Session session = made_session(there_and_back());
  session.clip.filled.assign(session.clip.positions.size(), 0);
  const std::size_t from = frame_at(session, 2.7);
  for (std::size_t f = from; f < from + 20; ++f) session.clip.filled[f * kJointCount + index(Joint::left_knee)] = 1;
  const FoundReaches found = find_reaches(session.clip, kPerson, {}, with_object(session));
  EXPECT_EQ(found.reaches.size(), 5u);
  ASSERT_EQ(found.rejections.size(), 1u);
  EXPECT_NE(found.rejections[0].reason.find("left_knee was not recorded"), std::string::npos);
  FindOptions generous;
  generous.longest_filled_s = 0.5;
  EXPECT_EQ(find_reaches(session.clip, kPerson, generous, with_object(session)).reaches.size(), 6u);
}

TEST(FindReaches, AMissingJointRejectsOnlyItsPhase) {
  Session session = made_session(there_and_back());
  const std::size_t from = frame_at(session, 2.7);
  for (std::size_t f = from; f < from + 20; ++f) session.clip.at(f, index(Joint::right_knee)) = Vec3(kMissing);
  const FoundReaches found = find_reaches(session.clip, kPerson, {}, with_object(session));
  EXPECT_EQ(found.reaches.size(), 5u);
  ASSERT_EQ(found.rejections.size(), 1u);
  EXPECT_NE(found.rejections[0].reason.find("right_knee is missing"), std::string::npos);
}

TEST(FindReaches, AStepInTheMiddleIsRejectedWithTheFootAndItsFrame) {
  Session session = made_session(there_and_back());
  const std::size_t step = frame_at(session, 2.85);
  for (std::size_t f = step; f < session.clip.frames(); ++f) {
    session.clip.at(f, index(Joint::left_ball)).y += 0.2;
    session.clip.at(f, index(Joint::left_ankle)).y += 0.2;
  }
  const FoundReaches found = find_reaches(session.clip, kPerson, {}, with_object(session));
  const std::string reasons = reasons_of(found);
  EXPECT_NE(reasons.find("the left foot steps in frame " + std::to_string(step)), std::string::npos) << reasons;
  for (const FrameRange& range : found.frames) EXPECT_FALSE(range.first < step && range.last >= step);
}

TEST(FindReaches, AHandOffTheObjectIsRejected) {
  Session session = made_session(there_and_back());
  for (std::size_t f = frame_at(session, 2.8); f < frame_at(session, 3.0); ++f) {
    session.clip.at(f, index(Joint::left_grip)).x -= 0.2;
  }
  const std::string reasons = reasons_of(find_reaches(session.clip, kPerson, {}, with_object(session)));
  EXPECT_NE(reasons.find("the left hand is not on the object"), std::string::npos) << reasons;
}

TEST(FindReaches, StandingStillGivesOneRejectionOfTheRecording) {
  const Session session = made_session({still(3.0)});
  const FoundReaches by_hands = find_reaches(session.clip, kPerson);
  const FoundReaches by_object = find_reaches(session.clip, kPerson, {}, with_object(session));
  for (const FoundReaches& found : {by_hands, by_object}) {
    EXPECT_TRUE(found.reaches.empty());
    ASSERT_EQ(found.rejections.size(), 1u);
    EXPECT_EQ(found.rejections[0].what, "recording");
    EXPECT_EQ(found.rejections[0].last, session.clip.frames() - 1);
  }
  EXPECT_EQ(by_hands.rejections[0].reason, "the hands stand still throughout");
  EXPECT_NE(by_object.rejections[0].reason.find("'box' is never carried"), std::string::npos);
}

TEST(FindReaches, RecordingsWithoutHandsOrOfOneFrameAreOneRejection) {
  Session session = made_session(there_and_back());
  for (std::size_t f = 0; f < session.clip.frames(); ++f) session.clip.at(f, index(Joint::left_grip)) = Vec3(kMissing);
  const FoundReaches found = find_reaches(session.clip, kPerson);
  ASSERT_EQ(found.rejections.size(), 1u);
  EXPECT_EQ(found.rejections[0].reason, "left_grip is missing in all frames");
  Session one = made_session({still(0.5 / 60.0)});
  ASSERT_EQ(one.clip.frames(), 1u);
  EXPECT_EQ(find_reaches(one.clip, kPerson).rejections.size(), 1u);
  EXPECT_EQ(find_reaches(one.clip, kPerson, {}, with_object(one)).rejections.size(), 1u);
}

TEST(FindReaches, WrongCallsAreNamed) {
  Session session = made_session(there_and_back());
  EXPECT_THROW((void)find_reaches(session.clip, Subject{3.0, {}, {}, {}}), std::invalid_argument);
  FindOptions options;
  options.pause_s = -1.0;
  EXPECT_THROW((void)find_reaches(session.clip, kPerson, options), std::invalid_argument);
  EXPECT_THROW((void)object_track(session.clip, "crate"), std::invalid_argument);
  EXPECT_FALSE(object_track(session.clip).has_value());
  session.object.positions.pop_back();
  EXPECT_THROW((void)find_reaches(session.clip, kPerson, {}, with_object(session)), std::invalid_argument);
}

}  // namespace
}  // namespace reachcast
