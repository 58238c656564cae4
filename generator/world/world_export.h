#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/scene/part_gatherer.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/rail_world.h"
#include "railcast/scene.h"

namespace railcast {

/// A part of a world as plain triangles, in the frame of one of its chunks.
struct ExportedWorld {
  Transform world_from_export = Transform::Identity();
  std::vector<Part> parts;  ///< One for each pair of label and material, in rising order.
};

/// Returns, for each of the world's objects, the chunk of the line that contains its chainage at
/// that time, or the first or last chunk if it is beyond the line's ends.
[[nodiscard]] std::vector<int> ChunksOfObjects(const RailWorld& world, std::int64_t time_ns);

/// Gathers the content of `chunks` and those objects that belong to one of them and exist at that
/// time, in the frame of the first chunk.
/// @pre `chunks` is not empty.
/// @param object_chunks One for each of the world's objects.
/// @param on_progress Called with the number of chunks gathered so far, and with their triangles.
[[nodiscard]] ExportedWorld ExportWorld(
    const World& world,
    const std::vector<int>& chunks,
    const std::vector<int>& object_chunks,
    std::int64_t time_ns,
    const std::function<void(std::size_t, const MeshSize&)>& on_progress = [](std::size_t,
                                                                              const MeshSize&) {});

/// Encodes binary little-endian PLY: float vertices, and faces with label, material and the label's
/// colour. A comment holds world_from_export by rows.
[[nodiscard]] std::string EncodePlyMesh(const ExportedWorld& exported, const LabelTable& labels);

/// Encodes binary glTF 2.0 with a node for each part, called as its label, and the label's colour
/// on all its vertices (linear, as glTF has them; PLY has the same in sRGB). Materials have their
/// names in the library. A node above turns z up to y up. world_from_export stands by rows in the
/// asset's extras.
/// @throws InputError if it would have 4 GiB or more, which the format cannot count.
[[nodiscard]] std::string EncodeGlbMesh(const ExportedWorld& exported,
                                        const LabelTable& labels,
                                        const MaterialLibrary& materials);

/// Encodes OBJ with an object for each label and `usemtl` for each material.
[[nodiscard]] std::string EncodeObjMesh(const ExportedWorld& exported,
                                        const LabelTable& labels,
                                        const MaterialLibrary& materials);

}  // namespace railcast
