#pragma once

#include <memory>
#include <vector>

#include "core/rail/catenary/catenary_plan.h"
#include "core/rail/chunk/chunk_context.h"
#include "railcast/scene.h"

namespace railcast {

/// Makes all conductors of the chunk (docs/physics.md 7.2). They extend half the overlap beyond its
/// ends.
/// - Contact wire, 12 mm: straight in plan from support to support, at contact height above the
///   track with a sag of span / 1000.
/// - Messenger wire, 9 mm: a parabola w x (L - x) / 2T from support to support, vertically above
///   the contact wire.
/// - Droppers, 4.5 mm: evenly spaced, at most CatenarySpec's distance apart and half of it from a
///   support. Each belongs to the chunk it stands in.
///
/// Chords deviate from the true lines by at most 2 mm. Their corners depend on the span alone, so
/// that the same wire continues through neighbouring chunks.
[[nodiscard]] std::vector<Wire> WiresInChunk(const ChunkContext& context, const CatenaryPlan& plan);

/// Adds masts and cantilevers, as placements whose instance is kFirstMastInstance plus the mast's
/// number along the whole line, and the wires as tubes. Tubes have 16 sides (droppers 8). Their
/// corners lie as far outside the true surface as the middles of their faces lie inside: 0.06 mm
/// for the contact wire, 0.04 mm for the messenger wire, 0.09 mm for droppers.
/// @param mast_model MakeMast().
void AddCatenary(const ChunkContext& context,
                 const CatenaryPlan& plan,
                 const std::shared_ptr<const Model>& mast_model,
                 Chunk& chunk);

inline constexpr std::uint32_t kFirstMastInstance = 20'000;

}  // namespace railcast
