#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "railcast/io/recording.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/run_command.h"
#include "viewer/color/palette.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {

/// Runs railcast-generate.
inline Ended Generate(const std::string& arguments) {
  return RunCommand(std::string(RAILCAST_GENERATE) + " " + arguments);
}

/// A straight line on which a vehicle approaches a standing wagon at 20 m/s, past a person and a
/// post, while a train of one wagon comes the other way on the second track.
/// @param weather The value of that key of a scenario.
inline std::string YardScenario(const std::string& weather = R"({"rain_rate_mmph": 10})") {
  const std::string scenarios = std::string(RAILCAST_SOURCE_DIR) + "/scenarios/";
  std::string text = R"({
    "version": 1,
    "fidelity": "surface",
    "lidar": {"file": ")";
  text += scenarios;
  text += R"(sensors/vir2rail.json", "mount": {"position_m": [2.2, 0, 2.5]}},
    "weather": )";
  text += weather;
  text += R"(,
    "world": {
      "alignment": {
        "course": {"type": "elements", "elements": [{"type": "straight", "length_m": 1000}]}
      },
      "tracks": [{"name": "main"}, {"name": "second", "offset_m": 4.5}],
      "vegetation": {"trees_per_hectare": 0, "grass": false},
      "objects": [
        {"name": "standing", "type": "open_wagon", "s_m": 460},
        {"name": "train", "type": "tank_wagon", "track": "second", "s_m": 470,
         "motion": {"profile": [{"time_s": 0, "speed_mps": 15}], "reverse": true}},
        {"name": "worker", "type": "person", "s_m": 436, "d_m": -3, "heading_deg": 90},
        {"name": "post", "type": "pole", "s_m": 442, "d_m": -5, "size_m": [0.4, 0.4, 4.0]}
      ]
    },
    "vehicle": {"start_s_m": 400, "motion": {"profile": [{"time_s": 0, "speed_mps": 20}]}},
    "materials": ")";
  text += scenarios;
  text += R"(materials/railway.json",
    "labels": ")";
  text += scenarios;
  return text + "labels.json\"\n}\n";
}

/// A sequence made by railcast-generate.
class RecordedRun {
 public:
  /// @throws std::runtime_error if it cannot be made.
  RecordedRun(const std::string& scenario, int num_frames, const std::string& options = "") {
    WriteFileWhole(scenario_file(), scenario);
    const Ended ended =
        Generate("sequence " + scenario_file().string() + " --frames " +
                 std::to_string(num_frames) + " --out " + path().string() + " " + options);
    if (ended.status != 0) throw std::runtime_error(ended.said);
    const auto recording = OpenRecording(path());
    info_ = recording->info();
    while (const auto reader = recording->Next()) frames_.push_back(MakeShownFrame((*reader)()));
  }

  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "run"; }
  [[nodiscard]] std::filesystem::path scenario_file() const {
    return folder_.path() / "scenario.json";
  }
  [[nodiscard]] const RecordingInfo& info() const { return info_; }
  [[nodiscard]] const ShownFrame& frame(std::size_t index) const { return frames_.at(index); }
  [[nodiscard]] std::size_t num_frames() const { return frames_.size(); }

  [[nodiscard]] Rgb ColorOf(const std::string& label) const {
    return info_.labels.Find(label)->rgb;
  }
  [[nodiscard]] const RecordedObject& ObjectOf(std::size_t frame_index,
                                               const std::string& name) const {
    for (const RecordedObject& object : frame(frame_index).recorded->objects) {
      if (object.name == name) return object;
    }
    throw std::runtime_error("no object " + name);
  }

  /// Six frames of YardScenario() in rain, made at the first call.
  static const RecordedRun& Yard() {
    static const RecordedRun run(YardScenario(), 6);
    return run;
  }

 private:
  TemporaryDirectory folder_;
  RecordingInfo info_;
  std::vector<ShownFrame> frames_;
};

}  // namespace railcast
