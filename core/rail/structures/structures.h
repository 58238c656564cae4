#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/rail/base/world_faults.h"
#include "core/rail/chunk/chunk_context.h"
#include "core/rail/clearance/cleared.h"
#include "core/rail/network/world_tracks.h"
#include "railcast/lineside.h"
#include "railcast/scene.h"
#include "railcast/structures.h"
#include "railcast/transform.h"

namespace railcast {

// Every type of structure has three functions of these names, found by its spec:
//
// - AddStructure() adds the part that lies in a chunk;
// - ClearedBy() (clearance/cleared.h) returns the areas that it clears;
// - CheckShape() reports what its description (core/scenario/describe_structures.cpp) cannot check.
//   Its name, its track and its chainages are checked for all types alike, so most have none.

/// Where the faults of a structure belong.
struct StructurePlace {
  const WorldSpec& world;
  std::string pointer;  ///< "/world/structures/3".
};

/// Whether structures of a type are part of a track, so that they belong into its gauge.
template <class Structure>
inline constexpr bool kBelongsIntoGauge = false;
template <>
inline constexpr bool kBelongsIntoGauge<ThirdRailSpec> = true;
template <>
inline constexpr bool kBelongsIntoGauge<SlabTrackSpec> = true;
template <>
inline constexpr bool kBelongsIntoGauge<BaliseSpec> = true;
template <>
inline constexpr bool kBelongsIntoGauge<BufferStopSpec> = true;

template <class Structure>
void CheckShape(const StructurePlace&, const Structure&, WorldFaults&) {}

void AddStructure(const ChunkContext& context, const PlatformSpec& platform, Chunk& chunk);
void CheckShape(const StructurePlace& place, const PlatformSpec& platform, WorldFaults& faults);
/// How much farther from a track's axis than on the straight a platform's edge must be at a
/// chainage (CurveWidening_m). The curve is that of the 20 m about the place, so that an edge has
/// no steps where the curvature of a turnout does. @param side > 0 for the left.
[[nodiscard]] double PlatformWidening_m(const Alignment& alignment,
                                        const TrackCourse& track,
                                        double side,
                                        double s_m);
/// World height of the platform's top at (s, d), d being left of the alignment; nothing beside it.
[[nodiscard]] std::optional<double> PlatformTop_m(const ChunkContext& context,
                                                  const PlatformSpec& platform,
                                                  double s_m,
                                                  double d_m);

void AddStructure(const ChunkContext& context, const NoiseWallSpec& wall, Chunk& chunk);

void AddStructure(const ChunkContext& context, const FenceSpec& fence, Chunk& chunk);

void AddStructure(const ChunkContext& context, const RetainingWallSpec& wall, Chunk& chunk);

void AddStructure(const ChunkContext& context, const CableTroughSpec& trough, Chunk& chunk);

void AddStructure(const ChunkContext& context, const TunnelSpec& tunnel, Chunk& chunk);

void AddStructure(const ChunkContext& context, const BridgeSpec& bridge, Chunk& chunk);

void AddStructure(const ChunkContext& context, const OverbridgeSpec& bridge, Chunk& chunk);
void CheckShape(const StructurePlace& place, const OverbridgeSpec& bridge, WorldFaults& faults);

void AddStructure(const ChunkContext& context, const ThirdRailSpec& rail, Chunk& chunk);

void AddStructure(const ChunkContext& context, const SlabTrackSpec& slab, Chunk& chunk);

void AddStructure(const ChunkContext& context, const SignalSpec& signal, Chunk& chunk);

void AddStructure(const ChunkContext& context, const BoardSpec& board, Chunk& chunk);

void AddStructure(const ChunkContext& context, const BaliseSpec& balise, Chunk& chunk);

void AddStructure(const ChunkContext& context, const DerailerSpec& derailer, Chunk& chunk);

void AddStructure(const ChunkContext& context, const RelayBoxSpec& box, Chunk& chunk);

void AddStructure(const ChunkContext& context, const FurnitureSpec& furniture, Chunk& chunk);

void AddStructure(const ChunkContext& context, const LevelCrossingSpec& crossing, Chunk& chunk);

void AddStructure(const ChunkContext& context, const BufferStopSpec& stop, Chunk& chunk);

void AddStructure(const ChunkContext& context, const BuildingSpec& building, Chunk& chunk);
void CheckShape(const StructurePlace& place, const BuildingSpec& building, WorldFaults& faults);

/// How far the part of a structure that AddStructure() adds to a chunk may reach beyond the chunk's
/// ground.
[[nodiscard]] double OverhangOf_m(const StructureSpec& structure);

/// Adds those parts of the world's structures that lie in the chunk. Parts of the same surface
/// share one mesh of the chunk's ground.
void AddStructures(const ChunkContext& context, Chunk& chunk);

/// Checks that names are unique, that tracks exist, and that the structures lie on them and within
/// the ground. Faults are lines like `/world/structures/3/track: must be one of "main" (got "x")`.
void CheckStructures(const WorldSpec& world, const LineOfTracks& line, WorldFaults& faults);

/// The boom of a half barrier that moves while the scenario runs.
struct MovingBoom {
  std::string name;
  std::shared_ptr<const Model> model;  ///< Closed, about its axis (MakeBoom).
  Transform world_from_barrier;
  std::vector<TimedValue> angles_deg;  ///< Not empty, in rising time.

  [[nodiscard]] double Angle_rad(std::int64_t time_ns) const;
  [[nodiscard]] Transform WorldFromBoom(std::int64_t time_ns) const;
};

/// Name of the boom towards which one drives from the left (+1) or right (-1) side of the track.
[[nodiscard]] std::string BoomName(const std::string& crossing, double side);

/// The booms of a crossing, first that on the right of the track; none if they do not move.
/// @param context Of the chunk that holds the crossing.
[[nodiscard]] std::vector<MovingBoom> MovingBoomsOf(const ChunkContext& context,
                                                    const LevelCrossingSpec& crossing);

}  // namespace railcast
