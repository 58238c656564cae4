#pragma once

#include "core/rail/objects/object_surfaces.h"
#include "railcast/objects.h"
#include "railcast/scene.h"

namespace railcast {

/// Vehicles that use level crossings, 3,000 to 5,000 triangles each. Frame: origin on the road
/// below the middle of the footprint, x forward, y left, z up; metres. Bodies are lofted through
/// cross-sections; panes are opaque glass, since nothing behind them is modelled. Number plates of
/// 520 x 110 mm, rear reflectors and the contour tape of lorries (UN regulations 3 and 104) are
/// retroreflective. What no source is given for is a working value.

[[nodiscard]] constexpr bool IsRoadVehicle(ObjectType type) {
  return type == ObjectType::kCar || type == ObjectType::kLorry || type == ObjectType::kTractor ||
         type == ObjectType::kBus || type == ObjectType::kBicycle ||
         type == ObjectType::kMotorcycle;
}

/// @pre IsRoadVehicle(type).
[[nodiscard]] Model MakeRoadVehicle(ObjectType type, const RoadVehicleSurfaces& surfaces);

/// A compact hatchback like the VW Golf 8: 4.284 m long, 1.789 m wide (2.073 m over the mirrors),
/// 1.456 m high, wheelbase 2.636 m (VW press release of October 2019); tyres 205/55 R 16.
[[nodiscard]] Model MakeCar(const RoadVehicleSurfaces& surfaces);

/// A tractor unit with a box semi-trailer of three axles, as large as Directive 96/53/EC permits:
/// 16.50 m long, 2.55 m wide, 4.00 m high; king pin 12.0 m before the rear. Tyres 315/70 R 22.5 and
/// 385/65 R 22.5. Mirrors, which the directive does not count, are left out.
[[nodiscard]] Model MakeLorry(const RoadVehicleSurfaces& surfaces);

/// A city bus like the Mercedes-Benz Citaro: 12.135 m long, 2.550 m wide (2.950 m over the
/// mirrors), 3.120 m high, wheelbase 5.900 m (EvoBus, technical information); three doors on the
/// right.
[[nodiscard]] Model MakeBus(const RoadVehicleSurfaces& surfaces);

/// A farm tractor like the Fendt 310 Vario: 4.150 m long, 2.275 m wide, 2.760 m high, wheelbase
/// 2.350 m, tyres 440/65 R 24 and 540/65 R 34 (Traktorenlexikon, Wikibooks).
[[nodiscard]] Model MakeTractor(const RoadVehicleSurfaces& surfaces);

/// A city bicycle without its rider: 1.80 m long, 0.60 m wide, 1.07 m high, tyres 37-622 (ISO
/// 5775), with reflectors. Stands upright.
[[nodiscard]] Model MakeBicycle(const RoadVehicleSurfaces& surfaces);

/// A motorcycle like the Honda CB500F without its rider: 2.080 m long, 0.790 m wide over the
/// mirrors, 1.060 m high, wheelbase 1.410 m, tyres 120/70 and 160/60 R 17 (Honda, model year 2019).
[[nodiscard]] Model MakeMotorcycle(const RoadVehicleSurfaces& surfaces);

}  // namespace railcast
