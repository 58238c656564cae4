#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/certify/certified_figures.h"
#include "core/io/run/scenario_identity.h"
#include "core/scenario/command_log.h"
#include "generator/run/frame_maker.h"
#include "generator/run/run_extras.h"
#include "railcast/io/cloud_files.h"
#include "railcast/material.h"
#include "railcast/scenario.h"

namespace railcast {

/// Which frames of a scenario are written, where and how.
struct RunChoices {
  std::filesystem::path directory;
  std::string format = "pcd";
  std::string fields = "all";
  std::string isa;  ///< Instruction set of the trace; empty = the machine's best.
  std::uint32_t start_frame = 0;
  std::uint32_t num_frames = 10;
  std::uint32_t stride = 1;
  bool is_merged = false;       ///< Whether the clouds of several sensors are merged, too.
  std::string certify = "off";  ///< A share of the time, "1%", or "off".
  int num_threads = 0;          ///< 0 = all cores.
};

/// Everything that the bytes of a sequence directory depend on.
struct SequenceSpec {
  std::filesystem::path directory;
  std::string version;         ///< ProgramVersion().
  std::string embree_version;  ///< EmbreeVersion().
  std::string isa;             ///< IsaInUse() of the trace.
  ScenarioIdentity identity;   ///< With the command line's seed and rung.
  /// The directory of the run's first sensor, whose copies of inputs are this one's, too; empty of
  /// the first.
  std::filesystem::path twin{};
  /// CommandLogText of the replayed commands; empty if there are none.
  std::string commands_jsonl;
  std::uint64_t seed{};  ///< The scenario's, for the manifest.
  /// The choice of fidelity auto; empty if the scenario does not use it.
  std::string fidelity_choice_json;
  FrameFileSpec files;
  /// The layout of the points in the run's bag (RunExtras::layouts); empty = the fields above.
  std::string layout{};
  /// The run's bag, relative to the directory, and the topics of the sensor's clouds in it; empty
  /// unless the format is one.
  std::string bag;
  std::vector<std::string> cloud_topics;
  /// The trace, relative to the directory, and what finds or begins it; empty unless the format is
  /// one.
  std::string trace{};
  std::function<std::unique_ptr<SequenceTrace>()> make_trace{};
  std::string camera;            ///< Name of the scenario's camera; empty = it has none.
  std::string calibration_json;  ///< CalibrationJson() of the camera.
  /// The sensors whose samples belong to the frames; absent = none.
  std::optional<MotionSensorsSpec> motion_sensors{};
  MaterialLibrary materials;
  std::uint32_t start_frame{};
  std::uint32_t num_frames{};
  std::uint32_t stride = 1;  ///< Every how many-th of the scenario's frames is made.
  /// Absent: the run is not certified. The time share is known at once, all else from
  /// FrameMaker::Certify() on.
  std::optional<CertifySpec> certify{};

  /// The number of the run's i-th frame.
  [[nodiscard]] std::uint32_t FrameAt(std::uint32_t i) const { return start_frame + i * stride; }
};

/// What is made of one of a scenario's sensors.
struct SensorPlan {
  std::string name;
  ScenarioSpec scenario;  ///< Reduced to the sensor (PickSensor()).
  SequenceSpec spec;
};

/// What a run makes: a sequence of each of a scenario's sensors.
struct RunPlan {
  std::filesystem::path directory;
  bool is_merged{};       ///< Whether the sensors' clouds are merged, too.
  ScenarioSpec scenario;  ///< With all of these sensors.
  std::vector<SensorPlan> sensors;
  std::vector<TimedCommand> commands;  ///< Commands that change the simulation meanwhile.
  std::string commands_place;          ///< Where they stand, for messages: "log.jsonl: ".

  /// Whether there are several sensors; then each has a folder of its own, and sensors.json names
  /// them.
  [[nodiscard]] bool is_in_folders() const { return sensors.size() > 1; }
};

/// Plans one sequence for each of a scenario's `lidars`, in their order, in a folder of the
/// sensor's name below the directory; that of a single `lidar` is in the directory itself. The
/// camera and the motion sensors, if there are any, belong to the first sensor's.
/// @param shown The scenario's name in messages.
/// @throws InputError if the format cannot hold the scenario's points, the fields or the
///   instruction set do not fit, the build lacks what the format needs, or a sensor's name cannot
///   be that of a folder.
[[nodiscard]] RunPlan PlanRun(ScenarioSpec scenario,
                              const RunChoices& choices,
                              const std::string& shown);

/// Checks that the names of a scenario's `lidars` can be those of folders.
/// @throws InputError "sensor: must be chosen, ...".
void CheckNamesOfFolders(const ScenarioSpec& scenario);

/// Refuses a directory of several sensors that holds anything but their folders, that of their
/// merged clouds, in which there is nothing else, and sensors.json.
/// @pre The frames are set.
/// @throws InputError "DIR: must hold nothing but ... (got "frames")".
void RefuseOtherFiles(const RunPlan& plan);

/// Has the commands of a log change the simulation: those since its last reset.
/// @param whole The scenario with all its sensors. The log may belong to it, or to the only sensor
///   that is planned.
/// @throws InputError "LOG: must be the log of this scenario with ...", or if it cannot be read.
void UseCommands(const std::filesystem::path& log, const ScenarioSpec& whole, RunPlan& plan);

/// Completes a plan by what the simulators tell: the choices of frames are those of the first
/// sensor, and the others make those of their frames that begin while its frames last.
/// @param maker Must outlive the plan if its format is a trace.
/// @throws InputError if a file of the scenario has changed since it was read, a sensor has no such
///   frame, or a frame's stamp does not fit into 64 bits.
void SetFrames(const FrameMaker& maker, RunPlan& plan);

/// The numbers that command lines may give to frames.
inline constexpr std::uint64_t kMaxFrame = 1'000'000'000;

/// Checks that a frame's stamp fits into 64 bits.
/// @param option The option with which the user chose the frame.
/// @throws InputError if the frame is so late that it does not.
void CheckHasStamp(const std::string& option, const ScanPattern& pattern, std::uint32_t frame);

}  // namespace railcast
