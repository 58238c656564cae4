#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/io/run/scenario_identity.h"
#include "core/io/write_file.h"
#include "generator/run/make_frames.h"
#include "railcast/scenario.h"

namespace railcast {

/// Options of a made sequence.
struct MadeSequenceSpec {
  std::string format = "pcd";
  std::string fields = "all";
  std::string fidelity = "plausibility";
  std::string output = R"({"frame": "sensor"})";
  std::string sensor = "vir2rail";
  std::string return_mode = "strongest";
  bool has_velocity = false;
  std::string lidar{};  ///< Further members of the section `lidar`: R"(, "name": ...)".
  std::string object = R"({"name": "wagon", "type": "open_wagon", "s_m": 300})";
  Vector3 wagon_velocity_mps = Vector3::Zero();
  std::uint32_t start_frame = 0;
  std::uint32_t num_frames = 2;
};

/// The scenario of a sequence and the frames that were written.
struct MadeSequence {
  ScenarioSpec scenario;
  std::vector<Frame> frames;  ///< In the axes of the output.
};

/// Returns the text of a scenario: a vehicle at 20 m/s in a curve of 500 m radius, and an object.
inline std::string MadeScenario(const MadeSequenceSpec& spec) {
  const std::string folder = RAILCAST_SOURCE_DIR "/scenarios/";
  return R"({"version": 1, "fidelity": ")" + spec.fidelity + R"(", "lidar": {"file": ")" + folder +
         "sensors/" + spec.sensor + R"(.json", "mount": {"position_m": [2.2, 0.1, 2.5], )" +
         R"("pitch_deg": 3}, "receiver": {"return_mode": ")" + spec.return_mode + R"("})" +
         (spec.has_velocity ? R"(, "velocity": {"sigma_mps": 0.03, "max_mps": 50})" : "") +
         spec.lidar + R"(}, )" +
         R"("world": {"alignment": {"course": {"type": "elements", "elements": [)" +
         R"({"type": "arc", "length_m": 900, "radius_m": 500}]}}, )" + R"("objects": [)" +
         spec.object + "]}, " +
         R"("vehicle": {"start_s_m": 250, "motion": {"profile": [{"time_s": 0, )" +
         R"("speed_mps": 20}]}}, "output": )" + spec.output + R"(, "materials": ")" + folder +
         R"(materials/railway.json", "labels": ")" + folder + "labels.json\"}\n";
}

/// The frames of a scenario that a program has needed so far, by number: each is simulated once,
/// however often it is written.
inline const std::map<std::uint32_t, Frame>& ScannedFrames(const ScenarioSpec& scenario,
                                                           const MadeSequenceSpec& made) {
  static std::map<std::string, std::map<std::uint32_t, Frame>> frames_by_scenario;
  std::map<std::uint32_t, Frame>& frames = frames_by_scenario[MadeScenario(made)];
  std::unique_ptr<Simulator> simulator;
  for (std::uint32_t i = made.start_frame; i < made.start_frame + made.num_frames; ++i) {
    if (frames.contains(i)) continue;
    if (simulator == nullptr) simulator = MakeSimulator(scenario, 1);
    simulator->Scan(i, frames[i]);
  }
  return frames;
}

/// Writes a sequence of that scenario as railcast-generate would.
/// @param directory Must not exist.
inline MadeSequence MakeSequence(const std::filesystem::path& directory,
                                 const MadeSequenceSpec& made) {
  std::filesystem::create_directories(directory);
  const std::filesystem::path file = directory.string() + ".json";
  WriteFileWhole(file, MadeScenario(made));
  MadeSequence result{.scenario = ReadScenario(file), .frames = {}};
  SequenceSpec spec;
  spec.directory = directory;
  spec.version = "0.1.0";
  spec.embree_version = "3.13.5";
  spec.isa = "avx2";
  spec.identity = IdentityOf(result.scenario);
  spec.files = {&ParseFrameFormat(made.format), FieldSelection(made.fields, made.has_velocity),
                LabelTable(result.scenario.labels)};
  spec.materials = MaterialLibrary(result.scenario.materials);
  spec.start_frame = made.start_frame;
  spec.num_frames = made.num_frames;
  const std::map<std::uint32_t, Frame>& frames = ScannedFrames(result.scenario, made);
  const auto make = [&](std::uint32_t index, MadeFrame& to) {
    to.frame = frames.at(index);
    ObjectInFrame wagon{"wagon", "open_wagon", "wagon", 1};
    wagon.size_m = Vector3(14.0, 3.0, 3.4);
    wagon.world_from_box = to.frame.world_from_sensor;
    wagon.world_from_box.translate(Vector3(40.0 - 2.0 * index, 1.0, 0.5));
    wagon.points = 7 + index;
    wagon.points_time_ns = 1000 + index;
    wagon.velocity_world_mps = made.wagon_velocity_mps;
    wagon.view = {11, 9, 11, 9};
    to.objects = {wagon};
    result.frames.push_back(to.frame);
  };
  const BeginFrame begin = [&](std::uint32_t index) -> FrameJob {
    return [&make, index](MadeFrame& to) { make(index, to); };
  };
  (void)RunSequence(spec, begin, {[](std::uint32_t, std::uint32_t) {}, [] { return false; }});
  return result;
}

}  // namespace railcast
