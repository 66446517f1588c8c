// SPDX-License-Identifier: GPL-3.0-or-later
#include "reachcast/rig/rest_rig.hpp"

#include <gtest/gtest.h>

#include "rig/rig_cases.hpp"

namespace reachcast {
namespace {

using tests::made_rig;
using tests::RigParts;

/// The parts are refused in a sentence that holds all of `words`.
void expect_refused(const RigParts& parts, const std::vector<std::string>& words) {
  try {
    (void)parts.rig();
    ADD_FAILURE() << "was taken; it should have been refused for " << words.front();
  } catch (const std::invalid_argument& error) {
    for (const std::string& word : words) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what() << " lacks " << word;
    }
  }
}

TEST(RestRig, KeysMappedBonesAndAllAboveThem) {
  RigParts parts = made_rig();
  parts.bones.parents.push_back(static_cast<int>(parts.bones.parents.size()) - 1);  // a toe's tip, not mapped
  parts.bones.heads.push_back({0, 0, 0});
  parts.bones.rotations.push_back(Mat3(1.0));
  const RestRig rest = parts.rig();
  const int tip = static_cast<int>(parts.bones.parents.size()) - 1;
  EXPECT_EQ(rest.keyed().size(), parts.bones.parents.size() - 1);  // with the root and the bone in the trunk
  EXPECT_EQ(rest.slot(tip), RestRig::kNone);
  EXPECT_EQ(rest.slot(rest.bone(Segment::left_toe)), rest.bone(Segment::left_toe));
}

TEST(RestRig, SpineAndChestMayBeOneBoneAndToesMayLack) {
  RigParts parts = made_rig();
  parts.segments["chest"] = parts.segments["spine"];
  parts.segments.erase("toe.L");
  const RestRig rest = parts.rig();
  EXPECT_EQ(rest.bone(Segment::chest), rest.bone(Segment::spine));
  EXPECT_EQ(rest.bone(Segment::left_toe), RestRig::kNone);
}

TEST(RestRig, EverySegmentHasItsName) {
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    EXPECT_EQ(find_segment(segment_name(static_cast<Segment>(s))), static_cast<Segment>(s));
  }
  EXPECT_EQ(find_segment("tail"), std::nullopt);
  EXPECT_EQ(segment_name(arms()[0].forearm), "forearm.L");
  EXPECT_EQ(segment_name(legs()[1].toe), "toe.R");
  EXPECT_EQ(segment_name(carrier(Joint::right_grip)), "hand.R");
  EXPECT_EQ(segment_name(carrier(Joint::left_shoulder)), "upper_arm.L");
}

TEST(RestRig, RefusesBones) {
  RigParts parts = made_rig();
  parts.bones.parents[4] = 4;
  expect_refused(parts, {"parents[4] is 4", "3"});
  parts = made_rig();
  parts.bones.heads.pop_back();
  expect_refused(parts, {"heads", "one of each"});
  parts = made_rig();
  parts.bones.heads[2].x = kMissing;
  expect_refused(parts, {"heads[2]", "finite"});
  parts = made_rig();
  parts.bones.rotations[5] *= 1.1;
  expect_refused(parts, {"rotations[5]", "1e-06"});
  parts = made_rig();
  parts.axes[0] = -parts.axes[0];
  expect_refused(parts, {"axes", "right-handed"});
}

TEST(RestRig, RefusesSegments) {
  RigParts parts = made_rig();
  parts.segments["tail"] = 1;
  expect_refused(parts, {"'tail'"});
  parts = made_rig();
  parts.segments["hand.L"] = 99;
  expect_refused(parts, {"hand.L", "99", "22"});
  parts = made_rig();
  parts.segments.erase("shin.R");
  expect_refused(parts, {"shin.R has no bone"});
  parts = made_rig();
  parts.segments["hand.L"] = parts.segments["hand.R"];
  expect_refused(parts, {"hand.L", "hand.R", "both"});
}

TEST(RestRig, RefusesJoints) {
  RigParts parts = made_rig();
  parts.joints[index(Joint::left_wrist)] = parts.joints[index(Joint::left_elbow)];
  expect_refused(parts, {"left_elbow", "left_wrist", "1e-09"});
  parts = made_rig();
  parts.joints[index(Joint::l5s1)] =
      0.5 * (parts.joints[index(Joint::left_hip)] + parts.joints[index(Joint::right_hip)]);
  expect_refused(parts, {"l5s1", "one line"});
  parts = made_rig();
  parts.joints[index(Joint::nasion)].z = kMissing;
  expect_refused(parts, {"nasion", "finite"});
}

}  // namespace
}  // namespace reachcast
