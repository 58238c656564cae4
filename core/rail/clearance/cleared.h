#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/network/world_tracks.h"
#include "railcast/structures.h"
#include "railcast/world_spec.h"

namespace railcast {

/// What a structure may clear from the ground on which it stands.
enum class Clearing : std::uint8_t {
  kGrass,    ///< A patch of grass, by its middle.
  kTree,     ///< A tree or bush, by its foot.
  kMast,     ///< A mast of the contact line, by its middle: it stands elsewhere if there is room.
  kSupport,  ///< A mast as well: it is left out, because the structure carries the contact line.
  kBallast,  ///< The ballast of the track whose axis is there.
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

// What each type of structure clears: defined beside what it is built of (core/rail/structures).
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const PlatformSpec& platform);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const NoiseWallSpec& wall);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const FenceSpec& fence);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const RetainingWallSpec& wall);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const CableTroughSpec& trough);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const WorldTracks& tracks,
                                                 const TunnelSpec& tunnel);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const WorldTracks& tracks,
                                                 const BridgeSpec& bridge);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const WorldTracks& tracks,
                                                 const OverbridgeSpec& bridge);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const ThirdRailSpec& rail);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const SlabTrackSpec& slab);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const SignalSpec& signal);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const BoardSpec& board);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const BaliseSpec& balise);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const DerailerSpec& derailer);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const RelayBoxSpec& box);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const FurnitureSpec& furniture);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const LevelCrossingSpec& crossing);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const BufferStopSpec& stop);
[[nodiscard]] std::vector<ClearedArea> ClearedBy(const BuildingSpec& building);

/// The areas that a structure clears. Trees and grass keep a distance from its outline, which these
/// areas include.
[[nodiscard]] std::vector<ClearedArea> ClearedAreasOf(const WorldTracks& tracks,
                                                      const StructureSpec& structure);

/// The areas of a structure with this outline, without trees (crowns of some 2 m), grass (patches
/// of 2 m) and masts.
[[nodiscard]] std::vector<ClearedArea> ClearedAround(const ClearedArea& outline);

/// The areas of a structure between two distances from its track's axis, as ClearedAround().
[[nodiscard]] std::vector<ClearedArea> ClearedBeside(const SideStretchSpec& structure,
                                                     double near_m,
                                                     double far_m);

/// All areas that the structures of a world clear of one thing between two chainages. The world
/// must outlive it.
class ClearedAreas {
 public:
  ClearedAreas(const WorldTracks& tracks, Clearing what, double begin_s_m, double end_s_m);

  /// Whether all areas at that chainage are known.
  [[nodiscard]] bool Know(double s_m) const { return s_m >= begin_s_m_ && s_m <= end_s_m_; }
  /// Whether (s, d) is cleared, d being left of the alignment. @pre Know(s_m)
  [[nodiscard]] bool Cover(double s_m, double d_m) const;

 private:
  struct TrackArea {
    const TrackCourse* track;
    ClearedArea area;
  };
  double begin_s_m_;
  double end_s_m_;
  std::vector<TrackArea> areas_;
};

/// Whether the structures of a world clear something at (s, d), d being left of the alignment. To
/// ask for many places, make ClearedAreas once.
[[nodiscard]] bool IsCleared(const WorldTracks& tracks, double s_m, double d_m, Clearing what);
[[nodiscard]] inline bool IsCleared(const ChunkContext& context,
                                    double s_m,
                                    double d_m,
                                    Clearing what) {
  return IsCleared(TracksOf(context), s_m, d_m, what);
}

/// The gaps over which the bridges carry the line between two chainages. The world must outlive it.
class BridgeGaps {
 public:
  BridgeGaps(const WorldTracks& tracks, double begin_s_m, double end_s_m);

  /// How much lower the ground is at (s, d), d being left of the alignment; 0 beside the gaps. A
  /// gap's banks, and the embankment's cones beside the abutments, have slopes of 1:1.5.
  [[nodiscard]] double Drop_m(double s_m, double d_m) const;

 private:
  struct Gap {
    const BridgeSpec* bridge;
    const TrackCourse* track;
    double right_m;  ///< Edges of the deck, left of the track's axis.
    double left_m;
  };
  std::vector<Gap> gaps_;
};

}  // namespace railcast
