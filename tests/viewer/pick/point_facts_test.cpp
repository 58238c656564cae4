#include "viewer/pick/picks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/base/units.h"
#include "tests/core/io/example_frame.h"
#include "tests/viewer/pick/shown_cloud.h"

namespace railcast {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Not;
using testing::StartsWith;

constexpr float kNotKnown = std::numeric_limits<float>::quiet_NaN();

RecordingInfo NamedInfo() {
  RecordingInfo info;
  info.labels = ExampleLabels();
  info.materials = {"none", "ballast", "red_paint"};
  return info;
}

// One firing with two returns and all fields.
RecordedFrame SecondReturn() {
  RecordedFrame recorded = RecordedCloud("out/frames/000003.pcd", {{9, 9, 9}, {40, -3, 1.25}});
  Frame& frame = recorded.frame;
  frame.index = 3;
  recorded.has_pose = true;
  frame.world_from_sensor = MakeTransform(Eigen::Matrix3d::Identity(), Vector3(5.3e6, 6e5, 412.25));
  ForEachField(frame, [&](std::string_view name, std::string_view, auto&) {
    recorded.fields.emplace(name);
  });
  recorded.objects.resize(1);
  recorded.objects[0].name = "wagon_1";
  recorded.objects[0].instance = 7;
  frame.range_m[1] = 40.1250F;
  frame.intensity[1] = 0.0562452F;
  frame.power_ratio[1] = 3.46147F;
  frame.time_ns[1] = 3'333'333;
  frame.ring[1] = 11;
  frame.column[1] = 804;
  frame.return_index[1] = 1;
  frame.return_count[1] = 2;
  frame.label[1] = 12;
  frame.instance[1] = 7;
  frame.material[1] = 2;
  frame.outcome[1] = Outcome::kReturned;
  frame.true_range_m[1] = 40.1234F;
  frame.incidence_rad[1] = static_cast<float>(RadFromDeg(30.0));
  frame.footprint_share[1] = 0.25F;
  frame.mixed_share[1] = 0.75F;
  return recorded;
}

TEST(PointFacts, SayTheCoordinatesAsStoredOfPositionsFarFromZero) {
  RecordedFrame recorded = RecordedCloud("a.pcd", {{234.5, 567.25, 20}});
  recorded.origin_m = {691000, 5334000, 0};
  EXPECT_THAT(PointFacts(Show(std::move(recorded)), {}, 0),
              Contains("position           691234.500 5334567.250      20.000 m"));
}

TEST(PointFacts, SaysAllThatIsKnownOfAPoint) {
  ShownFrame shown = Show(SecondReturn());
  // The sensor moved by 37 mm before this firing.
  shown.positions_m[3] = 40.037F;
  EXPECT_THAT(
      PointFacts(shown, NamedInfo(), 1),
      ElementsAre("file             000003.pcd",  //
                  "frame            3",           //
                  "slot             1", "position               40.000      -3.000       1.250 m",
                  "at the stamp           40.037      -3.000       1.250 m",
                  "in the world      5300040.037  599997.000     413.500 m",
                  "range            40.1250 m",    //
                  "intensity        0.0562452",    //
                  "power ratio      3.46147",      //
                  "time             3333.333 us",  //
                  "ring             11",           //
                  "column           804",          //
                  "return index     1",            //
                  "return count     2",            //
                  "truth",                         //
                  "label            wagon (12)",   //
                  "instance         wagon_1 (7)",  //
                  "material         red_paint (2)",
                  "outcome          returned",   //
                  "true range       40.1234 m",  //
                  "noise            +1.6 mm",    //
                  "incidence        30.00 deg",  //
                  "footprint share  0.250",      //
                  "mixed share      0.750"));
}

TEST(PointFacts, IsShortWhereTheRecordingIs) {
  const ShownFrame shown = Show(RecordedCloud("cloud.ply", {{3, 4, 12}}));
  EXPECT_THAT(
      PointFacts(shown, RecordingInfo(), 0),
      ElementsAre("file             cloud.ply",  //
                  "frame            0",          //
                  "slot             0", "position                3.000       4.000      12.000 m",
                  "range            13.0000 m"));
}

TEST(PointFacts, HasWhatForeignCloudsHaveUnderItsOwnName) {
  RecordedFrame recorded = RecordedCloud("cloud.ply", {{3, 4, 12}, {0, 0, 2}});
  recorded.fields.emplace("label");
  recorded.foreign = {{"curvature", {0.5F, 0.0625F}},
                      {"second_strongest_return", {kNotKnown, kNotKnown}}};
  EXPECT_THAT(
      PointFacts(Show(std::move(recorded)), RecordingInfo(), 1),
      ElementsAre("file             cloud.ply",  //
                  "frame            0",          //
                  "slot             1", "position                0.000       0.000       2.000 m",
                  "range            2.0000 m",  //
                  "curvature        0.0625",    //
                  "second_strongest_return -",  //
                  "truth",                      //
                  "label            0"));
}

TEST(PointFacts, IsOfThePointsOwnSlot) {
  ShownFrame shown = Show(RecordedCloud("cloud.ply", {{1, 0, 0}, {0, 0, 0}, {2, 0, 0}}));
  shown.slots = {0, 2};
  shown.positions_m = {1, 0, 0, 2, 0, 0};
  const auto facts = PointFacts(shown, RecordingInfo(), 1);
  EXPECT_THAT(facts, Contains("slot             2"));
  EXPECT_THAT(facts, Contains("range            2.0000 m"));
  EXPECT_THAT(facts, Not(Contains(StartsWith("at the stamp")))) << "it is where it was";
}

TEST(PointFacts, HasNumbersWhereNothingHasNames) {
  const auto facts = PointFacts(Show(SecondReturn()), RecordingInfo(), 1);
  EXPECT_THAT(facts, Contains("label            12"));
  EXPECT_THAT(facts, Contains("material         2"));
}

TEST(PointFacts, KnowsThatStuffIsNoObject) {
  RecordedFrame recorded = SecondReturn();
  recorded.frame.instance[1] = 0;
  recorded.objects[0].instance = 0;
  EXPECT_THAT(PointFacts(Show(std::move(recorded)), NamedInfo(), 1),
              Contains("instance         0"));
}

TEST(PointFacts, HasADashForWhatIsAbsent) {
  RecordedFrame recorded = SecondReturn();
  Frame& frame = recorded.frame;
  for (auto* values :
       {&frame.intensity, &frame.true_range_m, &frame.incidence_rad, &frame.footprint_share}) {
    (*values)[1] = kNotKnown;
  }
  const auto facts = PointFacts(Show(std::move(recorded)), NamedInfo(), 1);
  for (const char* line : {"intensity        -", "true range       -", "noise            -",
                           "incidence        -", "footprint share  -"}) {
    EXPECT_THAT(facts, Contains(line));
  }
}

TEST(PointFacts, GivesTheSignOfTheNoise) {
  RecordedFrame recorded = SecondReturn();
  recorded.frame.range_m[1] = 40.1130F;
  EXPECT_THAT(PointFacts(Show(std::move(recorded)), NamedInfo(), 1),
              Contains("noise            -10.4 mm"));
}

// A live stream may send points in the world's axes and no ranges.
TEST(PointFacts, HasNoRangeWhereTheRecordingHasNone) {
  RecordedFrame recorded = RecordedCloud("udp://", {{3, 4, 12}});
  recorded.fields.erase("range_m");
  EXPECT_THAT(PointFacts(Show(std::move(recorded)), RecordingInfo(), 0),
              Not(Contains(StartsWith("range"))));
}

TEST(PointFacts, KeepsTheEndOfALongFileName) {
  const std::string name = "folder/" + std::string(60, 'a') + "_000123.pcd: turn 3";
  const auto facts = PointFacts(Show(RecordedCloud(name, {{1, 0, 0}})), RecordingInfo(), 0);
  EXPECT_EQ(facts[0], "file             ..." + std::string(21, 'a') + "_000123.pcd: turn 3");
  EXPECT_EQ(facts[0].size(), 60U);
}

}  // namespace
}  // namespace railcast
