#pragma once

#include <string>
#include <vector>

#include "core/rail/chunk_context.h"
#include "core/rail/structures/cleared.h"
#include "core/rail/world_check.h"
#include "railcast/scene.h"
#include "railcast/structures.h"

namespace railcast {

// Every type of structure has three functions of these names, found by its spec:
//
// - AddStructure() adds the part that lies in a chunk;
// - ClearedBy() returns the areas that it clears;
// - CheckShape() reports what its description (core/scenario/describe_structures.h) cannot check.
//   Its name, its track and its chainages are checked for all types alike.

/// Where the faults of a structure belong.
struct StructurePlace {
  const WorldSpec& world;
  std::string pointer;  ///< "/world/structures/3".
};

void AddStructure(const ChunkContext& context, const PlatformSpec& platform, Chunk& chunk);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const PlatformSpec& platform);
void CheckShape(const StructurePlace& place, const PlatformSpec& platform, WorldFaults& faults);

}  // namespace railcast
