#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>

#include "core/io/run/camera_files.h"
#include "core/io/run/motion_files.h"
#include "core/io/run/sequence_files.h"
#include "core/io/verify/verification.h"
#include "generator/run/frame_maker.h"
#include "railcast/io/recording.h"
#include "railcast/scenario.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/generator/example_motion.h"
#include "tests/generator/example_run.h"

namespace railcast {
namespace {

TEST(MotionSequence, HasAFileForEachSensorWithALineForEachSample) {
  for (const std::string format : {"pcd", "kitti"}) {
    const TemporaryDirectory directory;
    EXPECT_TRUE(MakeMotionRun(RunWithMotion(directory.path(), format)).is_complete);
    const auto contents = Contents(directory.path());
    const std::vector<MotionFile> files = MotionFilesOf(*RunWithMotion("x").motion_sensors);
    ASSERT_EQ(files.size(), 3U);
    for (std::size_t i = 0; i < files.size(); ++i) {
      std::string expected(files[i].header);
      for (std::uint32_t frame = 3; frame < 9; ++frame) {
        expected += MotionLinesOf(ExampleMotion(frame)).at(i);
      }
      EXPECT_EQ(contents.at(MotionFileName(files[i].sensor)), expected) << files[i].sensor;
    }
  }
}

TEST(MotionSequence, LeavesAllOtherFilesOfTheFramesAsTheyAre) {
  const TemporaryDirectory directory;
  const TemporaryDirectory without;
  (void)MakeMotionRun(RunWithMotion(directory.path()));
  (void)RunSequence(ExampleRun(without.path()), MakeExampleFrame, NoHooks());
  const auto contents = Contents(directory.path());
  for (const auto& [name, bytes] : Contents(without.path())) {
    if (name == "frames.jsonl" || name == "manifest.json" || name == "run.json") continue;
    EXPECT_EQ(contents.at(name), bytes) << name;
  }
}

TEST(MotionSequence, EveryColumnHasAValueOrIsEmptyWhereThereIsNone) {
  const TemporaryDirectory directory;
  (void)MakeMotionRun(RunWithMotion(directory.path()));
  for (const std::string name : {"imu", "gnss", "odometer"}) {
    std::istringstream lines(ReadFileWhole(directory.path() / MotionFileName(name)));
    std::string line;
    std::getline(lines, line);
    const auto num_commas = std::ranges::count(line, ',');
    while (std::getline(lines, line)) EXPECT_EQ(std::ranges::count(line, ','), num_commas) << line;
  }
  const std::string gnss = ReadFileWhole(directory.path() / "motion/gnss.csv");
  // Neither place nor velocity without a fix; a fix, the free sky and the truth always.
  EXPECT_NE(gnss.find("\n4000,0,0.125,,,,,,,,,,,,,1.5,2.5,0,0,0,0\n"), std::string::npos) << gnss;
}

TEST(MotionSequence, NamesOfColumnsEndInTheirUnits) {
  const std::vector<MotionFile> files = MotionFilesOf(*RunWithMotion("x").motion_sensors);
  EXPECT_EQ(files.at(0).header,
            "time_ns,angular_velocity_x_radps,angular_velocity_y_radps,angular_velocity_z_radps,"
            "specific_force_x_mps2,specific_force_y_mps2,specific_force_z_mps2,"
            "true_angular_velocity_x_radps,true_angular_velocity_y_radps,"
            "true_angular_velocity_z_radps,true_specific_force_x_mps2,true_specific_force_y_mps2,"
            "true_specific_force_z_mps2\n");
  EXPECT_EQ(files.at(2).header,
            "time_ns,pulses,distance_m,speed_mps,true_distance_m,true_speed_mps\n");
}

TEST(MotionSequence, ContinuesAfterAnInterruptionWithTheSameBytes) {
  const TemporaryDirectory undisturbed;
  (void)MakeMotionRun(RunWithMotion(undisturbed.path()));
  const auto expected = Contents(undisturbed.path());
  const std::string imu = expected.at("motion/imu.csv");
  // Nothing is lost; a line was cut short; the lines of two frames are gone; one was changed.
  std::string changed = imu;
  changed[changed.find("4001,") + 3] = '7';
  for (const std::string& damaged :
       {imu, imu.substr(0, imu.size() - 5), imu.substr(0, imu.find("4000,")), changed}) {
    const TemporaryDirectory directory;
    std::uint32_t num_done = 0;
    const SequenceHooks stop_after_three = {
        [&](std::uint32_t done, std::uint32_t) { num_done = done; }, [&] { return num_done >= 3; }};
    EXPECT_FALSE(MakeMotionRun(RunWithMotion(directory.path()), stop_after_three).is_complete);
    const std::size_t num_bytes = ReadFileWhole(directory.path() / "motion/imu.csv").size();
    WriteFileWhole(directory.path() / "motion/imu.csv",
                   damaged.substr(0, std::min(damaged.size(), num_bytes)));
    EXPECT_TRUE(MakeMotionRun(RunWithMotion(directory.path())).is_complete);
    EXPECT_EQ(Contents(directory.path()), expected);
  }
}

TEST(MotionSequence, NoticesASampleThatWasChanged) {
  const TemporaryDirectory directory;
  (void)MakeMotionRun(RunWithMotion(directory.path()));
  const auto file = directory.path() / "motion/odometer.csv";
  std::string text = ReadFileWhole(file);
  text[text.find("\n6000,") + 7] = '9';
  WriteFileWhole(file, text);
  EXPECT_EQ(
      MakeMotionRun(RunWithMotion(directory.path())).changed,
      std::vector<std::string>{directory.path().string() + ": frame 6 was changed or removed"});
}

ScenarioSpec ScenarioWithMotion() {
  ScenarioSpec spec = ReadScenario(ScenariosDir() / "minimal.json");
  spec.vehicle.motion.profile = {{0.0, {}, 10.0}};
  spec.motion_sensors.emplace();
  spec.motion_sensors->imus = {{.rate_hz = 50.0,
                                .gyroscope_noise_density_degps_per_sqrthz = 0.01,
                                .gyroscope_random_walk_degps2_per_sqrthz = 0.01}};
  spec.motion_sensors->odometers.emplace_back();
  return spec;
}

std::string LinesOf(FrameMaker& maker, std::uint32_t frame) {
  MadeFrame made;
  maker.Begin(0, frame)(made);
  std::string all;
  for (const std::string& lines : MotionLinesOf(made.motion)) all += lines;
  return all;
}

TEST(FrameMaker, SamplesOfAFrameAreTheSameWhicheverFrameComesFirst) {
  FrameMaker forwards(ScenarioWithMotion(), 1);
  FrameMaker late(ScenarioWithMotion(), 2);
  const std::string of_fifth = LinesOf(late, 5);
  EXPECT_FALSE(of_fifth.empty());
  for (std::uint32_t frame = 0; frame < 5; ++frame) EXPECT_NE(LinesOf(forwards, frame), of_fifth);
  EXPECT_EQ(LinesOf(forwards, 5), of_fifth);
}

/// Makes a sequence of the scenario above.
void MakeSequenceOf(const std::filesystem::path& directory,
                    std::uint32_t start_frame,
                    std::uint32_t num_frames,
                    int num_threads) {
  RunChoices choices;
  choices.directory = directory;
  choices.format = "objects";
  choices.start_frame = start_frame;
  choices.num_frames = num_frames;
  RunPlan plan = PlanRun(ScenarioWithMotion(), choices, "scenario.json");
  FrameMaker maker(plan.scenario, num_threads);
  SetFrames(maker, plan);
  EXPECT_TRUE(MakeFrames(maker, plan, RunFolders(plan), NoHooks()).is_complete);
}

TEST(MotionSequence, HasTheSameSamplesFromAnyFirstFrameOnAndAtAnyNumberOfThreads) {
  const TemporaryDirectory whole;
  const TemporaryDirectory late;
  MakeSequenceOf(whole.path(), 0, 6, 1);
  MakeSequenceOf(late.path(), 4, 2, 3);
  for (const std::string name : {"motion/imu.csv", "motion/odometer.csv"}) {
    const std::string of_all = ReadFileWhole(whole.path() / name);
    const std::string of_late = ReadFileWhole(late.path() / name);
    const std::size_t header = of_all.find('\n') + 1;
    EXPECT_EQ(of_late.substr(0, header), of_all.substr(0, header));
    EXPECT_EQ(of_late.substr(header), of_all.substr(of_all.find("\n400000000,") + 1)) << name;
  }
}

TEST(MotionSequence, CanBeReadAndVerified) {
  const TemporaryDirectory directory;
  MakeSequenceOf(directory.path(), 0, 2, 2);
  EXPECT_EQ(VerifySequence(directory.path(), [](double) {}).faults, std::vector<std::string>{});
  const auto recording = OpenRecording(directory.path());
  EXPECT_EQ(recording->info().num_frames, 2U);
  for (const std::int64_t stamp_ns : {0, 100'000'000}) {
    const auto read = recording->Next();
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ((*read)().frame.stamp_ns, stamp_ns);
  }
}

// A command holds for all samples from its frame on.
TEST(FrameMaker, MotionSensorsFeelCommands) {
  FrameMaker maker(ScenarioWithMotion(), 1);
  maker.Apply(Brake{.deceleration_mps2 = 1.5}, 300'000'000);
  const auto forward_in = [&](std::uint32_t frame) {
    MadeFrame made;
    maker.Begin(0, frame)(made);
    return made.motion.imus.at(0).at(0).true_specific_force_mps2.x();
  };
  EXPECT_NEAR(forward_in(2), 0.0, 1e-6);
  EXPECT_NEAR(forward_in(3), -1.5, 1e-6);
  EXPECT_NEAR(forward_in(2), 0.0, 1e-6);
}

SequenceSpec RunWithCamera(const std::filesystem::path& directory, const std::string& format) {
  SequenceSpec spec = ExampleRun(directory, format);
  spec.camera = "front";
  spec.calibration_json = "{}\n";
  return spec;
}

// An image with every second frame: those with even numbers.
bool MakeExampleImage(std::uint32_t index, CameraImage& image) {
  if (index % 2 != 0) return false;
  image.width_px = 2;
  image.height_px = 1;
  image.rgb.assign(6, static_cast<std::uint8_t>(index));
  image.depth_m = {1.5F, static_cast<float>(index)};
  image.label = {1, index};
  image.instance = {0, 3};
  return true;
}

SequenceResult MakeRun(const SequenceSpec& spec, const SequenceHooks& hooks = NoHooks()) {
  return RunSequence(spec, MakeExampleFrame, hooks, MakeExampleImage);
}

TEST(CameraSequence, HasImagesAndCalibrationBesideTheClouds) {
  for (const std::string format : {"pcd", "kitti"}) {
    const TemporaryDirectory directory;
    EXPECT_TRUE(MakeRun(RunWithCamera(directory.path(), format)).is_complete);
    auto contents = Contents(directory.path());
    EXPECT_EQ(contents.at("camera/front/calibration.json"), "{}\n");
    // Frames 3 to 8; KITTI's are numbered from 0.
    for (const std::uint32_t frame : {4U, 6U, 8U}) {
      CameraImage image;
      ASSERT_TRUE(MakeExampleImage(frame, image));
      const std::uint32_t number = format == "kitti" ? frame - 3 : frame;
      for (const FrameFile& file : EncodeCameraFiles(image, "front", number)) {
        EXPECT_EQ(contents.at(file.name), file.bytes) << file.name;
      }
    }
    EXPECT_EQ(contents.contains("camera/front/color/000005.png"), format == "kitti");
    // Without the camera, all other files of the frames would be the same.
    const TemporaryDirectory other;
    (void)RunSequence(ExampleRun(other.path(), format), MakeExampleFrame, NoHooks());
    for (const auto& [name, bytes] : Contents(other.path())) {
      if (name == "frames.jsonl" || name == "manifest.json") continue;
      EXPECT_EQ(contents.at(name), bytes) << name;
    }
  }
}

TEST(CameraSequence, ContinuesAfterAnInterruptionWithTheSameBytes) {
  const TemporaryDirectory undisturbed;
  (void)MakeRun(RunWithCamera(undisturbed.path(), "pcd"));
  const auto expected = Contents(undisturbed.path());
  const TemporaryDirectory directory;
  std::uint32_t num_done = 0;
  const SequenceHooks stop_after_three = {
      [&](std::uint32_t done, std::uint32_t) { num_done = done; }, [&] { return num_done >= 3; }};
  EXPECT_FALSE(MakeRun(RunWithCamera(directory.path(), "pcd"), stop_after_three).is_complete);
  // An image that was damaged and one that was not finished are made anew.
  WriteFileWhole(directory.path() / "camera/front/label/000004.png", "damaged");
  WriteFileWhole(directory.path() / "camera/front/depth/000008.npy.part", "begun");
  EXPECT_TRUE(MakeRun(RunWithCamera(directory.path(), "pcd")).is_complete);
  EXPECT_EQ(Contents(directory.path()), expected);
}

TEST(CameraSequence, NoticesAnImageThatWasChanged) {
  const TemporaryDirectory directory;
  (void)MakeRun(RunWithCamera(directory.path(), "pcd"));
  WriteFileWhole(directory.path() / "camera/front/color/000006.png", "changed");
  EXPECT_EQ(
      MakeRun(RunWithCamera(directory.path(), "pcd")).changed,
      std::vector<std::string>{directory.path().string() + ": frame 6 was changed or removed"});
}

}  // namespace
}  // namespace railcast
