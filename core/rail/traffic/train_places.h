#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/rail/motion/track_path.h"
#include "railcast/objects.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Where the vehicles of a train are in it. Coupled vehicles touch with their buffers.

/// The train's length over buffers.
/// @pre The types are those of rail vehicles.
[[nodiscard]] double LengthOf_m(std::span<const TrainVehicleSpec> vehicles);

/// How far the middle of a vehicle is behind the train's foremost buffers, along the track.
/// @pre As above.
[[nodiscard]] double MiddleBehindFront_m(std::span<const TrainVehicleSpec> vehicles,
                                         std::size_t vehicle);

/// The given name or "TRAIN/3".
[[nodiscard]] std::string NameOfVehicle(const TrainSpec& train, std::size_t vehicle);

/// Whether the train's front faces falling chainage.
[[nodiscard]] bool RunsBack(const TrainSpec& train);

/// How a vehicle of a train stands on its track.
/// @param runs_back Whether the train's front faces falling chainage.
[[nodiscard]] TrackPose PoseInTrain(const TrainVehicleSpec& vehicle, bool runs_back);

/// The number of vehicles of all trains but the sensor's own.
[[nodiscard]] std::size_t NumVehicles(std::span<const TrainSpec> trains);

/// A vehicle as an index into WorldSpec::trains and one into the train's vehicles.
struct VehicleOfTrain {
  std::size_t train{};
  std::size_t vehicle{};
};
/// The vehicle with that instance id; absent if none has it.
[[nodiscard]] std::optional<VehicleOfTrain> VehicleWithInstance(const WorldSpec& world,
                                                                std::uint32_t instance);

}  // namespace railcast
