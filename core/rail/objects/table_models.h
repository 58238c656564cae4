#pragma once

#include <string_view>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/objects.h"
#include "railcast/scene.h"

namespace railcast {

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
