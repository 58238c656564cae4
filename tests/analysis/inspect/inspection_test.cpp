#include "analysis/inspect/inspection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "analysis/report/formats.h"
#include "core/base/random.h"
#include "core/base/units.h"
#include "tests/analysis/held_recording.h"
#include "tests/analysis/recorded_frames.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

std::vector<RecordedFrame> FramesOf(const std::string& sensor, std::uint32_t num = 4) {
  const MadeScan scan(ReadSensor(sensor));
  std::vector<RecordedFrame> frames;
  for (std::uint32_t i = 0; i < num; ++i) frames.push_back(RecordPointsOnly(scan.MakeFrame(i)));
  return frames;
}

RecordingLook LookAt(std::vector<RecordedFrame> frames, std::size_t most = 100) {
  HeldRecording recording(std::move(frames));
  return Inspect(recording, most);
}

std::string LookText(const RecordingLook& look) {
  RecordingInfo info;
  info.kind = "directory of point clouds";
  return ReportText(MakeInspectionReport(look, info, "railcast-analyze inspect"));
}

Fitness FitnessFor(const std::string& job, const RecordingLook& look) {
  for (const JobFitness& fitness : JobsOf(look, {})) {
    if (fitness.job == job) return fitness.fitness;
  }
  ADD_FAILURE() << job;
  return Fitness::kNo;
}

TEST(GuessSensor, NamesThePresetWhoseChannelsTheRingsAre) {
  for (const auto& [sensor, name] : {std::pair("vlp16", "VLP-16"),
                                     {"vlp32c", "VLP-32C"},
                                     {"xt32", "XT32"},
                                     {"pandar64", "Pandar64"},
                                     {"vls128", "VLS-128"}}) {
    const auto guesses = GuessSensor(LookAt(FramesOf(sensor, 1)).rings);
    ASSERT_FALSE(guesses.empty()) << sensor;
    EXPECT_EQ(guesses.front().name, name);
    EXPECT_LT(guesses.front().error_deg, kSureGuess_deg);
  }
}

TEST(GuessSensor, IsNotSureOfRingsThatNoPresetHas) {
  RecordingLook look = LookAt(FramesOf("vlp16", 1));
  for (InspectedRing& ring : look.rings) {
    const double turned_deg = ring.elevation_deg.PlainMean() + 5.0;
    ring.elevation_deg = {};
    ring.elevation_deg.Add(turned_deg);
  }
  EXPECT_GT(GuessSensor(look.rings).front().error_deg, kLikelyGuess_deg);
  EXPECT_THAT(LookText(look), HasSubstr("no preset"));
  EXPECT_THAT(LookText(look), HasSubstr("16 rings from -15 to 15 deg, step 0."));
}

TEST(Inspect, SaysAboutWhichAxisASensorSpinsThatDoesNotStand) {
  auto frames = FramesOf("vlp16", 1);
  EXPECT_THAT(LookText(LookAt(frames)), Not(HasSubstr("axis of rotation")));
  Frame& frame = frames.front().frame;
  frame.sensor_from_spin = RotationFromYawPitchRoll(0.0, RadFromDeg(75.0), 0.0);
  const Eigen::Matrix3f rotation = frame.sensor_from_spin->cast<float>();
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    const Eigen::Vector3f turned_m = rotation * Eigen::Vector3f(frame.x[i], frame.y[i], frame.z[i]);
    frame.x[i] = turned_m.x();
    frame.y[i] = turned_m.y();
    frame.z[i] = turned_m.z();
  }
  const RecordingLook look = LookAt(frames);
  EXPECT_EQ(GuessSensor(look.rings).front().name, "VLP-16");
  EXPECT_EQ(FitnessFor("weather", look), Fitness::kWithOption);
  EXPECT_THAT(LookText(look), HasSubstr("[0.966, 0, 0.259]"));
  EXPECT_THAT(LookText(look), HasSubstr("yaw_deg 0, pitch_deg 75"));
}

TEST(Inspect, CountsFramesAndLooksAtNoMoreThanAskedFor) {
  const RecordingLook look = LookAt(FramesOf("vlp16", 4), 3);
  EXPECT_EQ(look.num_frames, 3U);
  EXPECT_TRUE(look.is_cut_short);
  EXPECT_EQ(look.num_grids, 3U);
  EXPECT_FALSE(LookAt(FramesOf("vlp16", 3), 3).is_cut_short);
}

TEST(Inspect, FindsGapsAndDoubledAndTurnedBackStamps) {
  auto frames = FramesOf("vlp16", 8);
  const std::vector<std::int64_t> times_ms = {100, 200, 300, 300, 250, 400, 500, 900};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].frame.stamp_ns = times_ms[i] * 1'000'000;
  }
  const std::string text = LookText(LookAt(std::move(frames)));
  EXPECT_THAT(text, testing::ContainsRegex("gaps +1 "));
  EXPECT_THAT(text, testing::ContainsRegex("doubled stamps +1\n"));
  EXPECT_THAT(text, testing::ContainsRegex("stamps before the one before them +1\n"));
}

TEST(Inspect, FindsADeadAndAWeakRing) {
  auto frames = FramesOf("vlp16");
  for (RecordedFrame& recorded : frames) {
    Frame& frame = recorded.frame;
    for (std::size_t i = 0; i < frame.width(); ++i) {
      frame.x[3 * frame.width() + i] = kNaN;
      if (i % 4 != 0) frame.x[9 * frame.width() + i] = kNaN;
    }
  }
  const std::string text = LookText(LookAt(std::move(frames)));
  EXPECT_THAT(text, testing::ContainsRegex("dead, with under 1 % of the median's points +1 +3\n"));
  EXPECT_THAT(text, testing::ContainsRegex("weak, [^\n]* points +1 +9\n"));
}

TEST(Inspect, FindsABlockedSector) {
  auto frames = FramesOf("vlp16");
  for (RecordedFrame& recorded : frames) {
    Frame& frame = recorded.frame;
    for (std::size_t i = 0; i < frame.num_slots(); ++i) {
      const double azimuth_deg =
          DegFromRad(std::atan2(static_cast<double>(frame.y[i]), static_cast<double>(frame.x[i])));
      if (azimuth_deg > 29.0 && azimuth_deg < 46.0) frame.x[i] = kNaN;
    }
  }
  EXPECT_THAT(LookText(LookAt(std::move(frames))), HasSubstr("30 to 45 deg"));
}

TEST(Inspect, FindsPosesThatJump) {
  auto frames = FramesOf("vlp16");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].has_pose = true;
    frames[i].frame.stamp_ns = static_cast<std::int64_t>(i + 1) * 100'000'000;
    frames[i].frame.world_from_sensor.translation().x() =
        i < 3 ? 2.0 * static_cast<double>(i) : 500.0;
    // Few points, since clouds of a made scan take long to be laid on one another.
    std::vector<float>& x_m = frames[i].frame.x;
    for (std::size_t k = 0; k < x_m.size(); ++k) x_m[k] = k % 20 == 0 ? x_m[k] : kNaN;
  }
  const std::string text = LookText(LookAt(std::move(frames)));
  EXPECT_THAT(text, testing::ContainsRegex("highest speed from frame to frame +4960 m/s +a jump"));
}

/// What is odd of each frame: "0: has ...; 3: has ...".
std::string OddOf(const RecordingLook& look) {
  std::string text;
  for (std::size_t i = 0; i < look.frames.size(); ++i) {
    for (const std::string& odd : look.frames[i].odd) {
      text += (text.empty() ? "" : "; ") + std::to_string(i) + ": " + odd;
    }
  }
  return text;
}

/// Takes the points of a ring out of a frame, as if it had been without them when rows were told
/// by elevations.
void LoseRing(std::size_t lost, RecordedFrame& recorded) {
  const Frame whole = recorded.frame;
  Frame& frame = recorded.frame;
  frame.Resize(whole.rows - 1, whole.columns, whole.returns);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const std::size_t row = slot / whole.width();
    const std::size_t from = slot + (row >= lost ? whole.width() : 0);
    frame.x[slot] = whole.x[from];
    frame.y[slot] = whole.y[from];
    frame.z[slot] = whole.z[from];
    frame.range_m[slot] = whole.range_m[from];
    frame.intensity[slot] = whole.intensity[from];
    frame.ring[slot] = static_cast<std::uint16_t>(row);
  }
}

void LosePoints(std::size_t kept, RecordedFrame& recorded) {
  Frame& frame = recorded.frame;
  std::size_t num = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!std::isnan(frame.x[slot]) && ++num > kept) frame.x[slot] = kNaN;
  }
}

TEST(InspectFrames, NamesNoneWhereAllAreAlike) {
  for (const char* const sensor : {"vlp16", "xt32", "pandar64"}) {
    EXPECT_EQ(OddOf(LookAt(FramesOf(sensor, 8))), "") << sensor;
  }
}

// Of any kind, at any place, up to almost half of them.
TEST(InspectFrames, NamesThoseWithOtherPointsOrRings) {
  for (const std::vector<std::size_t>& odd :
       {std::vector<std::size_t>{0}, {7}, {2, 3, 4}, {0, 5, 8}}) {
    auto frames = FramesOf("vlp16", 9);
    for (const std::size_t i : odd) LosePoints(200, frames[i]);
    const RecordingLook look = LookAt(std::move(frames));
    EXPECT_THAT(OddOf(look), testing::StartsWith(std::to_string(odd.front()) +
                                                 ": has 200 points, where others have "));
    for (std::size_t i = 0; i < look.frames.size(); ++i) {
      EXPECT_EQ(look.frames[i].has_odd_points, std::ranges::count(odd, i) > 0) << i;
    }
    auto with_ring_lost = FramesOf("vlp16", 9);
    for (const std::size_t i : odd) LoseRing(5, with_ring_lost[i]);
    EXPECT_THAT(OddOf(LookAt(with_ring_lost)),
                testing::StartsWith(std::to_string(odd.front()) +
                                    ": has 15 rings with points, where others have 16"));
  }
}

TEST(InspectFrames, LeaveTheSensorToTheOthers) {
  for (const std::size_t ring : {0U, 5U, 15U}) {
    for (const std::size_t num_odd : {1U, 3U}) {
      auto frames = FramesOf("vlp16", 8);
      for (std::size_t i = 0; i < num_odd; ++i) LoseRing(ring, frames[2 * i]);
      const RecordingLook look = LookAt(std::move(frames));
      const auto guesses = GuessSensor(look.rings);
      EXPECT_EQ(guesses.front().name, "VLP-16");
      EXPECT_LT(guesses.front().error_deg, 0.01);
      EXPECT_EQ(look.sensor.found->pattern.channels.size(), 16U);
    }
  }
}

// Of the first frames that are searched, all may be odd though most of the recording is not.
TEST(InspectFrames, ShowTheSensorHoweverManyOfTheFirstAreOdd) {
  for (const std::size_t num_odd : {19U, 20U, 22U}) {
    SCOPED_TRACE(num_odd);
    auto frames = FramesOf("vlp16", 45);
    for (std::size_t i = 0; i < num_odd; ++i) {
      std::vector<float>& x_m = frames[i].frame.x;
      // Half of the points, wherever they are.
      for (std::uint32_t slot = 0; slot < x_m.size(); ++slot) {
        if (RandomWords(8, RandomUse::kNoise, 0, slot)[0] % 2 == 0) x_m[slot] = kNaN;
      }
    }
    const RecordingLook look = LookAt(std::move(frames));
    EXPECT_EQ(std::ranges::count(look.frames, true, &InspectedFrame::has_odd_points),
              static_cast<std::ptrdiff_t>(num_odd));
    ASSERT_TRUE(look.sensor.found) << look.sensor.why_not;
    EXPECT_EQ(look.sensor.found->pattern.channels.size(), 16U);
    EXPECT_EQ(GuessSensor(look.rings).front().name, "VLP-16");
  }
}

TEST(InspectFrames, NamesCopiesDoubledAndMissingPoints) {
  auto frames = FramesOf("vlp16", 6);
  frames[3].frame.x = frames[2].frame.x;
  frames[3].frame.y = frames[2].frame.y;
  frames[3].frame.z = frames[2].frame.z;
  frames[3].frame.intensity = frames[2].frame.intensity;
  for (RecordedFrame& recorded : frames) {
    for (std::uint32_t slot = 0; slot < recorded.frame.num_slots(); ++slot) {
      if (!std::isnan(recorded.frame.x[slot])) recorded.slot_of_entry.push_back(slot);
    }
  }
  frames[5].slot_of_entry.insert(frames[5].slot_of_entry.end(), 40, kNoSlot);
  Frame& doubled = frames[0].frame;
  std::size_t last = 0;
  for (std::size_t slot = 1; slot < 1000; ++slot) {
    for (auto* const of : {&doubled.x, &doubled.y, &doubled.z}) (*of)[slot] = (*of)[last];
    if (slot % 2 == 0) last = slot + 1;
  }
  const std::string odd = OddOf(LookAt(frames));
  EXPECT_THAT(odd, testing::ContainsRegex("0: has [0-9]+ doubled points, where others have 0"));
  EXPECT_THAT(odd, HasSubstr("3: has the same points as frame 2"));
  EXPECT_THAT(odd, HasSubstr("5: has 40 points without a position, where others have 0"));
  const std::string text = LookText(LookAt(frames));
  EXPECT_THAT(text, HasSubstr("3 of 6 frames are unlike the others: they come first."));
  EXPECT_THAT(text, HasSubstr("what is odd of single frames is above."));
}

TEST(InspectFrames, AllowFewDoubledOrMissingPointsWhereOthersHaveNone) {
  for (const std::size_t num : {1U, 4U, 5U, 40U}) {
    for (const std::size_t odd : {0U, 3U, 5U}) {
      SCOPED_TRACE(num);
      auto doubled = FramesOf("vlp16", 6);
      Frame& frame = doubled[odd].frame;
      const auto first = static_cast<std::size_t>(
          std::ranges::find_if(frame.x, [](float x) { return !std::isnan(x); }) - frame.x.begin());
      std::size_t num_copies = 0;
      for (std::size_t slot = first + 1; num_copies < num; ++slot) {
        if (std::isnan(frame.x[slot])) continue;
        for (auto* const of : {&frame.x, &frame.y, &frame.z}) (*of)[slot] = (*of)[first];
        ++num_copies;
      }
      EXPECT_EQ(OddOf(LookAt(std::move(doubled))),
                num < 5 ? ""
                        : std::to_string(odd) + ": has " + std::to_string(num) +
                              " doubled points, where others have 0");
      auto missing = FramesOf("vlp16", 6);
      missing[odd].slot_of_entry.assign(num, kNoSlot);
      EXPECT_EQ(OddOf(LookAt(std::move(missing))),
                num < 5 ? ""
                        : std::to_string(odd) + ": has " + std::to_string(num) +
                              " points without a position, where others have 0");
    }
  }
}

TEST(InspectFrames, NamesGapsOfTime) {
  auto frames = FramesOf("vlp16", 8);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].frame.stamp_ns = static_cast<std::int64_t>(i + (i >= 5 ? 3 : 1)) * 100'000'000;
  }
  EXPECT_EQ(OddOf(LookAt(std::move(frames))),
            "5: comes 0.3 s after the last, where others come 0.1 s after theirs");
}

TEST(Inspect, RemarksOnlyOnFiguresToWhichTheyApply) {
  auto frames = FramesOf("vlp16");
  for (RecordedFrame& recorded : frames) {
    Frame& frame = recorded.frame;
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      if (frame.range_m[slot] < 1.0F) frame.x[slot] = kNaN;
      frame.intensity[slot] = 0.001F * static_cast<float>(slot % 1000);
    }
  }
  const std::string clean = LookText(LookAt(frames));
  EXPECT_THAT(clean, testing::ContainsRegex("nearer than 0.5 m +0 % *\n"));
  EXPECT_THAT(clean, testing::ContainsRegex("intensity as high as any +0.[0-9]+ % *\n"));
  for (RecordedFrame& recorded : frames) {
    for (std::size_t slot = 0; slot < recorded.frame.num_slots(); slot += 50) {
      recorded.frame.range_m[slot] = 0.3F;
      recorded.frame.intensity[slot] = 1.0F;
    }
  }
  const std::string spoilt = LookText(LookAt(frames));
  EXPECT_THAT(spoilt, HasSubstr("dirt on the window"));
  EXPECT_THAT(spoilt, HasSubstr("a large share: they are saturated"));
}

TEST(JobsOf, TellsWhatIsMissingForWhat) {
  const RecordingLook grid = LookAt(FramesOf("vlp16"));
  EXPECT_EQ(FitnessFor("stats", grid), Fitness::kYes);
  EXPECT_EQ(FitnessFor("weather", grid), Fitness::kWithOption);
  EXPECT_EQ(FitnessFor("evaluate", grid), Fitness::kNo);
  EXPECT_EQ(FitnessFor("fit", grid), Fitness::kWithOption);
  auto frames = FramesOf("vlp16");
  for (RecordedFrame& recorded : frames) {
    recorded.is_grid = false;
    recorded.why_no_grid = "it has no rings";
  }
  const RecordingLook loose = LookAt(std::move(frames));
  EXPECT_EQ(FitnessFor("weather", loose), Fitness::kNo);
  EXPECT_EQ(FitnessFor("insert", loose), Fitness::kWithOption);
  EXPECT_EQ(FitnessFor("fit", loose), Fitness::kNo);
  EXPECT_THAT(LookText(loose), HasSubstr("it has no rings"));
}

TEST(JobsOf, IsNoForEverythingWithoutAPoint) {
  auto frames = FramesOf("vlp16", 1);
  for (float& x : frames[0].frame.x) x = kNaN;
  for (const JobFitness& job : JobsOf(LookAt(std::move(frames)), {})) {
    EXPECT_EQ(job.fitness, Fitness::kNo) << job.job;
  }
}

}  // namespace
}  // namespace railcast
