#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/frame/labels.h"
#include "core/scene/material.h"
#include "core/scene/world.h"

namespace railcast {

/// A piece of a world as plain triangles, in the frame of one of its chunks.
struct ExportedWorld {
  Transform world_from_export = Transform::Identity();
  std::vector<Part> parts;  ///< One for each pair of label and material, ordered by them.
};

/// Gathers what stands in `chunks` (of `chunk_length_m` each) and the objects that are there at
/// that time, in the frame of the first of the chunks. @pre `chunks` is not empty.
/// @param on_progress Called with the number of chunks gathered so far.
[[nodiscard]] ExportedWorld ExportWorld(
    const World& world,
    const std::vector<int>& chunks,
    double chunk_length_m,
    std::int64_t time_ns,
    const std::function<void(std::size_t)>& on_progress = [](std::size_t) {});

/// Binary little-endian PLY: float vertices, faces with label, material and the label's colour. A
/// comment holds world_from_export by rows.
[[nodiscard]] std::string EncodePlyMesh(const ExportedWorld& exported, const LabelTable& labels);

/// OBJ with an object for each label and `usemtl` for each material.
[[nodiscard]] std::string EncodeObjMesh(const ExportedWorld& exported,
                                        const LabelTable& labels,
                                        const MaterialLibrary& materials);

}  // namespace railcast
