#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/frame/labels.h"
#include "core/rail/rail_world.h"
#include "core/scene/material.h"
#include "core/scene/world.h"

namespace railcast {

/// A piece of a world as plain triangles, in the frame of one of its chunks.
struct ExportedWorld {
  Transform world_from_export = Transform::Identity();
  std::vector<Part> parts;  ///< One for each pair of label and material, ordered by them.
};

/// Of each of the world's objects, the chunk of the line that its chainage lies in at that time:
/// the first or the last one's where it is beyond the line's ends.
[[nodiscard]] std::vector<int> ChunksOfObjects(const RailWorld& world, std::int64_t time_ns);

/// Gathers what stands in `chunks` and the objects that belong to one of them and are there at
/// that time, in the frame of the first of the chunks. @pre `chunks` is not empty.
/// @param object_chunks One for each of the world's objects.
/// @param on_progress Called with the number of chunks gathered so far.
[[nodiscard]] ExportedWorld ExportWorld(
    const World& world,
    const std::vector<int>& chunks,
    const std::vector<int>& object_chunks,
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
