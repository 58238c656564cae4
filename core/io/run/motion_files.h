#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "railcast/motion_sensors.h"

namespace railcast {

// The files of a sequence directory that hold the samples of motion sensors (docs/files.md): CSV
// with a line for each sample. Numbers have enough digits to restore the same doubles; a field is
// empty where there is no value.

/// The name of a motion sensor's file relative to the sequence directory: "motion/imu.csv".
[[nodiscard]] std::string MotionFileName(std::string_view sensor);

/// Whether the file belongs to a motion sensor.
[[nodiscard]] bool IsMotionFile(std::string_view name);

/// A motion sensor and the first line of its file.
struct MotionFile {
  std::string sensor;
  std::string header;
};

/// The names of all motion sensors: IMUs, GNSS receivers, odometers.
[[nodiscard]] std::vector<MotionFile> MotionFilesOf(const MotionSensorsSpec& spec);

/// The lines of these files for the samples, in their order.
[[nodiscard]] std::vector<std::string> MotionLinesOf(const MotionSamples& samples);

}  // namespace railcast
