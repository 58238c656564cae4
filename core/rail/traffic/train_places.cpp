#include "core/rail/traffic/train_places.h"

#include <numbers>

#include "core/rail/objects/table_models.h"

namespace railcast {

double LengthOf_m(std::span<const TrainVehicleSpec> vehicles) {
  double length_m = 0.0;
  for (const TrainVehicleSpec& vehicle : vehicles) length_m += MeasuresOf(vehicle.type).length_m;
  return length_m;
}

double MiddleBehindFront_m(std::span<const TrainVehicleSpec> vehicles, std::size_t vehicle) {
  return LengthOf_m(vehicles.first(vehicle)) + 0.5 * MeasuresOf(vehicles[vehicle].type).length_m;
}

std::string NameOfVehicle(const TrainSpec& train, std::size_t vehicle) {
  return train.vehicles[vehicle].name.value_or(train.name + "/" + std::to_string(vehicle + 1));
}

bool RunsBack(const TrainSpec& train) {
  return train.motion && train.motion->reverse;
}

TrackPose PoseInTrain(const TrainVehicleSpec& vehicle, bool runs_back) {
  return {.heading_rad = runs_back != vehicle.is_turned ? std::numbers::pi : 0.0,
          .pivot_distance_m = MeasuresOf(vehicle.type).pivot_distance_m,
          .is_midway = true};
}

std::size_t NumVehicles(std::span<const TrainSpec> trains) {
  std::size_t num_vehicles = 0;
  for (const TrainSpec& train : trains) num_vehicles += train.vehicles.size();
  return num_vehicles;
}

std::optional<VehicleOfTrain> VehicleWithInstance(const WorldSpec& world, std::uint32_t instance) {
  if (instance <= world.objects.size()) return std::nullopt;
  std::size_t index = instance - world.objects.size() - 1;
  for (std::size_t i = 0; i < world.trains.size(); ++i) {
    const std::size_t num_vehicles = world.trains[i].vehicles.size();
    if (index < num_vehicles) return VehicleOfTrain{i, index};
    index -= num_vehicles;
  }
  return std::nullopt;
}

}  // namespace railcast
