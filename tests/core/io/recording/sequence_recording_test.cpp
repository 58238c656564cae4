#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "core/io/content_hash.h"
#include "core/io/recording/firing_truth.h"
#include "railcast/io/recording.h"
#include "tests/core/io/damage.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/made_sequence.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

// Compares bits, so that NaN equals itself.
template <typename Values>
bool AreSame(const Values& a, const Values& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

void ExpectSameShape(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.rows, b.rows);
  EXPECT_EQ(a.columns, b.columns);
  EXPECT_EQ(a.returns, b.returns);
  ASSERT_EQ(a.num_slots(), b.num_slots());
}

void ExpectSameHead(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.stamp_ns, b.stamp_ns);
  EXPECT_EQ(a.duration_ns, b.duration_ns);
  // The poses were written as quaternions with all digits.
  EXPECT_TRUE(a.world_from_sensor.isApprox(b.world_from_sensor, 1e-12));
  EXPECT_TRUE(a.world_from_sensor_end.isApprox(b.world_from_sensor_end, 1e-12));
  ASSERT_EQ(a.poses_between.size(), b.poses_between.size());
  for (std::size_t i = 0; i < a.poses_between.size(); ++i) {
    EXPECT_EQ(a.poses_between[i].time_ns, b.poses_between[i].time_ns);
    EXPECT_TRUE(
        a.poses_between[i].world_from_sensor.isApprox(b.poses_between[i].world_from_sensor, 1e-12));
  }
}

TEST(SequenceRecording, GivesBackTheFramesOfASensorThatDoesNotRepeat) {
  const TemporaryDirectory directory;
  for (const char* format : {"pcd", "pcd-ascii"}) {
    const auto made = MakeSequence(directory.path() / format,
                                   {.format = format, .sensor = "tele15_like", .start_frame = 7});
    const auto frames = ReadAll(*OpenRecording(directory.path() / format));
    ASSERT_EQ(frames.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      ExpectSameHead(frames[i].frame, made.frames[i]);
      ExpectSameShape(frames[i].frame, made.frames[i]);
      EXPECT_TRUE(AreSame(frames[i].frame.x, made.frames[i].x));
      EXPECT_TRUE(AreSame(frames[i].frame.y, made.frames[i].y));
      EXPECT_TRUE(AreSame(frames[i].frame.z, made.frames[i].z));
      EXPECT_EQ(frames[i].frame.time_ns, made.frames[i].time_ns);
      EXPECT_EQ(frames[i].frame.ring, made.frames[i].ring);
    }
    EXPECT_FALSE(AreSame(frames[0].frame.y, frames[1].frame.y));
  }
}

class OrganisedFormat : public testing::TestWithParam<const char*> {};

TEST_P(OrganisedFormat, GivesBackEveryFieldOfEverySlot) {
  const TemporaryDirectory directory;
  const auto made = MakeSequence(directory.path() / "run", {.format = GetParam()});
  const auto recording = OpenRecording(directory.path() / "run");
  EXPECT_EQ(recording->info().kind, "sequence");
  EXPECT_EQ(recording->info().num_frames, 2U);
  ASSERT_TRUE(recording->info().scenario.has_value());
  EXPECT_EQ(recording->info().labels.labels(), made.scenario.labels);
  EXPECT_EQ(recording->info().materials.at(0), "none");
  EXPECT_EQ(recording->info().materials.at(1), made.scenario.materials.at(0).name);
  const auto frames = ReadAll(*recording);
  ASSERT_EQ(frames.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(frames[i].is_grid);
    EXPECT_TRUE(frames[i].has_pose);
    ExpectSameHead(frames[i].frame, made.frames[i]);
    ExpectSameShape(frames[i].frame, made.frames[i]);
    std::vector<std::string> differing;
    ForEachField(frames[i].frame, [&](std::string_view name, std::string_view, const auto& values) {
      EXPECT_TRUE(frames[i].Has(name)) << name;
      ForEachField(made.frames[i],
                   [&](std::string_view other, std::string_view, const auto& truth) {
                     if constexpr (std::is_same_v<decltype(values), decltype(truth)>) {
                       if (name == other && !AreSame(values, truth)) differing.emplace_back(name);
                     }
                   });
    });
    EXPECT_THAT(differing, testing::IsEmpty());
  }
}

TEST_P(OrganisedFormat, GivesBackVelocities) {
  const TemporaryDirectory directory;
  const auto made =
      MakeSequence(directory.path() / "run", {.format = GetParam(), .has_velocity = true});
  const auto frames = ReadAll(directory.path() / "run");
  ASSERT_EQ(frames.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_TRUE(frames[i].frame.has_velocity);
    EXPECT_TRUE(AreSame(frames[i].frame.radial_velocity_mps, made.frames[i].radial_velocity_mps));
    EXPECT_TRUE(
        AreSame(frames[i].frame.true_radial_velocity_mps, made.frames[i].true_radial_velocity_mps));
  }
}

INSTANTIATE_TEST_SUITE_P(SequenceRecording,
                         OrganisedFormat,
                         testing::Values("pcd", "pcd-compressed", "pcd-ascii"));

class PointFormat : public testing::TestWithParam<const char*> {};

// PLY holds only points, so the outcome of firings without a point is lost, and only that.
TEST_P(PointFormat, PutsPointsBackIntoTheirSlots) {
  const TemporaryDirectory directory;
  const auto made =
      MakeSequence(directory.path() / "run",
                   {.format = GetParam(), .fidelity = "footprint", .return_mode = "dual"});
  const auto frames = ReadAll(directory.path() / "run");
  ASSERT_EQ(frames.size(), 2U);
  for (std::size_t f = 0; f < 2; ++f) {
    const Frame& truth = made.frames[f];
    const Frame& frame = frames[f].frame;
    ASSERT_EQ(truth.returns, 2U);
    ExpectSameHead(frame, truth);
    ExpectSameShape(frame, truth);
    EXPECT_TRUE(frames[f].is_grid);
    EXPECT_TRUE(frames[f].Has("outcome"));
    EXPECT_FALSE(HasAllOutcomes(frames[f]));
    std::size_t num_seconds = 0;
    for (std::size_t i = 0; i < truth.num_slots(); ++i) {
      ASSERT_EQ(frame.ring[i], truth.ring[i]);
      ASSERT_EQ(frame.column[i], truth.column[i]);
      ASSERT_EQ(frame.time_ns[i], truth.time_ns[i]);
      ASSERT_EQ(frame.return_index[i], truth.return_index[i]);
      ASSERT_EQ(frame.return_count[i], truth.return_count[i]);
      ASSERT_EQ(std::isnan(frame.x[i]), std::isnan(truth.x[i]));
      if (std::isnan(truth.x[i])) continue;
      ASSERT_EQ(frame.x[i], truth.x[i]);
      ASSERT_EQ(frame.label[i], truth.label[i]);
      ASSERT_EQ(frame.outcome[i], truth.outcome[i]);
      ASSERT_EQ(frame.range_m[i], truth.range_m[i]);
      num_seconds += truth.return_index[i];
    }
    EXPECT_GT(num_seconds, 20U);
  }
}

INSTANTIATE_TEST_SUITE_P(SequenceRecording,
                         PointFormat,
                         testing::Values("ply", "ply-cloudcompare"),
                         [](const auto& test) {
                           return std::string(test.param) == "ply" ? "ply" : "cloudcompare";
                         });

struct Output {
  const char* json;
  const char* format;
  const char* fields;
};

class OutputAxesOf : public testing::TestWithParam<Output> {};

TEST_P(OutputAxesOf, AreTurnedBackIntoTheSensorsOwn) {
  const TemporaryDirectory directory;
  const auto truth = MakeSequence(directory.path() / "sensor", {}).frames;
  MadeSequenceSpec spec;
  spec.format = GetParam().format;
  spec.fields = GetParam().fields;
  spec.output = GetParam().json;
  (void)MakeSequence(directory.path() / "other", spec);
  const auto frames = ReadAll(directory.path() / "other");
  ASSERT_EQ(frames.size(), 2U);
  // World coordinates reach 1000 m here, where float32 has steps of 0.06 mm in each axis. Speed and
  // radius are constant, so ScanMotion neglects only the sagitta of the path between poses,
  // (20 m/s x 0.02 s)^2 / (8 x 500 m) = 0.04 mm.
  constexpr double kTolerance_m = 3 * 0.06e-3 + 0.04e-3;
  for (std::size_t f = 0; f < 2; ++f) {
    const Frame& frame = frames[f].frame;
    ExpectSameShape(frame, truth[f]);
    std::size_t num_points = 0;
    for (std::size_t i = 0; i < frame.num_slots(); ++i) {
      ASSERT_EQ(std::isnan(frame.x[i]), std::isnan(truth[f].x[i]));
      if (std::isnan(frame.x[i])) continue;
      ASSERT_NEAR(frame.x[i], truth[f].x[i], kTolerance_m);
      ASSERT_NEAR(frame.y[i], truth[f].y[i], kTolerance_m);
      ASSERT_NEAR(frame.z[i], truth[f].z[i], kTolerance_m);
      ASSERT_NEAR(frame.range_m[i], truth[f].range_m[i], 2 * kTolerance_m);
      ++num_points;
    }
    EXPECT_GT(num_points, 10'000U);
  }
}

constexpr const char* kWorld = R"({"frame": "world", "origin_m": [100, 50, 400]})";
INSTANTIATE_TEST_SUITE_P(
    SequenceRecording,
    OutputAxesOf,
    testing::Values(Output{R"({"frame": "sensor", "handedness": "left"})", "pcd", "all"},
                    Output{R"({"frame": "vehicle"})", "pcd", "all"},
                    Output{R"({"frame": "vehicle", "handedness": "left"})", "ply", "all"},
                    Output{kWorld, "pcd", "all"},
                    Output{kWorld, "ply-cloudcompare", "all"},
                    Output{kWorld, "pcd", "x,y,z"},
                    Output{R"({"frame": "world", "handedness": "left"})", "pcd", "all"}));

TEST(SequenceRecording, LacksTheFieldsThatWereLeftOut) {
  const TemporaryDirectory directory;
  const auto made = MakeSequence(directory.path() / "run", {.fields = "x,y,z,label"});
  const auto frames = ReadAll(directory.path() / "run");
  EXPECT_THAT(frames.at(0).fields,
              testing::UnorderedElementsAre("x", "y", "z", "label", "range_m", "ring", "column",
                                            "return_index", "return_count"));
  const Frame& frame = frames[0].frame;
  EXPECT_EQ(frame.label, made.frames[0].label);
  EXPECT_EQ(frame.ring, made.frames[0].ring);
  EXPECT_TRUE(std::ranges::all_of(frame.intensity, [](float value) { return std::isnan(value); }));
  EXPECT_TRUE(std::ranges::all_of(frame.time_ns, [](std::uint32_t value) { return value == 0; }));
}

TEST(SequenceRecording, SaysWhatWasSeenOfEveryObject) {
  const TemporaryDirectory directory;
  (void)MakeSequence(directory.path() / "run", {.fields = "x,y,z"});
  const auto frames = ReadAll(directory.path() / "run");
  for (std::uint32_t i = 0; i < 2; ++i) {
    ASSERT_EQ(frames.at(i).objects.size(), 1U);
    const RecordedObject& wagon = frames[i].objects[0];
    EXPECT_EQ(wagon.name, "wagon");
    EXPECT_EQ(wagon.type, "open_wagon");
    EXPECT_EQ(wagon.label, "wagon");
    EXPECT_EQ(wagon.points, 7 + i);
    EXPECT_EQ(wagon.points_time_ns, 1000 + i);
    EXPECT_EQ(wagon.firings_visible, 9U);
    EXPECT_EQ(wagon.firings_alone, 11U);
    EXPECT_EQ(wagon.occlusion, 1.0 - 9.0 / 11.0);
    EXPECT_TRUE(wagon.size_m.isApprox(Vector3(14.0, 3.0, 3.4)));
    EXPECT_TRUE(
        wagon.sensor_from_box.translation().isApprox(Vector3(40.0 - 2.0 * i, 1.0, 0.5), 1e-9));
  }
}

TEST(SequenceRecording, OfAnInterruptedRunHasTheFramesThatAreDone) {
  for (const char* format : {"pcd", "kitti"}) {
    const TemporaryDirectory directory;
    const auto run = directory.path() / "run";
    (void)MakeSequence(run, {.format = format});
    std::filesystem::remove(run / "manifest.json");
    const std::string lines = ReadFileWhole(run / "frames.jsonl");
    WriteFileWhole(run / "frames.jsonl", lines.substr(0, lines.size() - 1));
    const auto recording = OpenRecording(run);
    EXPECT_EQ(recording->info().num_frames, 1U);
    EXPECT_FALSE(recording->info().origin->is_finished);
    EXPECT_EQ(ReadAll(*recording).size(), 1U);
  }
}

TEST(SequenceRecording, SaysByWhomItWasMade) {
  for (const char* format : {"pcd", "kitti"}) {
    const TemporaryDirectory directory;
    const auto made = MakeSequence(directory.path() / "run", {.format = format});
    const auto recording = OpenRecording(directory.path() / "run");
    ASSERT_TRUE(recording->info().origin.has_value());
    const SequenceOrigin& origin = *recording->info().origin;
    EXPECT_EQ(origin.version, "0.1.0");
    EXPECT_EQ(origin.embree, "3.13.5");
    EXPECT_EQ(origin.isa, "avx2");
    EXPECT_EQ(origin.scenario_hash, IdentityOf(made.scenario).scenario_hash);
    EXPECT_EQ(origin.data_hash.size(), 16U);
    EXPECT_TRUE(origin.is_finished);
    EXPECT_FALSE(origin.has_commands);
  }
}

// Returns the error of reading an unfinished run, whose lines no manifest vouches for, after a
// change to one file. A frame's hash in frames.jsonl is adapted to the change.
std::string MessageAfter(const char* file, const std::string& from, const std::string& to) {
  const TemporaryDirectory directory;
  const auto run = directory.path() / "run";
  (void)MakeSequence(run, {.fields = "x,y,z"});
  std::filesystem::remove(run / "manifest.json");
  if (std::string(file).ends_with(".pcd") && to != "gone") {
    const std::string before = ReadFileWhole(run / file);
    const std::string after = Replaced(before, from, to);
    WriteFileWhole(run / file, after);
    WriteFileWhole(run / "frames.jsonl", Replaced(ReadFileWhole(run / "frames.jsonl"),
                                                  ContentHash(before), ContentHash(after)));
  } else if (to == "gone") {
    std::filesystem::remove(run / file);
  } else {
    WriteFileWhole(run / file, Replaced(ReadFileWhole(run / file), from, to));
  }
  const std::string message = MessageOf([&] { (void)ReadAll(run); });
  const std::string place = run.string() + "/";
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  return message.starts_with(place) ? message.substr(place.size()) : message;
}

TEST(SequenceRecording, NamesWhatIsDamaged) {
  EXPECT_EQ(MessageAfter("frames/000001.pcd", "", "gone"),
            "frames/000001.pcd: no such file or directory");
  EXPECT_EQ(MessageAfter("frames/000001.pcd", "WIDTH 240\nHEIGHT 120", "WIDTH 120\nHEIGHT 240"),
            "frames/000001.pcd: WIDTH x HEIGHT: must be 240 per return x 120, as the scenario says "
            "(got 120 x 240)");
  EXPECT_EQ(MessageAfter("frames/000000.pcd", "FIELDS x y z", "FIELDS x y w"),
            "frames/000000.pcd: has no field z");
  EXPECT_EQ(MessageAfter("frames.jsonl", "{\"frame\":0", "{\"frme\":0"),
            "frames.jsonl:1: /frme: unknown key, the nearest is \"frame\"");
  EXPECT_EQ(MessageAfter("poses.csv", "\n100000000,", "\n100000001,"),
            "poses.csv:3: stamp_ns: must be 100000000, as in frames.jsonl or insert.jsonl (got "
            "100000001)");
  EXPECT_EQ(MessageAfter("poses.csv", "\n100000000,", "\n100000000,1,"),
            "poses.csv:3: a pose must have seven numbers (got 8)");
  EXPECT_EQ(MessageAfter("objects.jsonl", "{\"frame\":1", "{\"frame\":2"),
            "objects.jsonl:2: frame: must be 1, as in frames.jsonl or insert.jsonl (got 2)");
  EXPECT_EQ(
      MessageAfter("objects.jsonl", "\"occlusion\":0", "\"occlusion\":-4"),
      "objects.jsonl:1: /objects/0/occlusion: must be >= 0 and <= 1 (got -4.181818181818182)");
  EXPECT_EQ(
      MessageAfter("objects.jsonl", "\"occlusion\":0.18181818181818177", "\"occlusion\":null"),
      "objects.jsonl:1: /objects/0/occlusion: must be a number (got null)");
  EXPECT_EQ(MessageAfter("objects.jsonl", "\"firings_visible\":9", "\"firings_visible\":12"),
            "objects.jsonl:1: /objects/0/firings_visible: must be <= firings_alone, 11 (got 12)");
  EXPECT_EQ(
      MessageAfter("objects.jsonl", "\"firings_visible\":9,\"firings_alone\":11",
                   "\"firings_visible\":0,\"firings_alone\":0"),
      "objects.jsonl:1: /objects/0/occlusion: must be null, as no firing would meet the object "
      "even alone (got 0.18181818181818177)");
  EXPECT_EQ(
      MessageAfter("frames.jsonl", "\"scan_poses\":[{\"time_ns\":19",
                   "\"scan_poses\":[{\"time_ns\":99"),
      "frames.jsonl:1: /scan_poses/1/time_ns: must be > that before, 99916666 (got 39833333)");
  EXPECT_EQ(MessageAfter("labels.json", "", "gone"), "labels.json: no such file");
  EXPECT_EQ(MessageAfter("run.json", "\"version\"", "\"verzion\""),
            "run.json: /verzion: unknown key, the nearest is \"version\"");
  EXPECT_EQ(MessageAfter("frames.jsonl", "frames/000001.pcd", "../../../01.pcd"),
            "frames.jsonl: must name files of a sequence (got ../../../01.pcd)");
}

}  // namespace
}  // namespace railcast
