#pragma once

#include <span>
#include <string>

#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/objects.h"

namespace railcast {

/// Reads the mesh files of all objects and says of each model how large it is, how many triangles
/// it has, what was left out and why, how far it was simplified, which of its parts has which
/// material and label and why, and what about it is likely to be a mistake. Objects with one model
/// share its paragraph. Empty if no object is a mesh.
///
/// A mistake is guessed where a model
/// - is larger than 100 m or smaller than 1 cm;
/// - has the file's origin and more than half of its height below its place;
/// - is taken to have z up and in its file stands on the plane y = 0 (within 2 % of its extent in
///   y) but reaches through z = 0 (by more than a quarter of its extent in z to either side).
///   Modelling programs with y up have the ground at y = 0 and the model's middle at z = 0.
///
/// @throws InputError if a file cannot be read (any more).
[[nodiscard]] std::string MeshesText(std::span<const ObjectSpec> objects,
                                     const LabelTable& labels,
                                     const MaterialLibrary& materials);

}  // namespace railcast
