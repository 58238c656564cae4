#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/rail/chunk_context.h"
#include "railcast/rail_world.h"
#include "railcast/structures.h"

namespace railcast {

/// What a structure may clear from the ground on which it stands.
enum class Clearing : std::uint8_t {
  kGrass,    ///< A patch of grass, by its middle.
  kTree,     ///< A tree or bush, by its foot.
  kMast,     ///< A mast of the contact line, by its middle.
  kBallast,  ///< Ballast and sleepers.
  kGround,   ///< The ground itself.
};

/// An area beside a track from which a structure clears some things: chainages, and distances left
/// of the track's axis.
struct ClearedArea {
  double begin_s_m{};
  double end_s_m{};
  double right_m{};
  double left_m{};
  std::vector<Clearing> cleared;
};

/// The areas that a structure clears. Trees and grass keep a distance from its outline, which these
/// areas include.
[[nodiscard]] std::vector<ClearedArea> ClearedAreasOf(const StructureSpec& structure);

/// The area of a structure with this outline, without trees (crowns of some 2 m), grass (patches of
/// 2 m) and masts.
[[nodiscard]] std::vector<ClearedArea> ClearedAround(const ClearedArea& outline);

/// Whether the structures of a world clear something at (s, d), d being left of the alignment.
[[nodiscard]] bool IsCleared(const WorldSpec& world, double s_m, double d_m, Clearing what);
[[nodiscard]] inline bool IsCleared(const ChunkContext& context,
                                    double s_m,
                                    double d_m,
                                    Clearing what) {
  return IsCleared(context.spec, s_m, d_m, what);
}

}  // namespace railcast
