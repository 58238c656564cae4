#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/rail/motion/ride.h"
#include "core/rail/motion/track_path.h"
#include "core/rail/objects/object_models.h"
#include "railcast/alignment.h"
#include "railcast/scene.h"
#include "railcast/world_spec.h"

namespace railcast {

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
