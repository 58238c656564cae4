#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/io/run/run_record.h"
#include "core/io/run/sensors_record.h"
#include "core/io/verify/verification.h"
#include "core/io/write_file.h"
#include "generator/run/make_frames.h"
#include "generator/run/run_plan.h"
#include "railcast/scenario.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"
#include "tests/generator/run_command.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr const char* kStranger = ": belongs to none of the run's sensors";

/// A run of two sensors with merged clouds, made once; each test has a copy.
class RunOfTwoSensors : public testing::Test {
 protected:
  static void SetUpTestSuite() { made_ = std::make_unique<TemporaryDirectory>(); }
  static void TearDownTestSuite() { made_.reset(); }

  void SetUp() override {
    const fs::path kept = made_->path() / "run";
    if (!fs::exists(kept)) {
      ASSERT_THAT(Make(kept), ExitsWith(0));
    }
    fs::copy(kept, run(), fs::copy_options::recursive);
  }
  static Ended Make(const fs::path& out, const std::string& more = " --merged") {
    return Generate("sequence " RAILCAST_SOURCE_DIR
                    "/scenarios/two_sensors.json --frames 2 --fields x,y,z --out " +
                    out.string() + more);
  }
  [[nodiscard]] fs::path run() const { return directory_.path() / "run"; }
  [[nodiscard]] fs::path sensors() const { return run() / "sensors.json"; }

  /// The fault lines, each without the folder.
  [[nodiscard]] std::vector<std::string> Faults() const {
    std::vector<std::string> faults = VerifySensors(run(), [](double) {}).faults;
    for (std::string& fault : faults) fault.erase(0, run().string().size() + 1);
    return faults;
  }
  /// Changes sensors.json as an editor would.
  void Edit(const std::function<void(nlohmann::ordered_json& sensors)>& change) const {
    auto json = nlohmann::ordered_json::parse(ReadFileWhole(sensors()));
    change(json);
    WriteFileWhole(sensors(), json.dump(2) + "\n");
  }
  /// Makes sensors.json what programs before 1.0 wrote.
  void MakeOld() const {
    Edit([](nlohmann::ordered_json& json) {
      json.erase("manifest_xxh3");
      for (auto& sensor : json["sensors"]) sensor.erase("manifest_xxh3");
    });
  }

 private:
  static inline std::unique_ptr<TemporaryDirectory> made_;
  TemporaryDirectory directory_;
};

using SensorsJson = nlohmann::ordered_json;

/// What can be changed in sensors.json.
const std::vector<std::function<void(SensorsJson& sensors)>> kEdits = {
    [](SensorsJson& json) { json["sensors"][0]["vehicle_from_sensor"]["translation_m"][0] = 99; },
    [](SensorsJson& json) { json["sensors"][1]["vehicle_from_sensor"]["translation_m"][2] = 4.11; },
    [](SensorsJson& json) {
      json["sensors"][1]["vehicle_from_sensor"]["quaternion_xyzw"] = {0.0, 0.0, 1.0, 0.0};
    },
    [](SensorsJson& json) { json["sensors"][1]["rate_hz"] = 11; },
    [](SensorsJson& json) { json["sensors"][0]["phase_s"] = 0.01; },
    [](SensorsJson& json) { json["sensors"][0]["num_frames"] = 1; },
    [](SensorsJson& json) { json["sensors"][0]["name"] = "roof"; }};

TEST_F(RunOfTwoSensors, IsWholeAsItWasWritten) {
  const Verification found = VerifySensors(run(), [](double) {});
  EXPECT_THAT(found.faults, IsEmpty());
  EXPECT_THAT(found.unchecked, IsEmpty());
  EXPECT_EQ(found.num_frames, 2U + 1U);
}

TEST_F(RunOfTwoSensors, IsChangedWithAnyValueOfItsList) {
  const std::string text = ReadFileWhole(sensors());
  const std::string hash = text.substr(text.rfind("xxh3\": \"") + 8, 16);
  std::vector<std::function<void(SensorsJson&)>> edits = kEdits;
  edits.emplace_back([](SensorsJson& json) { std::swap(json["sensors"][0], json["sensors"][1]); });
  for (const auto& edit : edits) {
    Edit(edit);
    EXPECT_THAT(Faults(), testing::Contains(testing::AllOf(
                              StartsWith("sensors.json: /manifest_xxh3: must be "),
                              HasSubstr(", that of all before it (got " + hash + ")"))));
    WriteFileWhole(sensors(), text);
  }
  EXPECT_THAT(Faults(), IsEmpty());
}

// Those of its sensors are named alike, and stand before it.
TEST_F(RunOfTwoSensors, IsChangedWithoutTheHashOfItsList) {
  const std::string text = ReadFileWhole(sensors());
  for (const bool is_merged : {true, false}) {
    for (const std::size_t num_sensors : {2U, 1U}) {
      Edit([&](SensorsJson& json) {
        json.erase("manifest_xxh3");
        if (!is_merged) json.erase("merged");
        if (num_sensors < 2) json["sensors"].erase(num_sensors);
      });
      EXPECT_THAT(Faults(),
                  testing::Contains(
                      "sensors.json: must end with manifest_xxh3, the hash of all before it"));
      WriteFileWhole(sensors(), text);
    }
  }
}

TEST_F(RunOfTwoSensors, IsMendedWhereItsListWasChanged) {
  const auto whole = Contents(run());
  Edit(kEdits.front());
  EXPECT_THAT(Make(run()),
              ExitsWith(0, testing::AllOf(HasSubstr("was complete, but not as it was written"),
                                          HasSubstr("sensors.json: /manifest_xxh3: must be "))));
  EXPECT_EQ(Contents(run()), whole);
  EXPECT_THAT(Make(run()), ExitsWith(0, testing::Not(HasSubstr("not as it was written"))));
}

TEST_F(RunOfTwoSensors, HasTheSensorsThatItsListNames) {
  Edit([](SensorsJson& json) { json["sensors"].erase(1); });
  EXPECT_THAT(Faults(), testing::Contains("roof/frames.jsonl" + std::string(kStranger)));
  fs::rename(run() / "front", run() / "other");
  fs::rename(run() / "roof", run() / "front");
  fs::rename(run() / "other", run() / "roof");
  EXPECT_THAT(Faults(), testing::Contains(StartsWith("front/manifest.json: must have the hash ")));
  fs::remove_all(run() / "front");
  EXPECT_THAT(Faults(), testing::Contains("front/run.json: no such file or directory"));
}

TEST_F(RunOfTwoSensors, HoldsNothingElse) {
  for (const std::string name : {"notes.txt", "photos/a.jpg", "run.json", "roof2/frames/000000.pcd",
                                 "frames.mcap", "bag.jsonl"}) {
    fs::create_directories((run() / name).parent_path());
    WriteFileWhole(run() / name, "mine");
    EXPECT_THAT(Faults(), ElementsAre(name + kStranger));
    fs::remove(run() / name);
  }
  WriteFileWhole(run() / "merged/photo.jpg", "mine");
  WriteFileWhole(run() / "roof/photo.jpg", "mine");
  EXPECT_EQ(Faults().size(), 2U);
}

TEST_F(RunOfTwoSensors, IsUnfinishedWithoutItsList) {
  fs::rename(sensors(), sensors().string() + ".part");
  EXPECT_TRUE(IsOfSensors(run()));
  EXPECT_THAT(Faults(), ElementsAre("sensors.json: missing: the run is unfinished"));
  fs::remove(run() / "roof/manifest.json");
  EXPECT_THAT(Faults(), ElementsAre("sensors.json: missing: the run is unfinished",
                                    "roof/manifest.json: missing: the run is unfinished"));
  EXPECT_THAT(Make(run()), ExitsWith(0));
  EXPECT_THAT(Faults(), IsEmpty());
}

TEST_F(RunOfTwoSensors, KeepsItsMergedClouds) {
  const auto whole = Contents(run());
  ASSERT_THAT(Make(run(), ""), ExitsWith(0));
  EXPECT_EQ(Contents(run()), whole);
  fs::remove(run() / "merged/frames/000001.pcd");
  ASSERT_THAT(Make(run(), ""), ExitsWith(0));
  EXPECT_EQ(Contents(run()), whole);
}

TEST_F(RunOfTwoSensors, OfAnOldProgramIsComparedWithItsFolders) {
  MakeOld();
  const Verification found = VerifySensors(run(), [](double) {});
  EXPECT_THAT(found.faults, IsEmpty());
  EXPECT_THAT(found.unchecked,
              ElementsAre(sensors().string() +
                          ": an older railcast wrote it without hashes: whether it names all "
                          "sensors of the run, in their order, is not known"));
  const std::string text = ReadFileWhole(sensors());
  for (const auto& edit : kEdits) {
    Edit(edit);
    EXPECT_THAT(Faults(),
                ElementsAre(testing::AllOf(
                    StartsWith("sensors.json: /sensors: \""),
                    HasSubstr("\": must be as the scenario and the run in its folder say"))));
    WriteFileWhole(sensors(), text);
  }
}

TEST_F(RunOfTwoSensors, IsNamedWhileItIsMade) {
  const fs::path begun = run().parent_path() / "begun";
  RunChoices choices;
  choices.directory = begun;
  choices.fields = "x,y,z";
  choices.num_frames = 2;
  RunPlan plan = PlanRun(ReadScenario(RAILCAST_SOURCE_DIR "/scenarios/two_sensors.json"), choices,
                         "two_sensors.json");
  FrameMaker maker(plan.scenario, 1);
  SetFrames(maker, plan);
  SequenceHooks hooks = NoHooks();
  hooks.is_stopped = [] { return true; };
  EXPECT_FALSE(MakeFrames(maker, plan, RunFolders(plan), hooks).is_complete);
  EXPECT_TRUE(IsOfSensors(begun));
  const std::string missing = ": missing: the run is unfinished";
  EXPECT_THAT(VerifyFolder(begun, [](double) {}).faults,
              ElementsAre((begun / "sensors.json").string() + missing,
                          (begun / "front/manifest.json").string() + missing,
                          (begun / "roof/manifest.json").string() + missing));
}

}  // namespace
}  // namespace railcast
