#pragma once

#include <string_view>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/objects.h"
#include "railcast/scene.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Main dimensions of a rail vehicle, as its table of models has them.
struct RailVehicleMeasures {
  double length_m{};          ///< Over buffers or couplers.
  double pivot_distance_m{};  ///< Between the pivots of the two bogies.
  double width_m{};
  double height_m{};  ///< Above top of rail; with a raised pantograph, that of its contact strip.
};

/// @pre IsRailVehicle(type).
[[nodiscard]] RailVehicleMeasures MeasuresOf(const ObjectType& type);

/// The whole vehicle on straight track: the body with its bogies half of `pivot_distance_m` before
/// and behind the middle.
[[nodiscard]] Model WholeOf(const Model& body, const Model& bogie, double pivot_distance_m);

/// Things that a table of models describes, as opposed to shapes that code makes.

/// The pieces of a model, of which only a rail vehicle has two: its body, with the origin midway
/// between the pivots, and either bogie, with the origin in its pivot's axis. Parts have materials
/// and labels as those of a mesh object have (mesh_object.h), with `otherwise` for a material that
/// nothing says.
/// @pre The type has a model.
/// @throws InputError as CheckNamesOfModel(), and for a model of the scenario's own table with
///   faults whose places begin with "/models/" and its place there.
[[nodiscard]] std::vector<Model> MakeTableModel(const ObjectType& type,
                                                std::uint16_t otherwise,
                                                const LabelTable& labels,
                                                const MaterialLibrary& materials);

/// @throws InputError with a line for every name of the type's model, if it has one, that the
/// tables
///   lack, if both could be read.
void CheckNamesOfModel(const ObjectType& type,
                       const LabelTable& labels,
                       const MaterialLibrary& materials);

/// Whether objects of the type may have surfaces of the material.
[[nodiscard]] bool MayHaveMaterial(const ObjectType& type, std::string_view name);

}  // namespace railcast
