#pragma once

#include <string_view>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/objects.h"

namespace railcast {

/// The surfaces of objects that tables need only if there are such objects. Each is looked up by
/// its name in both tables; where one of them is empty because it could not be read, all are 0, for
/// geometry that is built only to be checked.

/// The surfaces of road vehicles (road_vehicles.h).
struct RoadVehicleSurfaces {
  SurfaceClass paint;      ///< Of sheet metal bodies.
  SurfaceClass panel;      ///< Of light loading bodies.
  SurfaceClass window;     ///< Panes and the glasses of lamps.
  SurfaceClass trim;       ///< Black plastic, underbody, grilles.
  SurfaceClass metal;      ///< Rims, frames, engines.
  SurfaceClass tyre;       ///< Rubber.
  SurfaceClass reflector;  ///< Number plates, reflectors, contour tape.
};

/// The surfaces of animals (animals.h).
struct AnimalSurfaces {
  SurfaceClass coat;  ///< Fur.
  SurfaceClass horn;  ///< Antlers, horns, hooves, noses.
};

/// The surfaces of what may lie on the line (debris.h).
struct DebrisSurfaces {
  SurfaceClass wood, tyre, stone, soil;
  SurfaceClass leaf, bark, wire;
  SurfaceClass shoe_paint, shoe_iron;
};

/// The surfaces of a person (person.h).
struct PersonSurfaces {
  SurfaceClass skin, clothing;
  SurfaceClass hi_vis_fabric, hi_vis_band, helmet;        ///< 0 unless it wears them.
  SurfaceClass suitcase, frame, tyre, canvas, reflector;  ///< 0 unless it has luggage.
};

/// @throws InputError with a line for every name that the tables lack.
[[nodiscard]] PersonSurfaces FindPersonSurfaces(const PersonSpec& look,
                                                const LabelTable& labels,
                                                const MaterialLibrary& materials);
/// @throws InputError with a line for every name that the tables lack.
[[nodiscard]] RoadVehicleSurfaces FindRoadVehicleSurfaces(const LabelTable& labels,
                                                          const MaterialLibrary& materials);
/// @throws InputError with a line for every name that the tables lack.
[[nodiscard]] AnimalSurfaces FindAnimalSurfaces(const LabelTable& labels,
                                                const MaterialLibrary& materials);
/// @throws InputError with a line for every name that the tables lack.
[[nodiscard]] DebrisSurfaces FindDebrisSurfaces(const LabelTable& labels,
                                                const MaterialLibrary& materials);

/// The label of a person, a road vehicle, an animal or debris as a whole.
[[nodiscard]] std::string_view LabelNameOf(ObjectType type);

/// Whether road vehicles, animals or debris of that type have surfaces of the material.
[[nodiscard]] bool IsMaterialOf(ObjectType type, std::string_view name);

}  // namespace railcast
