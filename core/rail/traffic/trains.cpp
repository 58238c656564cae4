#include "core/rail/traffic/trains.h"

#include <cstddef>
#include <memory>
#include <numbers>
#include <utility>

#include "core/rail/line/track_course.h"
#include "core/rail/objects/mesh_object.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr const char* kOwnVehicle = "ego";

std::shared_ptr<const Model> MovedModel(const Model& model, const Transform& to_from_model) {
  Model moved{model.name, {}, model.is_foliage};
  for (const Part& part : model.parts) {
    Part& added = moved.parts.emplace_back(Part{{}, part.material, part.label, part.is_wire});
    added.mesh.Append(part.mesh, to_from_model);
  }
  return std::make_shared<const Model>(std::move(moved));
}

/// Puts the vehicle that carries the sensor into the vehicle frame.
void PutIntoVehicleFrame(const TrainVehicleSpec& vehicle, SceneObject& object) {
  const double yaw_rad = vehicle.is_turned ? std::numbers::pi : 0.0;
  const Eigen::Matrix3d turn = RotationFromYawPitchRoll(yaw_rad, 0.0, 0.0);
  const Transform vehicle_from_body =
      MakeTransform(turn, {-0.5 * MeasuresOf(vehicle.type).pivot_distance_m, 0.0, 0.0});
  object.model = MovedModel(*object.model, vehicle_from_body);
  object.pieces.front() = MovedModel(*object.pieces.front(), vehicle_from_body);
  for (std::size_t i = 1; i < object.pieces.size(); ++i) {
    object.pieces[i] = MovedModel(*object.pieces[i], MakeTransform(turn, Vector3::Zero()));
  }
}

}  // namespace

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

double PivotDistance_m(const VehicleSpec& vehicle) {
  if (vehicle.consist.empty()) return vehicle.pivot_distance_m;
  return MeasuresOf(vehicle.consist[vehicle.sensor_vehicle].type).pivot_distance_m;
}

double OriginBehindFront_m(const VehicleSpec& vehicle) {
  return MiddleBehindFront_m(vehicle.consist, vehicle.sensor_vehicle) -
         0.5 * PivotDistance_m(vehicle);
}

std::string NameOfEgoVehicle(const VehicleSpec& vehicle, std::size_t index) {
  if (index == vehicle.sensor_vehicle) return kOwnVehicle;
  return std::string(kOwnVehicle) + "/" + std::to_string(index + 1);
}

std::vector<TrainVehicle> MakeEgoTrain(const VehicleSpec& vehicle,
                                       const TrackPath& path,
                                       const Alignment& alignment,
                                       std::uint32_t label,
                                       ObjectModels& models) {
  std::shared_ptr<const TrackLength> length;
  if (vehicle.consist.size() > 1) {
    length = std::make_shared<const TrackLength>(alignment, path.course());
  }
  const double origin_behind_front_m = OriginBehindFront_m(vehicle);
  std::vector<TrainVehicle> train;
  for (std::size_t i = 0; i < vehicle.consist.size(); ++i) {
    ObjectSpec spec;
    spec.name = NameOfEgoVehicle(vehicle, i);
    spec.type = vehicle.consist[i].type;
    spec.label = kOwnVehicle;
    TrainVehicle& own = train.emplace_back();
    own.object = {.name = spec.name,
                  .type = kOwnVehicle,
                  .label = label,
                  .model = models.Of(spec),
                  .moves = path.moves(),
                  .is_ego = true,
                  .pieces = models.VehiclePiecesOf(spec)};
    if (i == vehicle.sensor_vehicle) {
      PutIntoVehicleFrame(vehicle.consist[i], own.object);
      continue;
    }
    const double behind_m = MiddleBehindFront_m(vehicle.consist, i) - origin_behind_front_m;
    own.path =
        path.Behind(length, behind_m, PoseInTrain(vehicle.consist[i], vehicle.motion.reverse));
  }
  return train;
}

SceneObject MakeEgoBoxes(const VehicleSpec& vehicle,
                         const TrackPath& path,
                         const SurfaceClass& surface) {
  Model model{"ego", {{{}, surface.material, surface.label}}};
  for (const std::array<double, 6>& box : vehicle.ego_boxes_m) {
    model.parts.front().mesh.Append(
        MakeBox({Vector3(box[0], box[1], box[2]), Vector3(box[3], box[4], box[5])}));
  }
  return {.name = "ego",
          .type = "ego",
          .label = surface.label,
          .model = std::make_shared<const Model>(std::move(model)),
          .moves = path.moves(),
          .is_ego = true};
}

std::optional<Ride> RideOf(const VehicleSpec& vehicle, std::uint64_t seed) {
  if (!vehicle.ride) return std::nullopt;
  return Ride(*vehicle.ride, seed, PivotDistance_m(vehicle));
}

}  // namespace railcast
