#pragma once

#include <vector>

#include "core/rail/catenary/catenary_plan.h"
#include "core/rail/chunk_context.h"
#include "core/rail/infrastructure_models.h"
#include "core/scene/world.h"

namespace railcast {

/// Every conductor of the chunk (physics.md 7.2), cut half the overlap beyond its ends:
/// - contact wire, 12 mm: from support to support straight in plan, at contact height above the
///   track with a sag of span / 1000;
/// - messenger, 9 mm: a parabola w x (L - x) / 2T from support to support, upright above the
/// contact
///   wire;
/// - droppers, 4.5 mm: evenly spaced, at most CatenarySpec's distance apart and half of it from a
///   support; each belongs to the chunk it stands in.
/// Chords are at most 2 mm from the true lines; their corners depend on the span alone, so that the
/// same wire runs through neighbouring chunks.
[[nodiscard]] std::vector<Wire> WiresInChunk(const ChunkContext& context, const CatenaryPlan& plan);

/// Adds masts and cantilevers, as placements whose instance is kFirstMastInstance plus the mast's
/// number along the whole line, and the wires as tubes. Tubes have 16 sides (droppers 8), corners
/// as far outside of the true surface as the faces' middles are inside it: 0.06 mm for the contact
/// wire, 0.04 mm for the messenger, 0.09 mm for droppers.
void AddCatenary(const ChunkContext& context,
                 const CatenaryPlan& plan,
                 const InfrastructureModels& models,
                 Chunk& chunk);

inline constexpr std::uint32_t kFirstMastInstance = 1000;

}  // namespace railcast
