#pragma once

#include <cstdint>
#include <memory>

#include "core/frame/labels.h"
#include "core/rail/rail_surfaces.h"
#include "core/rail/world_spec.h"
#include "core/scene/material.h"
#include "core/scene/mesh.h"

namespace railcast {

/// The geometry of an object of the scenario. Frame: x forward (the way of the chainage at heading
/// 0), y left, z up; metres. The origin is the middle of the object's footprint at its foot:
/// - box, pole, person: what stands on it is at z = 0;
/// - wagons: top of rail, so that `h_m` = 0 puts them on the track;
/// - mesh: the middle of the file's bounding box in plan, at its lowest point. Files have their
///   origin anywhere (a corner, the street plan of a town), the placement by track coordinates says
///   where the object's middle is. With `size_m` each axis is scaled to its length.
/// A person is scaled to the height in `size_m`; its other two figures have no say.
/// `label` and `material` of the spec, where given, hold for all parts.
///
/// @pre ObjectSpec::file is absolute or relative to the working directory.
/// @throws InputError, one line `key: rule (got value)` or what ReadObj says.
[[nodiscard]] std::shared_ptr<const Model> MakeObjectModel(const ObjectSpec& spec,
                                                           const RailSurfaces& surfaces,
                                                           const LabelTable& labels,
                                                           const MaterialLibrary& materials);

/// The label of the whole object: the spec's, or that of its type.
/// @throws InputError if the type or the label is unknown.
[[nodiscard]] std::uint32_t ObjectLabel(const ObjectSpec& spec,
                                        const RailSurfaces& surfaces,
                                        const LabelTable& labels);

}  // namespace railcast
