#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/rail/motion/ride.h"
#include "core/rail/motion/track_path.h"
#include "core/rail/objects/object_models.h"
#include "railcast/alignment.h"
#include "railcast/objects.h"
#include "railcast/scene.h"
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

/// Distance between the pivots of the vehicle that carries the sensor, 0 = none: that of its type
/// if it is part of a train, otherwise the given one.
/// @pre The train consists of rail vehicles.
[[nodiscard]] double PivotDistance_m(const VehicleSpec& vehicle);

/// How far the origin of the vehicle frame is behind the foremost buffers of the sensor's train,
/// along the track.
/// @pre It is part of a train of rail vehicles.
[[nodiscard]] double OriginBehindFront_m(const VehicleSpec& vehicle);

/// The name of a vehicle of the sensor's own train: "ego" if it carries the sensor; otherwise, if
/// it is the third, "ego/3".
[[nodiscard]] std::string NameOfEgoVehicle(const VehicleSpec& vehicle, std::size_t index);

/// A vehicle of a train.
struct TrainVehicle {
  SceneObject object;
  std::optional<TrackPath> path;  ///< Absent: it is the one that carries the sensor.
};

/// The vehicles of the sensor's own train, from front to rear, with the label "ego". The frame of
/// the one that carries the sensor is the vehicle frame, which has its origin at the front pivot.
/// @param path Of the vehicle that carries the sensor.
/// @param label That of "ego".
[[nodiscard]] std::vector<TrainVehicle> MakeEgoTrain(const VehicleSpec& vehicle,
                                                     const TrackPath& path,
                                                     const Alignment& alignment,
                                                     std::uint32_t label,
                                                     ObjectModels& models);

/// The own vehicle as its ego boxes, in the vehicle's frame.
[[nodiscard]] SceneObject MakeEgoBoxes(const VehicleSpec& vehicle,
                                       const TrackPath& path,
                                       const SurfaceClass& surface);

/// How the body of the own vehicle moves on its springs; absent if it does not.
[[nodiscard]] std::optional<Ride> RideOf(const VehicleSpec& vehicle, std::uint64_t seed);

}  // namespace railcast
