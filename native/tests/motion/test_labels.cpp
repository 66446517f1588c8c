// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "made_session.hpp"
#include "reachcast/motion/labels.hpp"

namespace reachcast {
namespace {

using namespace tests;

std::string refusal_of(const std::string& table) {
  try {
    (void)parse_labels(table, "labels.csv");
  } catch (const std::invalid_argument& refusal) {
    return refusal.what();
  }
  return {};
}

void expect_refused(const std::string& table, const std::string& because) {
  EXPECT_NE(refusal_of(table).find(because), std::string::npos) << refusal_of(table);
}

TEST(Labels, EveryColumnIsRead) {
  const auto labels = parse_labels(
      "\xEF\xBB\xBF"
      "file;Subject;stature_m;sex;age;mass_kg;phase;first;last;start_s;end_s;object;grasp_frame;lift_off_frame\r\n"
      "\"a;b.bvh\";\"says \"\"hi\"\"\";1.7;F;33;61.5;transfer;10;80;;;crate;8;10\r\n"
      "c.bvh;;;;;;return;;;1.5;2.25;;;\r\n"
      ";;;;;;;;;;;;;\r\n",
      "labels.csv");
  ASSERT_EQ(labels.size(), 2u);
  EXPECT_EQ(labels[0].file, "a;b.bvh");
  EXPECT_EQ(labels[0].subject, "says \"hi\"");
  EXPECT_EQ(labels[0].stature_m, 1.7);
  EXPECT_EQ(labels[0].sex, Sex::female);
  EXPECT_EQ(labels[0].age_years, 33.0);
  EXPECT_EQ(labels[0].mass_kg, 61.5);
  EXPECT_EQ(labels[0].phase, Phase::transfer);
  EXPECT_EQ(labels[0].first, 10u);
  EXPECT_EQ(labels[0].last, 80u);
  EXPECT_EQ(labels[0].object, "crate");
  ASSERT_EQ(labels[0].events.size(), 2u);
  EXPECT_EQ(labels[0].events[1].name, "lift-off");
  EXPECT_EQ(labels[1].line, 3u);
  EXPECT_FALSE(labels[1].subject || labels[1].stature_m || labels[1].sex || labels[1].object || labels[1].first);
  const Session session = made_session({still(4.0)}, 100.0);
  EXPECT_EQ(labels[1].frames(session.clip).first, 150u);
  EXPECT_EQ(labels[1].frames(session.clip).last, 225u);
}

TEST(Labels, SeparatorsAndLineEndsDoNotMatter) {
  const std::string commas = "file,phase,first,last\na.bvh,reach,1,20\n";
  const std::string text = parse_labels(commas, "t").front().text();
  for (const auto& [separator, end] : {std::pair{";", "\n"}, {"\t", "\r\n"}, {",", "\r"}}) {
    std::string table;
    for (const char c : commas) table += c == ',' ? separator : c == '\n' ? end : std::string(1, c);
    ASSERT_EQ(parse_labels(table, "t").size(), 1u);
    EXPECT_EQ(parse_labels(table, "t").front().text(), text);
  }
}

TEST(Labels, MistakesAreNamedWithRowAndLimit) {
  expect_refused("file,phase,first,last,colour\n", "column 'colour' is not known");
  expect_refused("file,first,last\n", "column 'phase' is missing");
  expect_refused("file,phase\n", "'first' and 'last', or 'start_s' and 'end_s', are missing");
  expect_refused("file,phase,first,last,stature_m\n\na,reach,1,9,17\n",
                 "labels.csv:3: stature_m must be a number from 0.5 to 2.6, not '17'");
  expect_refused("file,phase,first,last\na,grab,1,9\n",
                 "labels.csv:2: phase must be transfer, return, reach or retrieve, not 'grab'");
  expect_refused("file,phase,first,last\na,reach,9,9\n", "labels.csv:2: last must be after first, frame 9, not 9");
  expect_refused("file,phase,first,last\na,reach,1.5,9\n", "first must be a whole frame, not 1.5");
  expect_refused("file,phase,first,last\na,reach,nan,9\n", "first must be a number from 0 to");
  expect_refused("file,phase,first,last\na,reach,,9\n", "one of first and last is empty");
  expect_refused("file,phase,first,last,sex\na,reach,1,9,x\n", "sex must be female, male, f or m, not 'x'");
  expect_refused("file,phase,first,last\n,reach,1,9\n", "file is empty");
  expect_refused("file,phase,first,last\na,reach,1\n", "4 cells");
  expect_refused("file,phase,first,last\n\"a,reach,1,9\n", "every quote closed");
  expect_refused("file,phase,first,last,first\n", "every column name once");
  expect_refused("", "a line of column names");
}

TEST(Labels, LabelledPhasesAreThoseThatWereMade) {
  const Session session = made_session(there_and_back());
  std::string table = "file,stature_m,phase,start_s,end_s\n";
  for (const auto& truth : session.truths) {
    table +=
        "made,1.75," + truth.phase + "," + std::to_string(truth.start_s) + "," + std::to_string(truth.end_s) + "\n";
  }
  const FoundReaches found =
      cut_labelled(session.clip, parse_labels(table, "t"), {}, nullptr, {}, {session.object, {}, ""});
  ASSERT_EQ(found.reaches.size(), session.truths.size());
  for (std::size_t i = 0; i < found.reaches.size(); ++i) {
    EXPECT_EQ(phase_name(found.reaches[i].phase), session.truths[i].phase);
    EXPECT_NEAR(found.reaches[i].duration_s, session.truths[i].end_s - session.truths[i].start_s, 1.0 / 60.0);
    EXPECT_EQ(found.reaches[i].subject.stature_m, 1.75);
  }
}

TEST(Labels, RowsThatCannotBeCutAreRejectedOneByOne) {
  const Session session = made_session(there_and_back());
  const auto labels = parse_labels(
      "file,stature_m,phase,first,last\n"
      "made,1.75,reach,40,105\n"
      "made,,reach,40,105\n"
      "made,1.75,reach,40,99999\n"
      "made,1.75,transfer,0,30\n",
      "labels.csv");
  const FoundReaches found = cut_labelled(session.clip, labels, std::nullopt);
  EXPECT_EQ(found.reaches.size(), 1u);
  ASSERT_EQ(found.rejections.size(), 3u);
  EXPECT_EQ(found.rejections[0].reason, "labels.csv:3: the stature of the person is not known");
  EXPECT_NE(found.rejections[1].reason.find("labels.csv:4: frames 40 to 99999 do not lie within"), std::string::npos);
  EXPECT_NE(found.rejections[2].reason.find("the hands come only"), std::string::npos);
}

}  // namespace
}  // namespace reachcast
