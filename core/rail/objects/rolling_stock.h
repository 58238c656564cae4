#pragma once

#include "core/rail/objects/rail_vehicles.h"

namespace railcast {

/// The single rail vehicles, each with its main dimensions and its geometry (MakeRailVehicle()).

/// Freight wagons. Dimensions: docs/physics.md 7.3 (DB Cargo's wagon catalogue, UIC standard
/// parts).

/// Eaos, a high-sided open wagon: floor 1.24 m above top of rail, inside 12.8 x 2.76 x 2.10 m.
inline constexpr RailVehicleMeasures kOpenWagonMeasures = {
    .length_m = 14.04, .pivot_distance_m = 9.0, .width_m = 3.0, .height_m = 3.34};
[[nodiscard]] RailVehicleModel MakeOpenWagon(const RailSurfaces& surfaces);

/// Sgns, a 60-foot container wagon without floor: fish-bellied side sills, container supports 1.16
/// m above top of rail with spigots on top. The headstocks are the widest part, the buffers the
/// highest.
inline constexpr RailVehicleMeasures kFlatWagonMeasures = {
    .length_m = 19.74, .pivot_distance_m = 14.2, .width_m = 2.6, .height_m = 1.285};
[[nodiscard]] RailVehicleModel MakeFlatWagon(const RailSurfaces& surfaces);

/// Zacns, a tank wagon: tank of 2.9 m diameter, with ladders, walkway and end platform.
inline constexpr RailVehicleMeasures kTankWagonMeasures = {
    .length_m = 16.0, .pivot_distance_m = 10.5, .width_m = 3.1, .height_m = 4.27};
[[nodiscard]] RailVehicleModel MakeTankWagon(const RailSurfaces& surfaces);

/// Sgns with two containers of ISO 668, 8 feet 6 inches high: one of 40 and one of 20 feet.
/// Standing on the supports, they are the highest part.
inline constexpr RailVehicleMeasures kContainerWagonMeasures = {
    .length_m = 19.74, .pivot_distance_m = 14.2, .width_m = 2.6, .height_m = 3.751};
[[nodiscard]] RailVehicleModel MakeContainerWagon(const RailSurfaces& surfaces);

/// Habbiins, a covered wagon with two sliding walls on each side. Its dimensions are working values
/// within gauge G1 for a loading length of 22 m.
inline constexpr RailVehicleMeasures kCoveredWagonMeasures = {
    .length_m = 23.264, .pivot_distance_m = 17.7, .width_m = 2.9, .height_m = 4.28};
[[nodiscard]] RailVehicleModel MakeCoveredWagon(const RailSurfaces& surfaces);

/// Fals 164, an open hopper wagon with a saddle floor and two discharge flaps on each side: opening
/// 11.94 x 1.94 m, flaps of 5.0 m (dybas.de, Fals 164). The width, which is not given there, is
/// that of the similar Falrrs 153.
inline constexpr RailVehicleMeasures kHopperWagonMeasures = {
    .length_m = 13.5, .pivot_distance_m = 7.2, .width_m = 3.068, .height_m = 3.996};
[[nodiscard]] RailVehicleModel MakeHopperWagon(const RailSurfaces& surfaces);

/// DB class 294 (V 90), a diesel shunting locomotive with a cab between two hoods; the longer hood
/// is in front: bogies with axles 2.5 m apart, wheels of 1.10 m (schiebebuehne.de, 290).
inline constexpr RailVehicleMeasures kShuntingLocomotiveMeasures = {
    .length_m = 14.32, .pivot_distance_m = 7.0, .width_m = 3.115, .height_m = 4.25};
[[nodiscard]] RailVehicleModel MakeShuntingLocomotive(const RailSurfaces& surfaces);

/// Siemens Vectron AC, an electric locomotive with its rear pantograph raised to a contact wire 5.5
/// m above top of rail, the front one lowered: axles 3.0 m apart, wheels of 1.25 m, 4.248 m high
/// with both lowered (Siemens Mobility, Vectron data sheet).
inline constexpr RailVehicleMeasures kElectricLocomotiveMeasures = {
    .length_m = 18.98, .pivot_distance_m = 9.5, .width_m = 3.012, .height_m = 5.5};
[[nodiscard]] RailVehicleModel MakeElectricLocomotive(const RailSurfaces& surfaces);

/// The end car of ICE 3 (DB class 403), with its nose in front and a gangway behind: floor 1.25 m
/// above top of rail (Wikipedia, ICE 3).
inline constexpr RailVehicleMeasures kMultipleUnitMeasures = {
    .length_m = 25.835, .pivot_distance_m = 17.375, .width_m = 2.95, .height_m = 3.89};
[[nodiscard]] RailVehicleModel MakeMultipleUnit(const RailSurfaces& surfaces);

/// Bpmz, an open coach of UIC type Z with a door at each end of each side: body 26.1 m long, axles
/// 2.5 m apart (Wikipedia, Bpmz-Wagen der Deutschen Bundesbahn).
inline constexpr RailVehicleMeasures kCoachMeasures = {
    .length_m = 26.4, .pivot_distance_m = 19.0, .width_m = 2.825, .height_m = 4.05};
[[nodiscard]] RailVehicleModel MakeCoach(const RailSurfaces& surfaces);

/// One car of a Munich underground unit of class A, which is two cars and 37.15 m long, with its
/// cab in front: three doors 1.3 m wide on each side, axles 2.1 m apart (Wikipedia, MVG-Baureihe A;
/// trambahn.de).
inline constexpr RailVehicleMeasures kMetroCarMeasures = {
    .length_m = 18.575, .pivot_distance_m = 12.0, .width_m = 2.9, .height_m = 3.55};
[[nodiscard]] RailVehicleModel MakeMetroCar(const RailSurfaces& surfaces);

}  // namespace railcast
