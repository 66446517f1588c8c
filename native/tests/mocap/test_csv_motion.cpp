// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <sstream>

#include "mocap_cases.hpp"
#include "reachcast/mocap/csv_motion.hpp"

namespace {

using namespace reachcast;
using namespace reachcast::test;

const std::string kTable =
    "frame,time_s,Hand_x,Hand_y,Hand_z,obj_x,obj_y,obj_z,obj_qx\n"
    "10,0.0,1,2,3,4,5,6,0.5\n"
    "11,0.1,1.5,,3,4,5,6,0.25\n"
    "12,0.2,2,2,3,4,5,6,\n";

MotionFile parse(const std::string& text, const MotionFileOptions& options = {}) {
  return parse_csv_motion(text, "hand.csv", options);
}

TEST(CsvMotion, TriplesArePointsAndTheRestChannels) {
  const MotionFile file = parse(kTable);
  EXPECT_EQ(file.names, (std::vector<std::string>{"Hand", "obj"}));
  EXPECT_EQ(file.at(0, 0), Vec3(1, 2, 3));
  EXPECT_EQ(file.at(2, 1), Vec3(4, 5, 6));
  EXPECT_EQ(file.channels.at("frame"), (std::vector<double>{10, 11, 12}));
  EXPECT_EQ(file.channels.at("obj_qx").at(1), 0.25);
  EXPECT_DOUBLE_EQ(file.rate_hz, 10.0);
  EXPECT_EQ(file.note, "");
}

TEST(CsvMotion, EmptyCellsAreMissing) {
  const MotionFile file = parse(kTable);
  EXPECT_FALSE(is_finite(file.at(1, 0)));
  EXPECT_TRUE(is_finite(file.at(1, 1)));
  EXPECT_TRUE(std::isnan(file.channels.at("obj_qx").at(2)));
}

TEST(CsvMotion, LineEndsBlanksAndQuotesDoNotMatter) {
  std::string text = "\n" + kTable;
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 3) text.replace(at, 1, "\r\n\n");
  text = replaced(replaced(text, "Hand_x", " \"Hand_x\" "), "1.5", " 1.5\t");
  EXPECT_EQ(parse(text).names, parse(kTable).names);
  EXPECT_EQ(parse(text).at(1, 0).x, 1.5);
}

TEST(CsvMotion, AnglesAreNoPointsAndIntervalsAreChosen) {
  const std::string text =
      "w_x,w_y,w_z,w_Angle_x,w_Angle_y,w_Angle_z,interval_label\n"
      "100,200,300,1,2,3,1\n110,200,300,1,2,3,1\n900,200,300,1,2,3,2\n";
  const MotionFile all = parse(text);
  EXPECT_EQ(all.names, std::vector<std::string>{"w"});
  EXPECT_EQ(all.frames(), 3U);
  EXPECT_DOUBLE_EQ(all.rate_hz, 100.0);
  EXPECT_DOUBLE_EQ(all.guess.metres_per_unit, 0.001);
  EXPECT_NE(all.note.find("100 Hz is assumed"), std::string::npos);
  MotionFileOptions second;
  second.interval = 2;
  EXPECT_EQ(parse(text, second).frames(), 1U);
  EXPECT_DOUBLE_EQ(parse(text, second).at(0, 0).x, 0.9);
  second.interval = 7;
  EXPECT_EQ(complaint([&] { (void)parse(text, second); }),
            "hand.csv: no row has interval_label 7; the labels run from 1 to 2");
}

TEST(CsvMotion, UpIsTakenFromShouldersAndAnkles) {
  const MotionFile file =
      parse("time_s,RSHO_x,RSHO_y,RSHO_z,RANK_x,RANK_y,RANK_z\n0,0,1.4,0.1,0,0.1,0.3\n1,0,1.4,0.1,0,0.1,0.3\n");
  EXPECT_EQ(file.guess.up, "y");
  EXPECT_EQ(file.at(0, 0), Vec3(0, -0.1, 1.4));
}

TEST(CsvMotion, MalformedTextIsAnsweredWithLineExpectedAndFound) {
  const auto answer = [](const std::string& from, const std::string& to) {
    return complaint([&] { (void)parse(replaced(kTable, from, to)); });
  };
  EXPECT_EQ(answer("1.5", "1,5"), "hand.csv:3: expected 9 cells, as in the first line, found 10");
  EXPECT_EQ(answer("0.25", "x"), "hand.csv:3: expected a number or nothing in column \"obj_qx\", found \"x\"");
  EXPECT_EQ(answer("1.5", "inf"), "hand.csv:3: expected a number or nothing in column \"Hand_x\", found \"inf\"");
  EXPECT_EQ(answer("obj_x", "Hand_x"), "hand.csv:1: expected every column name once, found \"Hand_x\"");
  EXPECT_EQ(answer("obj_x", ""), "hand.csv:1: expected a name for column 6, found an empty cell");
  EXPECT_EQ(answer("frame,", "12,"), "hand.csv:1: expected a name for column 1, found \"12\"");
  EXPECT_EQ(answer("time_s", "seconds"), "hand.csv: expected a column time_s or the option rate, found neither");
  EXPECT_NE(answer("0.2,", "0.9,").find("even steps of about 0.45 s, found 0 followed by 0.1"), std::string::npos);
  EXPECT_EQ(complaint([] { (void)parse("a,b\n1,2\n"); }),
            "hand.csv: expected columns named NAME_x, NAME_y and NAME_z, found no such three");
  EXPECT_EQ(complaint([] { (void)parse(""); }),
            "hand.csv:1: expected a line of column names, found the end of the file");
  EXPECT_EQ(complaint([] { (void)parse("a_x,a_y,a_z\n"); }),
            "hand.csv:2: expected at least one line of numbers, found none");
}

TEST(CsvMotion, DamagedTablesParseOrAreRefused) {
  const std::string interesting = ",,,0123456789.-e \r\n\"\0x\xff";
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) {
    std::string damaged = kTable;
    for (int change = 0; change <= i / 5000; ++change) {
      const std::size_t at = random() % damaged.size();
      if (random() % 3 == 0) damaged.erase(at, 1 + random() % 9);
      if (damaged.empty()) break;
      damaged[random() % damaged.size()] = interesting[random() % interesting.size()];
    }
    (void)complaint([&] { (void)parse(damaged); });
  }
}

TEST(CsvMotion, FourFormsOfRecordingsAreRead) {
  REACHCAST_NEED_MOCAP("omomo");
  const auto read = [](const std::string& name) { return read_motion((mocap_folder() / name).string()); };
  const MotionFile omomo = read("omomo/sub8_largebox_025.csv");
  EXPECT_EQ(omomo.guess.up, "z");
  EXPECT_NEAR(omomo.rate_hz, 30.0, 0.01);
  EXPECT_TRUE(omomo.find("obj") && omomo.channels.contains("obj_qw"));
  EXPECT_NEAR(read("lieblich_lifting/S1_dip1.csv").rate_hz, 60.0, 0.01);
  EXPECT_EQ(read("becanovic_box_lifting/trials/S1_SquatLifting_rep1_lift.csv").guess.up, "y");
  EXPECT_DOUBLE_EQ(read("roag_wall_reaching/p02_h_complete_data.csv").guess.metres_per_unit, 0.001);
}

}  // namespace
