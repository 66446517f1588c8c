// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "mocap_cases.hpp"
#include "reachcast/mocap/joint_map.hpp"
#include "reachcast/mocap/motion_file.hpp"

namespace {

using namespace reachcast;
using namespace reachcast::test;
using enum Joint;

constexpr double kTolerance_m = 1e-12;

/// Twelve joints of someone 1.8 m tall who stands facing +y, left at -x, arms forward; Lieblich's names.
Clip standing_person() {
  Clip clip;
  clip.source = "standing";
  clip.rate_hz = 50.0;
  for (const bool is_left : {true, false}) {
    const std::string side = is_left ? "L" : "R";
    const double x = is_left ? -1.0 : 1.0;
    for (const auto& [name, point] : {std::pair<std::string, Vec3>{"ank", {0.1, 0, 0.08}},
                                      {"knee", {0.1, 0, 0.5}},
                                      {"hip", {0.09, 0, 0.9}},
                                      {"sh", {0.18, 0, 1.42}},
                                      {"eb", {0.18, 0.3, 1.42}},
                                      {"w", {0.18, 0.56, 1.42}}}) {
      clip.names.push_back(side + name);
      clip.positions.push_back(point * Vec3(x, 1, 1));
    }
  }
  clip.derived.assign(clip.names.size(), false);
  return clip;
}

Vec3 at(const Clip& clip, Joint joint) {
  return clip.at(0, index(joint));
}

TEST(Canonical, NamesAreExactlyTheCanonicalJoints) {
  const Clip clip = to_canonical(standing_person());
  ASSERT_EQ(clip.names.size(), kJointCount);
  EXPECT_TRUE(std::equal(clip.names.begin(), clip.names.end(), joint_names().begin()));
  EXPECT_EQ(clip.rate_hz, 50.0);
  for (const Vec3& point : clip.positions) EXPECT_TRUE(is_finite(point));
}

TEST(Canonical, DerivedJointsLieWhereABodyHasThem) {
  const Clip clip = to_canonical(standing_person());
  for (const Joint joint : required_joints()) EXPECT_FALSE(clip.derived[index(joint)]);
  for (const Joint joint : {l5s1, c7t1, suprasternale, tragion, nasion, left_grip, right_ball, left_clavicle}) {
    EXPECT_TRUE(clip.derived[index(joint)]) << joint_name(joint);
  }
  EXPECT_GT(at(clip, l5s1).z, 0.95);
  EXPECT_LT(at(clip, l5s1).y, 0.0);
  EXPECT_GT(at(clip, c7t1).z, 1.42);
  EXPECT_GT(at(clip, suprasternale).y, 0.02);
  EXPECT_GT(at(clip, nasion).y, at(clip, tragion).y + 0.05);
  EXPECT_GT(at(clip, tragion).z, at(clip, c7t1).z + 0.1);
  EXPECT_NEAR(at(clip, left_grip).y, 0.56 + 0.395 * 0.26, kTolerance_m);
  EXPECT_NEAR(glm::distance(at(clip, left_grip), (at(clip, left_hand_back) + at(clip, left_hand_front)) * 0.5), 0,
              kTolerance_m);
  EXPECT_GT(at(clip, right_ball).y, 0.1);
  EXPECT_LT(at(clip, right_ball).z, 0.08);
  EXPECT_EQ(at(clip, left_clavicle), at(clip, suprasternale));
}

TEST(Canonical, AMirroredPersonGivesTheMirroredJoints) {
  const Clip person = standing_person();
  Clip image = person;
  for (std::size_t i = 0; i < 6; ++i) {
    image.positions[i] = person.positions[i + 6] * Vec3(-1, 1, 1);
    image.positions[i + 6] = person.positions[i] * Vec3(-1, 1, 1);
  }
  const Clip a = to_canonical(person);
  const Clip b = to_canonical(image);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const Vec3 expected = at(a, mirrored(static_cast<Joint>(i))) * Vec3(-1, 1, 1);
    EXPECT_LT(glm::distance(b.at(0, i), expected), kTolerance_m);
  }
}

TEST(Canonical, EachMissingJointIsNamed) {
  Clip clip = standing_person();
  clip.names[2] = "unknown";
  clip.names[11] = "other";
  EXPECT_EQ(complaint([&] { (void)to_canonical(clip); }),
            "standing: no known set of joint names fits; the nearest is 'lieblich', which finds no point for left_hip, "
            "right_wrist; give a joint map");
  EXPECT_EQ(complaint([&] {
              (void)to_canonical(clip, JointMap{"mine", {{left_hip, {"unknown"}}}});
            }).substr(0, 70),
            "standing: the joint map 'mine' finds no point for left_ankle, left_kne");
}

TEST(Canonical, AMapMayAverageAndOfferAlternativesAndIgnoreNamespaces) {
  Clip clip = standing_person();
  clip.names[2] = "rig:Lhip";
  JointMap map = *std::find_if(joint_map_presets().begin(), joint_map_presets().end(),
                               [](const JointMap& preset) { return preset.name == "lieblich"; });
  map.sources.insert(map.sources.begin(), {l5s1, {"nowhere", "Lhip"}});
  map.sources.push_back({l5s1, {"Lhip", "Rhip", "Rhip", "Lhip"}});
  const Clip result = to_canonical(clip, map);
  EXPECT_LT(glm::distance(at(result, l5s1), Vec3(0, 0, 0.9)), kTolerance_m);
  EXPECT_TRUE(result.derived[index(l5s1)]);
}

/// The sources of lieblich, with another one for the left knee before them.
JointMap with_left_knee(const JointSource& knee) {
  JointMap map = *std::find_if(joint_map_presets().begin(), joint_map_presets().end(),
                               [](const JointMap& preset) { return preset.name == "lieblich"; });
  map.sources.insert(map.sources.begin(), {left_knee, knee});
  return map;
}

TEST(Canonical, AnOffsetMovesAMarkerToItsJoint) {
  JointSource knee{"Lknee"};
  knee.offset = {0.05, 0.02, -0.01};
  knee.across = parse_span("Lhip>Rhip");
  EXPECT_LT(glm::distance(at(to_canonical(standing_person(), with_left_knee(knee)), left_knee),
                          Vec3(-0.1, 0, 0.5) + Vec3(0.05, 0.02, -0.01)),
            kTolerance_m);
  EXPECT_TRUE(to_canonical(standing_person(), with_left_knee(knee)).derived[index(left_knee)]);
  // The axes turn with the body.
  Clip turned = standing_person();
  for (Vec3& p : turned.positions) p = {-p.y, p.x, p.z};
  EXPECT_LT(glm::distance(at(to_canonical(turned, with_left_knee(knee)), left_knee),
                          Vec3(0, -0.1, 0.5) + Vec3(-0.02, 0.05, -0.01)),
            kTolerance_m);
}

TEST(Canonical, OffsetAxesFollowAheadAndAlongAndScale) {
  JointSource knee{"Lknee"};
  knee.offset = {0.0, 0.0, 0.5};
  knee.scale = parse_span("Lank>Lknee");
  knee.across = parse_span("Lhip>Rhip");
  knee.along = parse_span("Leb>Lw");  // the forearm points forward: that is "up" here
  EXPECT_LT(glm::distance(at(to_canonical(standing_person(), with_left_knee(knee)), left_knee), Vec3(-0.1, 0.21, 0.5)),
            kTolerance_m);
  knee.along = {};
  knee.ahead = parse_span("Leb+Reb>Lw+Rw");
  EXPECT_LT(glm::distance(at(to_canonical(standing_person(), with_left_knee(knee)), left_knee), Vec3(-0.1, 0.0, 0.71)),
            kTolerance_m);
}

TEST(Canonical, FaultyMapsAreNamed) {
  const auto answer = [](const JointSource& knee) {
    return complaint([&] { (void)to_canonical(standing_person(), with_left_knee(knee)); });
  };
  JointSource knee{"Lknee"};
  knee.offset = {0.1, 0, 0};
  EXPECT_EQ(answer(knee), "map: left_knee has an offset, but no 'across' to say which way it points");
  knee.across = parse_span("Lhip>Rhip");
  knee.offset.z = kMissing;
  EXPECT_EQ(answer(knee), "map: left_knee has an offset that is not a finite vector of at most 5");
  EXPECT_EQ(answer(JointSource{}), "map: left_knee names no point");
  EXPECT_EQ(complaint([] { (void)parse_span("A+B"); }),
            "map: expected FROM>TO, each a name or several joined by '+', found \"A+B\"");
  EXPECT_EQ(complaint([] { (void)parse_mean("A+"); }), "map: expected names joined by '+', found \"A+\"");
}

TEST(Canonical, MarkersOfPlugInGaitGiveAPersonsJoints) {
  REACHCAST_NEED_MOCAP("c3d_trc/cmu_02_01.c3d");
  for (const std::string name : {"cmu_02_01.c3d", "motion_capture_walk.trc"}) {
    const Clip clip = to_canonical(read_motion((mocap_folder() / "c3d_trc" / name).string()));
    for (const std::size_t frame : {std::size_t{0}, clip.frames() / 2}) {
      const auto distance = [&](Joint a, Joint b) {
        return glm::distance(clip.at(frame, index(a)), clip.at(frame, index(b)));
      };
      for (const auto& [hip, knee, ankle] :
           {std::tuple{left_hip, left_knee, left_ankle}, {right_hip, right_knee, right_ankle}}) {
        EXPECT_GT(distance(hip, knee), 0.36) << name;
        EXPECT_LT(distance(hip, knee), 0.47) << name;
        EXPECT_GT(distance(knee, ankle), 0.35) << name;
        EXPECT_LT(distance(knee, ankle), 0.46) << name;
      }
      EXPECT_GT(distance(left_hip, right_hip), 0.13) << name;
      EXPECT_LT(distance(left_hip, right_hip), 0.22) << name;
      EXPECT_LT(distance(left_knee, right_knee), distance(left_hip, right_hip) + 0.45) << name;
    }
  }
}

TEST(Canonical, FilledPointsMarkTheirJoints) {
  Clip clip = standing_person();
  clip.filled.assign(clip.positions.size(), 0);
  clip.filled[*clip.find("Lknee")] = 1;
  const Clip canonical = to_canonical(clip);
  EXPECT_EQ(canonical.filled[index(left_knee)], 1);
  EXPECT_EQ(canonical.filled[index(right_knee)], 0);
  EXPECT_EQ(canonical.filled[index(nasion)], 1) << "derived from all";
}

TEST(Canonical, CanonicalClipsStayAsTheyAre) {
  const Clip once = to_canonical(standing_person());
  const Clip twice = to_canonical(once);
  EXPECT_EQ(once.positions, twice.positions);
  EXPECT_EQ(once.derived, twice.derived);
}

TEST(Canonical, RecordedPeopleHaveHumanProportions) {
  REACHCAST_NEED_MOCAP("omomo");
  REACHCAST_NEED_MOCAP("lieblich_lifting");
  struct Link {
    Joint a, b;
    double low, high;  // of shank + thigh + trunk, about 0.78 statures
  };
  const Link links[] = {{left_hip, l5s1, 0.06, 0.14},         {l5s1, c7t1, 0.25, 0.40},
                        {c7t1, suprasternale, 0.03, 0.07},    {c7t1, tragion, 0.07, 0.18},
                        {tragion, nasion, 0.05, 0.10},        {left_wrist, left_grip, 0.05, 0.09},
                        {right_ankle, right_ball, 0.08, 0.15}};
  for (const std::string name :
       {"omomo/sub2_largetable_003.csv", "omomo/sub9_smalltable_020.csv", "lieblich_lifting/S3_dip2.csv"}) {
    const Clip clip = to_canonical(read_motion((mocap_folder() / name).string()));
    for (std::size_t frame = 0; frame < clip.frames(); frame += 10) {
      const auto point = [&](Joint joint) { return clip.at(frame, index(joint)); };
      const double size =
          glm::distance(point(left_ankle), point(left_knee)) + glm::distance(point(left_knee), point(left_hip)) +
          0.5 * glm::length(point(left_shoulder) + point(right_shoulder) - point(left_hip) - point(right_hip));
      for (const Link& link : links) {
        const double length = glm::distance(point(link.a), point(link.b)) / size;
        EXPECT_GT(length, link.low) << name << ' ' << joint_name(link.b) << " frame " << frame;
        EXPECT_LT(length, link.high) << name << ' ' << joint_name(link.b) << " frame " << frame;
      }
    }
  }
}

}  // namespace
