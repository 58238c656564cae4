#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "core/io/cloud/scan_motion.h"
#include "generator/extras/convert/convert.h"
#include "tests/core/io/recording/read_all.h"

namespace railcast {

inline ConvertResult ConvertAll(const ConvertChoices& choices,
                                std::uint32_t most = std::numeric_limits<std::uint32_t>::max()) {
  std::uint32_t num_asked = 0;
  return RunConvert(choices,
                    {[](std::uint32_t, std::uint32_t) {}, [&] { return num_asked++ >= most; }});
}

/// Converts to a format, and returns what can be opened of it.
inline std::filesystem::path ConvertTo(const std::string& format,
                                       const std::filesystem::path& recording,
                                       const std::filesystem::path& out) {
  const ConvertResult result =
      ConvertAll({.recording = recording, .directory = out, .format = format});
  EXPECT_TRUE(result.is_complete);
  const std::string_view bag = ParseFrameFormat(format).bag;
  return bag.empty() ? out : out / bag;
}

/// Compares where the sensor was within scans with what was expected there: bags are read with
/// poses at other times than theirs.
inline void ExpectSameMotion(const std::vector<RecordedFrame>& got,
                             const std::vector<RecordedFrame>& expected) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    const Frame& wanted = expected[i].frame;
    EXPECT_EQ(got[i].frame.poses_between.size(), wanted.poses_between.size());
    for (const ScanPose& pose : got[i].frame.poses_between) {
      const Vector3 wanted_m =
          wanted.world_from_sensor * ScanMotion(wanted).AtStamp(Vector3::Zero(), pose.time_ns);
      constexpr double kRounding_m = 1e-9;  // Of coordinates of a kilometre, some times over.
      EXPECT_LT((pose.world_from_sensor.translation() - wanted_m).norm(), kRounding_m);
    }
  }
}

/// Compares frames bit by bit: shape, values of all fields, stamps, and poses but for their
/// rounding.
inline void ExpectSameFrames(const std::vector<RecordedFrame>& got,
                             const std::vector<RecordedFrame>& expected) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    const Frame& frame = got[i].frame;
    const Frame& wanted = expected[i].frame;
    EXPECT_EQ(got[i].fields, expected[i].fields);
    EXPECT_EQ(got[i].is_grid, expected[i].is_grid) << got[i].why_no_grid;
    EXPECT_EQ(frame.stamp_ns, wanted.stamp_ns);
    EXPECT_EQ(frame.duration_ns, wanted.duration_ns);
    EXPECT_EQ(got[i].origin_m, expected[i].origin_m);
    ASSERT_EQ(frame.rows, wanted.rows);
    ASSERT_EQ(frame.columns, wanted.columns);
    ASSERT_EQ(frame.returns, wanted.returns);
    std::vector<const void*> values;
    ForEachField(wanted, [&](auto, auto, const auto& each) { values.push_back(each.data()); });
    std::size_t next = 0;
    ForEachField(frame, [&](std::string_view name, auto, const auto& each) {
      EXPECT_EQ(std::memcmp(each.data(), values[next++], each.size() * sizeof(each[0])), 0) << name;
    });
    ASSERT_EQ(got[i].foreign.size(), expected[i].foreign.size());
    for (std::size_t f = 0; f < got[i].foreign.size(); ++f) {
      EXPECT_EQ(got[i].foreign[f].name, expected[i].foreign[f].name);
      EXPECT_EQ(got[i].foreign[f].values, expected[i].foreign[f].values);
    }
    EXPECT_EQ(got[i].has_pose, expected[i].has_pose);
    if (!got[i].has_pose) continue;
    constexpr double kRounding = 1e-12;  // Of a quaternion, made of a matrix and made one again.
    EXPECT_TRUE(frame.world_from_sensor.isApprox(wanted.world_from_sensor, kRounding));
    EXPECT_TRUE(frame.world_from_sensor_end.isApprox(wanted.world_from_sensor_end, kRounding));
  }
}

}  // namespace railcast
