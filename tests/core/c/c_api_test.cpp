#include "railcast/c_api.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "railcast/fidelity.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"
#include "tests/core/c/c_sim.h"
#include "tests/core/scenario/malformed_case.h"
#include "tests/support/frame_bytes.h"
#include "tests/support/memory_limit.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

TEST(CApi, GivesTheBytesOfTheCppInterface) {
  const ScenarioText minimal = ScenarioText::Of("minimal.json");
  const auto simulator = MakeSimulator(ReadScenario(minimal.file), 2);
  const Sim sim = CreateSim(minimal.Config());
  ASSERT_TRUE(sim);
  Frame frame;
  for (const std::uint32_t index : {3U, 0U}) {
    simulator->Scan(index, frame);
    ASSERT_EQ(railcast_step(sim.get(), index), RAILCAST_OK) << railcast_last_error();
    EXPECT_TRUE(SimBytes(sim.get()) == FrameBytes(frame)) << "frame " << index;
    railcast_frame header{};
    ASSERT_EQ(railcast_get_frame(sim.get(), &header), RAILCAST_OK);
    EXPECT_EQ(header.index, index);
    EXPECT_EQ(header.stamp_ns, frame.stamp_ns);
    EXPECT_EQ(header.num_slots, frame.num_slots());
    const Vector3 end_m = frame.world_from_sensor_end.translation();
    EXPECT_EQ(header.world_from_sensor_end.position_m[0], end_m.x());
    const Eigen::Quaterniond rotation(
        Eigen::Map<const Eigen::Vector4d>(header.world_from_sensor.quaternion_xyzw));
    EXPECT_LT((rotation.toRotationMatrix() - frame.world_from_sensor.linear()).norm(), 1e-14);
  }
}

TEST(CApi, MakesTheChoiceOfFidelityAuto) {
  ScenarioText automatic = ScenarioText::Of("minimal.json").WithRaster(4.0, 2.0, 0.5);
  automatic.Replace("\"version\": 1", "\"version\": 1, \"fidelity\": \"auto\"");
  const ScenarioSpec scenario = ReadScenarioText(automatic.text, automatic.file);
  const auto simulator = MakeSimulator(scenario, 2);
  UseChosenFidelity(*simulator, scenario, [](double) {});
  Frame frame = FrameBy(*simulator, 1);
  const Sim sim = CreateSim(automatic.Config());
  ASSERT_TRUE(sim);
  ASSERT_EQ(railcast_step(sim.get(), 1), RAILCAST_OK);
  EXPECT_TRUE(SimBytes(sim.get()) == FrameBytes(frame));
}

TEST(CApi, ReportsEveryFaultOfATextAsReadScenarioDoes) {
  std::filesystem::current_path(ScenariosDir());
  for (const MalformedCase& malformed : MalformedCases("read")) {
    if (!std::filesystem::is_regular_file(malformed.file)) continue;
    const ScenarioText scenario{TextOf(malformed.file), malformed.file.string()};
    if (scenario.text.find('\0') != std::string::npos) continue;  // C's texts end there.
    railcast_config config = scenario.Config();
    railcast_sim* sim = nullptr;
    EXPECT_EQ(railcast_create(&config, &sim), RAILCAST_BAD_INPUT) << malformed.file;
    EXPECT_EQ(railcast_last_error() + std::string("\n"), malformed.expected) << malformed.file;
    EXPECT_EQ(sim, nullptr);
  }
}

TEST(CApi, NamesATextWithoutAFileScenario) {
  railcast_config config{};
  config.json_text = "{";
  railcast_sim* sim = nullptr;
  EXPECT_EQ(railcast_create(&config, &sim), RAILCAST_BAD_INPUT);
  EXPECT_THAT(railcast_last_error(), testing::StartsWith("scenario: "));
}

TEST(CApi, RefusesNullAndWrongArguments) {
  const ScenarioText minimal = ScenarioText::Of("minimal.json");
  railcast_config config = minimal.Config();
  railcast_sim* made = nullptr;
  const auto refusal = [](railcast_status status) {
    EXPECT_EQ(status, RAILCAST_BAD_ARGUMENT);
    return std::string(railcast_last_error());
  };
  EXPECT_EQ(refusal(railcast_create(nullptr, &made)), "config: must not be null");
  EXPECT_EQ(refusal(railcast_create(&config, nullptr)), "sim: must not be null");
  config.json_text = nullptr;
  EXPECT_EQ(refusal(railcast_create(&config, &made)), "config.json_text: must not be null");
  for (const int wrong : {-1, 1025, 2'000'000'000}) {
    config = minimal.Config(wrong);
    EXPECT_EQ(refusal(railcast_create(&config, &made)),
              "config.num_threads: must be >= 0 and <= 1024 (got " + std::to_string(wrong) + ")");
  }
  EXPECT_EQ(made, nullptr);
  EXPECT_EQ(refusal(railcast_step(nullptr, 0)), "sim: must not be null");

  const Sim sim = CreateSim(minimal.Config());
  railcast_field field{};
  railcast_frame frame{};
  const std::string no_frame = "sim: must have a frame, from a step that succeeded";
  EXPECT_EQ(refusal(railcast_get_field(sim.get(), "x", &field)), no_frame);
  EXPECT_EQ(refusal(railcast_get_frame(sim.get(), &frame)), no_frame);
  EXPECT_EQ(refusal(railcast_get_scan(sim.get(), nullptr)), "scan: must not be null");
  EXPECT_EQ(refusal(railcast_set_surfaces(sim.get(), nullptr, 0)),
            "sim: must be made by railcast_create_with_scene()");
  const railcast_motion motion{};
  EXPECT_EQ(refusal(railcast_step_host(sim.get(), 0, &motion)),
            "sim: must be made by railcast_create_with_scene()");
  ASSERT_EQ(railcast_step(sim.get(), 0), RAILCAST_OK);
  EXPECT_EQ(refusal(railcast_get_field(sim.get(), "rnge_m", &field)),
            "name: unknown field, the nearest is \"range_m\" (got \"rnge_m\")");
  EXPECT_EQ(refusal(railcast_get_field(sim.get(), nullptr, &field)), "name: must not be null");
  EXPECT_EQ(refusal(railcast_get_field(sim.get(), "x", nullptr)), "field: must not be null");
  railcast_destroy(nullptr);
}

TEST(CApi, VelocitiesAreFieldsOfSensorsThatMeasureThem) {
  ScenarioText scenario = ScenarioText::Of("minimal.json");
  railcast_field field{};
  const Sim without = CreateSim(scenario.Config());
  ASSERT_EQ(railcast_step(without.get(), 0), RAILCAST_OK);
  EXPECT_EQ(railcast_get_field(without.get(), "radial_velocity_mps", &field),
            RAILCAST_BAD_ARGUMENT);
  scenario.Replace(R"("sensors/vir2rail.json")",
                   R"({"file": "sensors/vir2rail.json",
                       "velocity": {"sigma_mps": 0.03, "max_mps": 50}})");
  const Sim with = CreateSim(scenario.Config());
  ASSERT_EQ(railcast_step(with.get(), 0), RAILCAST_OK);
  ASSERT_EQ(railcast_get_field(with.get(), "radial_velocity_mps", &field), RAILCAST_OK);
  EXPECT_EQ(field.type, RAILCAST_FLOAT32);
  EXPECT_EQ(field.num_values, 28800U);
}

TEST(CApi, SteppingOffTheTrackFailsAndTheNextStepWorks) {
  ScenarioText moving = ScenarioText::Of("minimal.json");
  moving.Replace("400", R"(400, "motion": {"profile": [{"time_s": 0, "speed_mps": 20}]})");
  const Sim sim = CreateSim(moving.Config());
  ASSERT_TRUE(sim);
  ASSERT_EQ(railcast_step(sim.get(), 0), RAILCAST_OK);
  EXPECT_EQ(railcast_step(sim.get(), 400), RAILCAST_BAD_INPUT);
  EXPECT_EQ(railcast_last_error(),
            moving.file +
                ": /vehicle/motion: leaves track \"main\", from 0 to 1000 m, at frame 400 (40 s)");
  railcast_frame frame{};
  EXPECT_EQ(railcast_get_frame(sim.get(), &frame), RAILCAST_BAD_ARGUMENT);
  ASSERT_EQ(railcast_step(sim.get(), 1), RAILCAST_OK);
  EXPECT_EQ(railcast_get_frame(sim.get(), &frame), RAILCAST_OK);
}

TEST(CApi, RefusesFramesWhoseStampsDoNotFitInto64Bits) {
  ScenarioText slow = ScenarioText::Of("minimal.json").WithRaster(2.0, 1.0, 0.5);
  slow.Replace("\"rate_hz\": 10", "\"rate_hz\": 0.25");
  const Sim sim = CreateSim(slow.Config());
  ASSERT_TRUE(sim);
  EXPECT_EQ(railcast_step(sim.get(), 4'294'967'295U), RAILCAST_BAD_ARGUMENT);
  // 2^63 ns at 4 s a frame.
  EXPECT_THAT(railcast_last_error(),
              testing::MatchesRegex("frame_index: must be at most 23058430[0-9]+ "
                                    "\\(got 4294967295\\)"));
}

TEST(CApi, PicksTheSensorOfThatName) {
  const ScenarioText two = ScenarioText::Of("two_sensors.json");
  railcast_config config = two.Config();
  railcast_sim* made = nullptr;
  EXPECT_EQ(railcast_create(&config, &made), RAILCAST_BAD_INPUT);
  const std::string name = SensorNames(ReadScenario(two.file)).back();
  config.sensor = name.c_str();
  const Sim sim = CreateSim(config);
  ASSERT_TRUE(sim);
  railcast_scan scan{};
  ASSERT_EQ(railcast_get_scan(sim.get(), &scan), RAILCAST_OK);
  const ScanPattern pattern = BuildScanPattern(PickSensor(ReadScenario(two.file), name).lidar.scan);
  EXPECT_EQ(scan.num_firings, pattern.num_firings());
  EXPECT_EQ(scan.duration_ns, pattern.time_ns.back());
  EXPECT_EQ(scan.rate_hz, pattern.rate_hz);
}

TEST(CApi, ThreadsMayUseDifferentSimulationsAndHaveMessagesOfTheirOwn) {
  const ScenarioText minimal = ScenarioText::Of("minimal.json");
  std::vector<std::string> bytes(3);
  std::vector<std::string> messages(3);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    threads.emplace_back([&, i] {
      const Sim sim = CreateSim(minimal.Config(static_cast<int>(i) + 1));
      const std::string name = "no_field_" + std::to_string(i);
      railcast_field field{};
      EXPECT_EQ(railcast_step(sim.get(), 2), RAILCAST_OK);
      EXPECT_EQ(railcast_get_field(sim.get(), name.c_str(), &field), RAILCAST_BAD_ARGUMENT);
      bytes[i] = SimBytes(sim.get());
      messages[i] = railcast_last_error();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_TRUE(bytes[i] == bytes[0]);
    EXPECT_THAT(messages[i], testing::HasSubstr("no_field_" + std::to_string(i)));
  }
}

TEST(CApi, LackOfMemoryIsAStatus) {
  if (!kCanLimitMemory) GTEST_SKIP() << "sanitizers reserve terabytes of memory";
  // 7200 x 1600 = 11.5 M firings.
  const ScenarioText large = ScenarioText::Of("minimal.json").WithRaster(360.0, 80.0, 0.05);
  EXPECT_EXIT(
      {
        railcast_config config = large.Config();
        railcast_sim* sim = nullptr;
        constexpr std::size_t kMore_bytes = 100'000'000;
        LimitMemory(kMore_bytes);
        const railcast_status status = railcast_create(&config, &sim);
        std::fprintf(stderr, "%d: %s\n", static_cast<int>(status), railcast_last_error());
        std::_Exit(0);
      },
      testing::ExitedWithCode(0),
      "3: .*/lidar/scan: out of memory while building the scan pattern");
}

TEST(CApi, NamesOutcomesAndVersions) {
  EXPECT_STREQ(railcast_outcome_name(0), "returned");
  EXPECT_STREQ(railcast_outcome_name(10), "cover_blocked");
  EXPECT_EQ(railcast_outcome_name(11), nullptr);
  EXPECT_EQ(railcast_c_api_version(), RAILCAST_C_API_VERSION);
  EXPECT_THAT(railcast_version(), testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+(-rc\\.[0-9]+)?"));
}

}  // namespace
}  // namespace railcast
