#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/transform.h"
#include "core/scenario/scenario_spec.h"
#include "core/simulate/simulator.h"

namespace railcast {

class RailWorld;

/// How live frames may be packed: "railcast", "vlp16", ...
[[nodiscard]] std::vector<std::string> ProtocolNames();
/// The UDP port that a protocol's receivers listen at unless told otherwise.
[[nodiscard]] std::uint16_t DefaultPort(const std::string& protocol);
/// Its receivers; if it names none, the one at loopback and the protocol's own port.
[[nodiscard]] std::vector<std::string> ReceiversOf(const SensorInterface& interface);

/// Reads a scenario file and every file it names, strictly: unknown, duplicate, missing and
/// mistyped keys are errors. File names in the result are absolute.
/// @throws InputError with a line for every fault: "file: /pointer: rule (got value)". If there is
///   any, what is sound is built on trial, so that the faults that show then come along; what
///   merely follows from another fault is left out.
[[nodiscard]] ScenarioSpec ReadScenario(const std::filesystem::path& file);

/// Reads a label table (labels.json of a scenario or of a sequence), as strictly.
/// @throws InputError with a line for every fault.
[[nodiscard]] LabelTable ReadLabelTable(const std::filesystem::path& file);

/// The scenario with every default and every file's content in place. Reading it back gives the
/// same spec.
[[nodiscard]] std::string ResolvedScenarioJson(const ScenarioSpec& spec);

/// Where a sensor so mounted is on its vehicle.
[[nodiscard]] Transform VehicleFromSensor(const MountSpec& mount);

/// The effects of the scenario's rung with its single switches applied.
/// @throws InputError if two of them do not go together, as can happen to a scenario whose rung was
///   changed after reading.
[[nodiscard]] EffectSet EffectsOf(const ScenarioSpec& spec);

/// The names of the scenario's sensors, in its order; an only sensor may have none.
[[nodiscard]] std::vector<std::string> SensorNames(const ScenarioSpec& spec);

/// The scenario with one of its sensors as its only one, `lidar`, and what `interfaces` says of it.
/// @param name May be left out if there is but one.
/// @throws InputError "sensor: must be one of "front", "roof" (got "side")".
[[nodiscard]] ScenarioSpec PickSensor(const ScenarioSpec& spec,
                                      const std::optional<std::string>& name);

/// Lets a simulation of the scenario have another weather.
/// @throws InputError if that needs something that the scenario lacks.
void UseWeather(const ScenarioSpec& scenario, const WeatherSpec& weather, SimulatorSpec& spec);

/// Every fault of a scenario: those of its files, and those that show when its scan pattern and its
/// world are built. Empty if the scenario can run.
[[nodiscard]] std::vector<std::string> CheckScenario(const std::filesystem::path& file);

/// Builds the world of a scenario.
/// @throws InputError as CheckScenario() lists.
[[nodiscard]] std::shared_ptr<const RailWorld> MakeWorld(const ScenarioSpec& spec);

/// Builds the whole simulation of a scenario.
/// @throws InputError as CheckScenario() lists.
/// @param num_threads 0 = all cores.
/// @param isa Embree's instruction set to force ("sse4.2", "avx2", "avx512"); empty = the best.
[[nodiscard]] std::unique_ptr<Simulator> MakeSimulator(const ScenarioSpec& spec,
                                                       int num_threads,
                                                       const std::string& isa = {});

/// Builds the simulations of all sensors of a scenario, in its order, on one world and one scene.
/// @throws InputError as CheckScenario() lists.
[[nodiscard]] std::vector<std::unique_ptr<Simulator>> MakeSimulators(const ScenarioSpec& spec,
                                                                     int num_threads,
                                                                     const std::string& isa = {});

}  // namespace railcast
