#include "analysis/stats/statistics.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tests/analysis/recorded_frames.h"
#include "tests/core/io/message_of.h"
#include "tests/core/rail/world/made_track.h"

namespace railcast {
namespace {

/// A point where it is in the sensor's axes, and its label.
struct GaugePoint {
  Vector3 place_m;
  std::uint32_t label{};
};

/// A frame of a sensor 2.5 m above the straight track at 500 m.
RecordedFrame FrameAbove(const std::vector<GaugePoint>& points) {
  Frame frame;
  frame.Resize(1, static_cast<std::uint32_t>(points.size()), 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    frame.x[i] = static_cast<float>(points[i].place_m.x());
    frame.y[i] = static_cast<float>(points[i].place_m.y());
    frame.z[i] = static_cast<float>(points[i].place_m.z());
    frame.range_m[i] = static_cast<float>(points[i].place_m.norm());
    frame.label[i] = points[i].label;
  }
  frame.world_from_sensor.translation() = Vector3(500.0, 0.0, 2.5);
  frame.world_from_sensor_end = frame.world_from_sensor;
  RecordedFrame recorded = Record(std::move(frame));
  return recorded;
}

FrameTrack MadeTrack() {
  return {StraightTrack(), {}};
}

TEST(GaugePoints, AreCountedByLabelAndRange) {
  GaugePoints one;
  one.Add(FrameAbove({{{20.0, 0.0, -1.5}, 1}, {{30.0, 1.0, -1.0}, 1}, {{30.0, 3.0, -1.0}, 1}}),
          MadeTrack());
  GaugePoints other;
  other.Add(FrameAbove({{{20.0, -1.0, 0.0}, 2}}), MadeTrack());
  other.Add(FrameAbove({{{20.0, 0.0, -2.6}, 2}}), MadeTrack());
  AddTo(one, other);
  std::vector<Label> labels(2);
  labels[0].id = 1;
  labels[0].name = "person";
  labels[1].id = 2;
  labels[1].name = "wagon";
  RecordingInfo info;
  info.labels = LabelTable(labels);
  const Section section = one.MakeSection(Names(info));
  EXPECT_EQ(section.paragraphs.at(0).rfind(
                "3 points in the vehicle's outline on the track, in 2 of 3", 0),
            0U);
  const auto& rows = section.tables.at(0).rows;
  ASSERT_EQ(rows.size(), 3U);
  // Up to 10, to 25 and to 50 m.
  EXPECT_EQ(std::get<std::string>(rows[0][0]), "person");
  EXPECT_EQ(std::get<std::uint64_t>(rows[0][2]), 1U);
  EXPECT_EQ(std::get<std::uint64_t>(rows[0][3]), 1U);
  EXPECT_EQ(std::get<std::string>(rows[1][0]), "wagon");
  EXPECT_EQ(std::get<std::uint64_t>(rows[1][2]), 1U);
  EXPECT_EQ(std::get<std::uint64_t>(rows[1][3]), 0U);
}

TEST(GaugePoints, NeedThePoseOfTheSensor) {
  RecordedFrame recorded = FrameAbove({{{20.0, 0.0, 0.0}, 1}});
  recorded.has_pose = false;
  recorded.name = "a.pcd";
  GaugePoints points;
  EXPECT_EQ(MessageOf([&] { points.Add(recorded, MadeTrack()); }),
            "a.pcd: must have the sensor's pose for --track");
}

}  // namespace
}  // namespace railcast
