#include "viewer/pick/picks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/viewer/session/held_frames.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

/// The composition of a frame in its own axes.
Composition CompositionOf(const std::shared_ptr<const ShownFrame>& shown) {
  Composition composition;
  composition.clouds.push_back({shown, Transform::Identity(), {}});
  return composition;
}

/// Returns the middles of the crosses among the marks.
std::vector<Eigen::Vector3f> CrossesOf(const Overlay& marks) {
  std::vector<Eigen::Vector3f> middles_m;
  for (std::size_t i = 0; i + 2 < marks.segments.size(); i += 3) {
    middles_m.push_back((marks.segments[i].from_m + marks.segments[i].to_m) / 2.0F);
  }
  return middles_m;
}

TEST(Picks, AreNoneAtFirst) {
  const Picks picks;
  EXPECT_TRUE(picks.is_empty());
  EXPECT_EQ(picks.facts(), "");
  EXPECT_EQ(picks.label(), std::nullopt);
  EXPECT_THAT(picks.MarksIn(CompositionOf(Share(NumberedCloud(0)))).segments, IsEmpty());
}

TEST(Picks, SayAllThatIsKnownOfTheLastPoint) {
  const auto shown = Share(LabelledCloud(3));
  Picks picks;
  picks.Add(*shown, 0, {}, false);
  picks.Add(*shown, 1, {}, false);
  std::string facts;
  for (const std::string& line : PointFacts(*shown, {}, 1)) facts += line + "\n";
  EXPECT_EQ(picks.facts(), facts);
  EXPECT_THAT(facts, HasSubstr("label"));
  EXPECT_EQ(picks.slot(), 1U);
  EXPECT_EQ(picks.label(), 1U);
  EXPECT_EQ(picks.recorded(), shown->recorded);
  picks.Clear();
  EXPECT_TRUE(picks.is_empty());
  EXPECT_EQ(picks.facts(), "");
}

TEST(Picks, HaveNoLabelWhereTheFrameHasNone) {
  Picks picks;
  picks.Add(*Share(NumberedCloud(3)), 0, {}, false);
  EXPECT_EQ(picks.label(), std::nullopt);
}

TEST(Picks, MeasureFromTheOneBefore) {
  const auto shown = Share(NumberedCloud(3));  // Its points are (3, 0, 1) and (3, 0, 5).
  Picks picks;
  picks.Add(*shown, 0, {}, true);
  EXPECT_THAT(picks.facts(), Not(HasSubstr("from the point before")));
  picks.Add(*shown, 1, {}, true);
  EXPECT_THAT(picks.facts(), testing::EndsWith("\n\nfrom the point before\n4.000 m (dx 0.000, dy "
                                               "0.000, dz 4.000; level 0.000 m)"));
  // A third pick is measured from the second.
  picks.Add(*shown, 1, {}, true);
  EXPECT_THAT(picks.facts(), HasSubstr("\n0.000 m ("));
  picks.Add(*shown, 0, {}, false);
  EXPECT_THAT(picks.facts(), Not(HasSubstr("from the point before")));
}

TEST(Picks, SayThatFramesWithoutPosesHaveNoPlaceInCommon) {
  Picks picks;
  picks.Add(*Share(NumberedCloud(0)), 0, {}, true);
  picks.Add(*Share(NumberedCloud(1)), 0, {}, true);
  EXPECT_THAT(picks.facts(),
              HasSubstr("from the point before\nnot known: frames without poses have no place in "
                        "common"));
}

TEST(Picks, AreMarkedWhereTheyArePicked) {
  const auto shown = Share(NumberedCloud(3));
  Picks picks;
  picks.Add(*shown, 0, {}, true);
  EXPECT_THAT(CrossesOf(picks.MarksIn(CompositionOf(shown))),
              testing::ElementsAre(Eigen::Vector3f(3, 0, 1)));
  picks.Add(*shown, 1, {}, true);
  const Overlay marks = picks.MarksIn(CompositionOf(shown));
  ASSERT_THAT(marks.segments, SizeIs(7)) << "two crosses and a line";
  EXPECT_THAT(CrossesOf(marks),
              testing::ElementsAre(Eigen::Vector3f(3, 0, 1), Eigen::Vector3f(3, 0, 5)));
  EXPECT_EQ(marks.segments[6].from_m, Eigen::Vector3f(3, 0, 1));
  EXPECT_EQ(marks.segments[6].to_m, Eigen::Vector3f(3, 0, 5));
}

TEST(Picks, StayAtTheirPlaceInTheWorldWhileTheVehicleMoves) {
  // The sensor is at 2 m, and the point is at 3 m in the world.
  const auto first = Share(MovingCloud(1));
  Picks picks;
  picks.Add(*first, 0, {}, false);
  for (std::uint32_t later = 1; later < 6; ++later) {
    const auto marks = picks.MarksIn(CompositionOf(Share(MovingCloud(later))));
    const float ahead_m = 3.0F - 2.0F * static_cast<float>(later);
    EXPECT_THAT(CrossesOf(marks), testing::ElementsAre(Eigen::Vector3f(ahead_m, 0, 1))) << later;
  }
}

TEST(Picks, StayAtTheirPlaceInTheWorldWhileTheVehicleTurns) {
  // In the world the pick is 10 m north of the first sensor position and 1 m above it.
  RecordedFrame north = RecordedCloud("a.pcd", {{10, 0, 1}});
  RecordedFrame east = RecordedCloud("b.pcd", {{0, 0, 0}});
  const double quarter_rad = std::acos(0.0);
  north.has_pose = east.has_pose = true;
  north.frame.world_from_sensor =
      MakeTransform(RotationFromYawPitchRoll(quarter_rad, 0, 0), Vector3(5e6, 6e5, 400));
  east.frame.world_from_sensor =
      MakeTransform(Eigen::Matrix3d::Identity(), Vector3(5e6 - 20, 6e5, 400));
  Picks picks;
  picks.Add(*Share(north), 0, {}, false);
  const auto crosses = CrossesOf(picks.MarksIn(CompositionOf(Share(east))));
  ASSERT_THAT(crosses, SizeIs(1));
  // 5000 km are exact to 1 nm as double, 20 m to 2 um as float.
  EXPECT_LT((crosses[0] - Eigen::Vector3f(20, 10, 1)).norm(), 4e-6F);
}

TEST(Picks, AreMarkedWhereTheirFrameIsShownThoughItHasNoPose) {
  const auto a = Share(NumberedCloud(3));
  const auto b = Share(NumberedCloud(4));
  Composition both = CompositionOf(a);
  both.clouds.push_back({b, MakeTransform(Eigen::Matrix3d::Identity(), {0, 7, 0}), {}});
  Picks picks;
  picks.Add(*b, 0, {}, false);
  EXPECT_THAT(CrossesOf(picks.MarksIn(both)), testing::ElementsAre(Eigen::Vector3f(4, 7, 1)));
}

TEST(Picks, AreNotMarkedWhereTheirPlaceIsNotKnown) {
  Picks picks;
  picks.Add(*Share(NumberedCloud(3)), 0, {}, false);
  EXPECT_THAT(picks.MarksIn(CompositionOf(Share(NumberedCloud(4)))).segments, IsEmpty());
  EXPECT_THAT(picks.MarksIn(CompositionOf(Share(MovingCloud(4)))).segments, IsEmpty());
  EXPECT_THAT(picks.MarksIn(Composition{}).segments, IsEmpty());
}

TEST(Picks, AreMarkedInAFrameThatWasReadAgain) {
  Picks picks;
  picks.Add(*Share(NumberedCloud(3)), 0, {}, false);
  EXPECT_THAT(CrossesOf(picks.MarksIn(CompositionOf(Share(NumberedCloud(3))))),
              testing::ElementsAre(Eigen::Vector3f(3, 0, 1)));
}

}  // namespace
}  // namespace railcast
