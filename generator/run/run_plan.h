#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "generator/run/run_identity.h"
#include "generator/sequence/scenario_sequence.h"
#include "railcast/lidar.h"
#include "railcast/scenario.h"

namespace railcast {

/// The sequence of one of a scenario's sensors.
struct SensorRun {
  std::string name;
  ScenarioSpec scenario;  ///< Reduced to the sensor (PickSensor()).
  SequenceSpec spec;
};

/// Checks that the names of a scenario's `lidars` can be those of folders.
/// @throws InputError "sensor: must be chosen, ...".
void CheckNamesOfFolders(const ScenarioSpec& scenario);

/// One sequence for each of a scenario's `lidars`, in their order, in a folder of the sensor's name
/// below `choices.directory`; that of a single `lidar` is in `choices.directory` itself. The
/// camera, if there is one, belongs to the first sensor's. The choices are those of the first
/// sensor; SetFrames() adapts them for the others.
/// @throws InputError if a name cannot be that of a folder, or as SequenceSpecOf() does.
[[nodiscard]] std::vector<SensorRun> SensorRunsOf(const ScenarioSpec& scenario,
                                                  const SequenceChoices& choices);

/// Chooses a sensor's frames: every `stride`-th of those that begin while the frames of the first
/// sensor last, from the first one that does.
/// @throws InputError if there is none.
void SetFrames(const SequenceSpec& first,
               const ScanPattern& first_pattern,
               const ScanPattern& pattern,
               SensorRun& run);

/// Refuses a directory that holds anything but the sensors' folders, that of their merged clouds,
/// and sensors.json.
/// @throws InputError "DIR: must hold nothing but ... (got "frames")".
void RefuseOtherFiles(const std::filesystem::path& directory, const std::vector<SensorRun>& runs);

/// Returns sensors.json: the folders of a scenario's sensors, and where each sensor is on the
/// vehicle by its nominal mount.
/// @param merged The folder of the sensors' merged clouds, if there is one.
/// @throws InputError if a file of that folder cannot be read.
[[nodiscard]] std::string SensorsJson(const std::vector<SensorRun>& runs,
                                      const std::optional<std::filesystem::path>& merged);

}  // namespace railcast
