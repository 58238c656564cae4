// `--format osi` and `--format osi-mcap`: the frames of a run as messages of OSI.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/extras/osi/trace_file.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/mcap/byte_file.h"
#include "core/extras/ros/mcap/mcap_index.h"
#include "core/extras/ros/mcap/record_codec.h"
#include "core/extras/ros/mcap/record_scan.h"
#include "core/io/write_file.h"
#include "generator/extras/osi/sensor_view.h"
#include "tests/core/io/damage.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/generator/extras/osi/example_view.h"
#include "tests/generator/extras/osi/true_messages.h"
#include "tests/generator/sequence/sequence_runs.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kLightInVacuum_mps = 299'792'458.0;

// A train of two vehicles that runs behind a wagon in a curve, past a person and a crate.
std::string Traffic() {
  return R"({
    "version": 1, "fidelity": "surface",
    "lidar": {"name": "front", "range_max_m": 150,
              "scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 40,
                       "vertical_fov_deg": 16, "angular_resolution_deg": 1}},
              "mount": {"position_m": [4.5, 0.5, 2.5], "yaw_deg": 3, "pitch_deg": 4, "roll_deg": -2}},
    "world": {
      "alignment": {"course": {"type": "elements", "elements": [
        {"type": "arc", "length_m": 1000, "radius_m": 700}]}},
      "vegetation": {"trees_per_hectare": 0, "grass": false},
      "objects": [
        {"name": "ahead", "type": "flat_wagon", "s_m": 460,
         "motion": {"profile": [{"time_s": 0, "speed_mps": 12}]}},
        {"name": "walker", "type": "person", "s_m": 430, "d_m": 4},
        {"name": "crate", "type": "box", "s_m": 425, "d_m": -4, "size_m": [1, 2, 1.5]}]
    },
    "vehicle": {"start_s_m": 400, "motion": {"profile": [{"time_s": 0, "speed_mps": 20}]},
                "consist": [{"type": "multiple_unit"}, {"type": "multiple_unit"}]},
    "weather": {"rain_rate_mmph": 3, "sun": {"illuminance_klx": 50}},
    "materials": ")" +
         kScenariosFolder + R"(materials/railway.json",
    "labels": ")" +
         kScenariosFolder + R"(labels.json"
  })";
}

std::vector<std::string> MessagesIn(const fs::path& trace) {
  std::vector<std::string> messages;
  const auto add = [&](mcap::ByteSpan bytes) {
    messages.emplace_back(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  if (trace.extension() == ".osi") {
    osi::SingleChannelReader reader(trace);
    while (const auto message = reader.Next()) add(*message);
  } else {
    const auto reader = bag::OpenBag(trace);
    while (const auto message = reader->Next()) add(message->data);
  }
  return messages;
}

std::vector<osi3::SensorView> ViewsIn(const fs::path& trace) {
  std::vector<osi3::SensorView> views;
  for (const std::string& message : MessagesIn(trace)) {
    EXPECT_TRUE(views.emplace_back().ParseFromString(message));
  }
  return views;
}

class OsiTraces : public SequenceRuns {
 protected:
  OsiTraces() : SequenceRuns(5) {}

  // The name of the trace of the project's sensor.
  [[nodiscard]] static std::string Trace(const std::string& extension,
                                         const std::string& sensor = "beams",
                                         int num_frames = 5) {
    std::string version = osi::ProtobufVersion();
    std::erase(version, '.');
    return "19700101T000000Z_sv_380_" + version + "_" + std::to_string(num_frames) + "_" + sensor +
           extension;
  }
  void UseTraffic() const { WriteFileWhole(scenario_, Traffic()); }
};

TEST_F(OsiTraces, HaveAMessageForEachFrameInEitherFormat) {
  const fs::path single = Make("osi", "--format osi " + frames_);
  const fs::path multi = Make("mcap", "--format osi-mcap " + frames_);
  const std::vector<std::string> messages = MessagesIn(single / Trace(".osi"));
  EXPECT_EQ(messages.size(), 5U);
  EXPECT_EQ(messages, MessagesIn(multi / Trace(".mcap")));
  EXPECT_THAT(FaultsOf(single), ElementsAre());
  EXPECT_THAT(FaultsOf(multi), ElementsAre());
}

// As the standard demands it of its multi-channel traces.
TEST_F(OsiTraces, OfMcapSayWhatTheyAre) {
  const fs::path trace = Make("mcap", "--format osi-mcap " + frames_) / Trace(".mcap");
  const mcap::ByteFile file(trace, "trace");
  const mcap::McapIndex index = mcap::ReadIndex(file);
  const std::string version = osi::ProtobufVersion();
  ASSERT_EQ(index.metadata.size(), 1U);
  EXPECT_EQ(index.metadata[0].name, "net.asam.osi.trace");
  const auto place = mcap::RecordAt(file, index.metadata[0].offset);
  const mcap::Bytes content = mcap::ContentOf(file, *place);
  EXPECT_THAT(
      mcap::ReadRecord<mcap::McapMetadata>(content).metadata,
      ElementsAre(std::pair("max_osi_version", "3.8.0"), std::pair("max_protobuf_version", version),
                  std::pair("min_osi_version", "3.8.0"), std::pair("min_protobuf_version", version),
                  std::pair("version", "3.8.0"), std::pair("zero_time", "1970-01-01T00:00:00Z")));
  ASSERT_EQ(index.schemas.size(), 1U);
  const mcap::McapSchema& schema = index.schemas.begin()->second;
  EXPECT_EQ(schema.name, "osi3.SensorView");
  EXPECT_EQ(schema.encoding, "protobuf");
  EXPECT_EQ(schema.data, osi::SensorViewDescriptors());
  ASSERT_EQ(index.channels.size(), 1U);
  const mcap::McapChannel& channel = index.channels.begin()->second;
  EXPECT_EQ(channel.topic, "beams.SensorView");
  EXPECT_EQ(channel.message_encoding, "protobuf");
  EXPECT_THAT(channel.metadata,
              ElementsAre(std::pair("net.asam.osi.trace.channel.osi_version", "3.8.0"),
                          std::pair("net.asam.osi.trace.channel.protobuf_version", version)));
  EXPECT_EQ(index.chunks.size(), 5U);
  EXPECT_EQ(index.statistics.message_start_time, 0U);
  EXPECT_EQ(index.statistics.message_end_time, 400'000'000U);
}

TEST_F(OsiTraces, AreReadByTheDefinitionsOfTheStandard) {
  if (!exists(osi::kTrueProtos)) GTEST_SKIP() << osi::kTrueProtos << " is not there";
  UseTraffic();
  osi::TrueMessages truth;
  const auto messages =
      MessagesIn(Make("osi", "--format osi --frames 2") / Trace(".osi", "front", 2));
  ASSERT_EQ(messages.size(), 2U);
  for (const std::string& bytes : messages) {
    const auto message = truth.Parse(bytes);
    EXPECT_EQ(osi::CountUnknown(*message), 0);
    EXPECT_EQ(message->SerializeAsString(), bytes);
  }
}

TEST_F(OsiTraces, GiveBackThePointsOfTheFiles) {
  UseTraffic();
  const auto views = ViewsIn(Make("osi", "--format osi --frames 3") / Trace(".osi", "front", 3));
  const auto frames = ReadAll(Make("pcd", "--format pcd --frames 3"));
  ASSERT_EQ(views.size(), frames.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Frame& frame = frames[i].frame;
    const auto& lidar = views[i].lidar_sensor_view(0);
    ASSERT_EQ(lidar.reflection_size(), static_cast<int>(frame.num_slots()));
    std::size_t num_points = 0;
    for (int ray = 0; ray < lidar.reflection_size(); ++ray) {
      // Rows from the top; the raster's columns begin on the left.
      const std::uint32_t row = frame.rows - 1 - static_cast<std::uint32_t>(ray) / frame.columns;
      const std::size_t slot =
          std::size_t{row} * frame.columns + static_cast<std::uint32_t>(ray) % frame.columns;
      const auto& reflection = lidar.reflection(ray);
      ASSERT_EQ(reflection.has_time_of_flight(), HasPoint(frame.outcome[slot])) << slot;
      if (!reflection.has_time_of_flight()) continue;
      ++num_points;
      const Vector3 point = 0.5 * kLightInVacuum_mps * reflection.time_of_flight() *
                            osi::VectorOf(lidar.view_configuration().directions(ray));
      // Coordinates up to 150 m, directions and ranges are floats.
      constexpr double kTolerance_m = 4 * 150.0 * 6e-8;
      EXPECT_NEAR((point - Vector3(frame.x[slot], frame.y[slot], frame.z[slot])).norm(), 0.0,
                  kTolerance_m);
    }
    EXPECT_GT(num_points, 100U);
    EXPECT_LT(num_points, frame.num_slots());
  }
}

TEST_F(OsiTraces, KeepAsManyRaysWithoutAReturnAsFramesCount) {
  UseTraffic();
  const fs::path out = Make("osi", "--format osi --frames 1");
  const auto view = ViewsIn(out / Trace(".osi", "front", 1)).at(0);
  const auto counts = nlohmann::json::parse(ReadFileWhole(out / "frames.jsonl"))["outcomes"];
  int num_empty = 0;
  for (const auto& reflection : view.lidar_sensor_view(0).reflection()) {
    if (reflection.ByteSizeLong() == 0) ++num_empty;
  }
  int num_without = 0;
  for (const auto& [name, count] : counts.items()) {
    if (name != "returned" && name != "clutter") num_without += count.get<int>();
  }
  EXPECT_GT(num_without, 0);
  EXPECT_EQ(num_empty, num_without);
}

TEST_F(OsiTraces, HaveTheObjectsOfTheFrames) {
  UseTraffic();
  const fs::path out = Make("osi", "--format osi --frames 1");
  const auto truth = ViewsIn(out / Trace(".osi", "front", 1)).at(0).global_ground_truth();
  std::map<std::string, osi3::BaseMoving> boxes;
  for (const auto& object : truth.moving_object()) {
    boxes[object.source_reference(0).identifier(0)] = object.base();
  }
  for (const auto& object : truth.stationary_object()) {
    osi3::BaseMoving base;
    ASSERT_TRUE(base.ParseFromString(object.base().SerializeAsString()));
    boxes[object.source_reference(0).identifier(0)] = base;
  }
  EXPECT_EQ(truth.moving_object_size(), 4);  // Both vehicles of the own train.
  EXPECT_EQ(truth.stationary_object_size(), 1);
  const auto line = nlohmann::json::parse(ReadFileWhole(out / "objects.jsonl"));
  ASSERT_EQ(line["objects"].size(), 3U);
  for (const auto& object : line["objects"]) {
    const osi3::BaseMoving& base = boxes.at(object["name"]);
    const auto size_m = object["world"]["size_m"].get<std::vector<double>>();
    EXPECT_EQ(base.dimension().length(), size_m[0]);
    EXPECT_EQ(base.dimension().width(), size_m[1]);
    EXPECT_EQ(base.dimension().height(), size_m[2]);
    const auto center_m = object["world"]["center_m"].get<std::vector<double>>();
    EXPECT_EQ(osi::VectorOf(base.position()), Vector3(center_m[0], center_m[1], center_m[2]));
    const auto turn = object["world"]["quaternion_xyzw"].get<std::vector<double>>();
    const Eigen::Quaterniond rotation(turn[3], turn[0], turn[1], turn[2]);
    EXPECT_TRUE(osi::RotationOf(base.orientation()).isApprox(rotation.toRotationMatrix(), 1e-9));
    const auto velocity_mps = object["velocity_mps"].get<std::vector<double>>();
    if (object["name"] == "crate") continue;
    EXPECT_EQ(osi::VectorOf(base.velocity()),
              Vector3(velocity_mps[0], velocity_mps[1], velocity_mps[2]));
  }
}

// By OSI's rule: the vehicle's frame begins at the rear axle of its box.
TEST_F(OsiTraces, SayWhereTheSensorIsInTheWorld) {
  UseTraffic();
  const fs::path out = Make("osi", "--format osi --frames 3");
  const auto views = ViewsIn(out / Trace(".osi", "front", 3));
  const auto frames = ReadAll(out);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto& host = views[i].global_ground_truth().moving_object(0);
    EXPECT_EQ(host.id().value(), views[i].host_vehicle_id().value());
    const Transform world_from_box = MakeTransform(osi::RotationOf(host.base().orientation()),
                                                   osi::VectorOf(host.base().position()));
    const Transform world_from_rear =
        world_from_box *
        Eigen::Translation3d(osi::VectorOf(host.vehicle_attributes().bbcenter_to_rear()));
    const auto& mount = views[i].mounting_position();
    const Transform rear_from_sensor =
        MakeTransform(osi::RotationOf(mount.orientation()), osi::VectorOf(mount.position()));
    EXPECT_TRUE(
        (world_from_rear * rear_from_sensor).isApprox(frames[i].frame.world_from_sensor, 1e-9));
    // The pivots of a multiple unit are 17.375 m apart, and the sensor is 4.5 m before the front
    // one.
    EXPECT_NEAR(mount.position().x(), 21.875, 1e-12);
    EXPECT_NEAR(osi::VectorOf(host.base().velocity()).norm(), 20.0, 0.2);
    EXPECT_NEAR(host.base().dimension().length(), 25.835, 0.26);
  }
}

// On an arc of 700 m at 20 m/s. The middle of a box is inside the arc, whose chord the pivots span,
// by (17.375 m)^2 / (8 * 700 m) = 5 cm.
TEST_F(OsiTraces, SayHowTheRestOfTheTrainMoves) {
  UseTraffic();
  for (const auto& view :
       ViewsIn(Make("osi", "--format osi --frames 2") / Trace(".osi", "front", 2))) {
    const auto& base = view.global_ground_truth().moving_object(1).base();
    const Vector3 velocity_mps = osi::VectorOf(base.velocity());
    const Vector3 acceleration_mps2 = osi::VectorOf(base.acceleration());
    EXPECT_NEAR(velocity_mps.norm(), 20.0 * (1.0 - 0.05 / 700.0), 1e-3);
    EXPECT_NEAR(acceleration_mps2.norm(), 20.0 * 20.0 / 700.0, 1e-3);
    EXPECT_NEAR(acceleration_mps2.dot(velocity_mps), 0.0, 0.01);
  }
}

// A wall of 10 % at the data sheet's range, here 200 m, is at the threshold; the aperture is 10 mm.
TEST_F(OsiTraces, HaveThePowerOfTheLidarEquation) {
  UseTraffic();
  const auto view =
      ViewsIn(Make("osi", "--format osi --frames 1") / Trace(".osi", "front", 1)).at(0);
  const Frame frame = ReadAll(Make("pcd", "--format pcd --frames 1")).at(0).frame;
  const double at_threshold_db = 10.0 * std::log10(0.1 * std::pow(0.010 / (2.0 * 200.0), 2.0));
  int num_compared = 0;
  for (int ray = 0; ray < view.lidar_sensor_view(0).reflection_size(); ++ray) {
    const auto& reflection = view.lidar_sensor_view(0).reflection(ray);
    if (!reflection.has_signal_strength()) continue;
    const std::uint32_t row = frame.rows - 1 - static_cast<std::uint32_t>(ray) / frame.columns;
    const std::size_t slot =
        std::size_t{row} * frame.columns + static_cast<std::uint32_t>(ray) % frame.columns;
    EXPECT_NEAR(reflection.signal_strength(),
                at_threshold_db + 10.0 * std::log10(double{frame.power_ratio[slot]}), 1e-6);
    ++num_compared;
  }
  EXPECT_GT(num_compared, 100);
}

TEST_F(OsiTraces, AreOneForEachSensor) {
  auto scenario = nlohmann::ordered_json::parse(ReadFileWhole(scenario_));
  auto rear = scenario["lidar"];
  scenario["lidar"]["name"] = "front";
  rear["name"] = "rear";
  rear["scan"]["rate_hz"] = 4;
  scenario["lidars"] = {scenario["lidar"], rear};
  scenario.erase("lidar");
  WriteFileWhole(scenario_, scenario.dump());
  const fs::path out = Make("osi", "--format osi " + frames_);
  const auto front = ViewsIn(out / "front" / Trace(".osi", "front", 5));
  const auto back = ViewsIn(out / "rear" / Trace(".osi", "rear", 2));
  EXPECT_EQ(front.size(), 5U);
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[1].timestamp().nanos(), 250'000'000U);
  EXPECT_EQ(front[0].sensor_id().value(), 0U);
  EXPECT_EQ(back[0].sensor_id().value(), 1U);
  EXPECT_EQ(back[0].lidar_sensor_view(0).view_configuration().sensor_id().value(), 3U);
  EXPECT_THAT(FaultsOf(out / "front"), ElementsAre());
  EXPECT_THAT(FaultsOf(out / "rear"), ElementsAre());
  EXPECT_THAT(VerifyFolder(out, [](double) {}).faults, ElementsAre());
}

TEST_F(OsiTraces, HaveTheSameBytesOnAnyNumberOfThreads) {
  UseTraffic();
  const std::string name = Trace(".osi", "front", 5);
  EXPECT_TRUE(ReadFileWhole(Make("one", "--format osi --threads 1 " + frames_) / name) ==
              ReadFileWhole(Make("four", "--format osi --threads 4 " + frames_) / name));
}

TEST_F(OsiTraces, HaveTheSameBytesHoweverOftenTheyWereInterrupted) {
  for (const std::string format : {"osi", "osi-mcap"}) {
    const std::string name = Trace(format == "osi" ? ".osi" : ".mcap");
    const std::string whole =
        ReadFileWhole(Make(format, "--format " + format + " " + frames_) / name);
    for (const std::uint32_t num_frames : {0U, 3U}) {
      const std::string part = format + std::to_string(num_frames);
      MakeFirst(part, format, num_frames);
      MakeFirst(part, format, 1);
      const fs::path out = Make(part, "--format " + format + " " + frames_);
      EXPECT_TRUE(whole == ReadFileWhole(out / name)) << part;
      EXPECT_THAT(FaultsOf(out), ElementsAre());
    }
  }
}

TEST_F(OsiTraces, AreReadableUpToTheFrameAtWhichTheyWereInterruptedAndGoOnFromThere) {
  for (const std::string format : {"osi", "osi-mcap"}) {
    const std::string name = Trace(format == "osi" ? ".osi" : ".mcap");
    const std::string whole =
        ReadFileWhole(Make(format, "--format " + format + " " + frames_) / name);
    MakeFirst("part", format, 4);
    const fs::path unfinished = Out("part") / (name + (format == "osi" ? "" : ".part"));
    EXPECT_EQ(MessagesIn(unfinished).size(), 4U);
    EXPECT_THAT(FaultsOf(Out("part")), ElementsAre(HasSubstr("missing: the run is unfinished")));
    // The power failed: the trace lost its end, though its frames were noted.
    const std::string bytes = ReadFileWhole(unfinished);
    WriteFileWhole(unfinished, bytes.substr(0, bytes.size() - 5));
    EXPECT_TRUE(whole == ReadFileWhole(Make("part", "--format " + format + " " + frames_) / name));
    fs::remove_all(Out("part"));
  }
}

// A run may end between its last frame and its manifest.
TEST_F(OsiTraces, AreCompletedWithoutTheirManifest) {
  for (const std::string format : {"osi", "osi-mcap"}) {
    const std::string options = "--format " + format + " " + frames_;
    const fs::path trace = Make(format, options) / Trace(format == "osi" ? ".osi" : ".mcap");
    const std::string whole = ReadFileWhole(trace);
    fs::remove(Out(format) / "manifest.json");
    EXPECT_THAT(Run(options + " --out " + Out(format).string()), HasSubstr("5"));
    EXPECT_TRUE(whole == ReadFileWhole(trace)) << format;
    EXPECT_THAT(Run(options + " --out " + Out(format).string()), HasSubstr("already complete"));
  }
}

TEST_F(OsiTraces, OfMcapThatAreCutAreFaults) {
  const fs::path out = Make("osi", "--format osi-mcap " + frames_);
  const fs::path trace = out / Trace(".mcap");
  // Without the magic at the end, the messages are all there.
  fs::resize_file(trace, fs::file_size(trace) - 8);
  EXPECT_THAT(
      FaultsOf(out),
      ElementsAre(HasSubstr(trace.string() + ": must have the hash "),
                  trace.string() + ": must have the end of an MCAP file: it is unfinished or cut"));
}

TEST_F(OsiTraces, OfOtherFramesAreFaults) {
  const fs::path out = Make("osi", "--format osi " + frames_);
  const fs::path trace = out / Trace(".osi");
  const std::string bytes = ReadFileWhole(trace);
  WriteFileWhole(trace, Flipped(bytes, 100));
  const auto is_of_hash = HasSubstr(trace.string() + ": must have the hash ");
  EXPECT_THAT(
      FaultsOf(out),
      ElementsAre(is_of_hash, HasSubstr(trace.string() + ": message 1: must have the hash ")));
  WriteFileWhole(trace, bytes.substr(0, bytes.size() - 1));
  EXPECT_THAT(FaultsOf(out),
              ElementsAre(is_of_hash,
                          out.string() + "/frames.jsonl:5: must have its message in " +
                              trace.string() + " (got none)",
                          HasSubstr(trace.string() + ": message 5: must lie within the file")));
  WriteFileWhole(trace, bytes + std::string(4, '\0'));
  EXPECT_THAT(FaultsOf(out),
              ElementsAre(is_of_hash,
                          trace.string() + ": must have a message for each of 5 frames (got 6)"));
  fs::remove(trace);
  EXPECT_THAT(FaultsOf(out), ElementsAre(trace.string() + ": no such file or directory"));
}

// By the definitions in the file, as Foxglove reads any message of protobuf.
TEST_F(OsiTraces, AreReadByOthersLibraries) {
  if (RunCommand("node -e 'for (const name of [\"@mcap/core\", \"@mcap/nodejs\", "
                 "\"@foxglove/wasm-zstd\", \"protobufjs\"]) require.resolve(name)'")
          .status != 0) {
    GTEST_SKIP() << "node or npm's @mcap/core, protobufjs and others are missing";
  }
  UseTraffic();
  const fs::path out = Make("mcap", "--format osi-mcap --frames 2");
  const Ended run =
      RunCommand("node " RAILCAST_SOURCE_DIR "/tests/generator/extras/osi/read_trace.cjs " +
                 (out / Trace(".mcap", "front", 2)).string());
  ASSERT_EQ(run.status, 0) << run.said;
  const auto found = nlohmann::json::parse(run.said);
  EXPECT_EQ(found["chunks"], 2);
  EXPECT_EQ(found["metadata"]["net.asam.osi.trace"]["version"], "3.8.0");
  ASSERT_EQ(found["views"].size(), 2U);
  std::uint64_t num_points = 0;
  for (const auto& view : found["views"]) {
    EXPECT_EQ(view["time"], view["nanos"]);
    EXPECT_EQ(view["objects"], 5);
    EXPECT_EQ(view["rays"], 40 * 16);
    EXPECT_EQ(view["directions"], 40 * 16);
    num_points += view["points"].get<std::uint64_t>();
  }
  EXPECT_EQ(num_points, nlohmann::json::parse(ReadFileWhole(out / "manifest.json"))["points"]);
}

TEST_F(OsiTraces, RefuseWhatTheyCannotHold) {
  const std::string out = " --out " + Out("osi").string();
  EXPECT_THAT(Run("--format osi --fields x,y,z" + out, 1),
              HasSubstr("--fields: OSI's are fixed, so it must be left out with --format osi (got "
                        "x,y,z)"));
  EXPECT_FALSE(fs::exists(Out("osi")));
}

}  // namespace
}  // namespace railcast
