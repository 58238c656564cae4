#pragma once

#include <functional>
#include <vector>

#include "core/rail/base/noise_field.h"
#include "core/rail/chunk/chunk_context.h"
#include "core/rail/clearance/cleared.h"
#include "core/rail/clearance/tunnel_shape.h"
#include "core/rail/landform/landform.h"
#include "core/rail/track/cross_section.h"
#include "railcast/structures.h"

namespace railcast {

/// The face of a retaining wall leans back by this share of its height; at its top, it is so thick.
inline constexpr double kRetainingBatter = 0.1;
inline constexpr double kRetainingThickness_m = 0.4;
/// Distance of the wall's back, which is upright, from its track's axis.
[[nodiscard]] inline double BackOf_m(const RetainingWallSpec& wall) {
  return wall.distance_m + kRetainingBatter * wall.height_m + kRetainingThickness_m;
}

/// Heights of the ground at a place, above the formation there.
struct GroundHeights {
  double terrain_m{};  ///< Height of the land as it was before the line was built.
  double built_m{};    ///< With cuttings and embankments, but without walls.
};

struct GroundPlace {
  double s_m{};
  double d_m{};  ///< Left of the alignment.
};

/// The ground behind the retaining walls along a stretch of the line. At the wall's back it is as
/// high as the top, and from there it rises or falls at 1:1.5 to the terrain. Towards the ends of
/// the wall, it passes at 1:1.5 to the ground without it; where one wall continues another, it does
/// not. Tracks behind a wall keep their formation. The world must outlive it.
class RetainedGround {
 public:
  /// Where the ground changes its height at one chainage, left of the alignment: the ground before
  /// the wall ends at `front_m` and that behind it at `back_m`, both inside the wall.
  struct Step {
    double front_m{};
    double back_m{};
  };

  RetainedGround(const ChunkContext& context, double begin_s_m, double end_s_m);

  [[nodiscard]] bool empty() const { return walls_.empty(); }
  [[nodiscard]] bool AnyIn(double from_s_m, double to_s_m) const;
  [[nodiscard]] std::size_t num_walls() const { return walls_.size(); }
  /// Height of the ground above the formation at (s, d), d being left of the alignment.
  /// @param is_in_tunnel Tells by its d which tracks have a hill above them instead of a formation.
  [[nodiscard]] double Height_m(const CrossSection& section,
                                const GroundPlace& place,
                                const GroundHeights& without,
                                const std::function<bool(double)>& is_in_tunnel) const;
  /// From 0 at the back of a wall to 1 a metre and more behind it, and wherever there is none.
  [[nodiscard]] double Roughness(double s_m, double d_m) const;
  /// Whether a wall stands all along a stretch.
  [[nodiscard]] bool Stands(std::size_t wall, double from_s_m, double to_s_m) const;
  [[nodiscard]] Step StepAt(std::size_t wall, double s_m) const;

 private:
  struct Wall {
    const RetainingWallSpec* spec;
    const TrackCourse* track;
    double back_m{};      ///< From the track's axis, left positive.
    bool goes_on_before;  ///< Another wall ends where it begins.
    bool goes_on_behind;
  };

  /// Distance behind the back of a wall; negative before the step.
  [[nodiscard]] static double Behind_m(const Wall& wall, double s_m, double d_m);

  const ChunkContext* context_;
  std::vector<Wall> walls_;  ///< Walls nearer to their tracks come first.
};

/// The ground above the tunnels of a world whose terrain has a shape: the terrain, where it is
/// higher than the lining. Where it is lower, the ground hides in the lining and falls from it at
/// 1:1.5. Behind a portal it rises at 1:1.5 from the portal's upper edge, and from the cutting
/// before it; what is between is held back by the portal and its wings.
///
/// The step from the ground before a portal to that behind it is inside the portal. Tracks outside
/// of tunnels keep their formation. The world must outlive it.
class TunnelHills {
 public:
  TunnelHills(const ChunkContext& context, double begin_s_m, double end_s_m);

  [[nodiscard]] bool empty() const { return tunnels_.empty(); }

  [[nodiscard]] bool AnyIn(double from_s_m, double to_s_m) const;

  /// What a place is to the tunnels.
  enum class Place {
    kBeside,  ///< Irrelevant, or the hill beside a tunnel.
    kMouth,   ///< Before a mouth, or in it: not to be joined with the ground above.
    kOver,    ///< Above a tunnel or in its lining.
  };
  [[nodiscard]] Place PlaceOf(double s_m, double d_m) const;
  /// Whether a place is inside a tunnel, from mouth to mouth.
  [[nodiscard]] bool IsInside(double s_m, double d_m) const;

  /// Height of the ground above the formation at (s, d), d being left of the alignment; above a
  /// tunnel, that of the hill.
  [[nodiscard]] double Height_m(const CrossSection& section,
                                double s_m,
                                double d_m,
                                const GroundHeights& without) const;

 private:
  struct Tunnel {
    const TunnelSpec* spec;
    const TrackCourse* track;
    TunnelShape shape;
    double begin_h_m{};  ///< Top of rail at its ends, in the chunk's frame.
    double end_h_m{};
    bool begin_goes_on{};  ///< Whether there is no mouth, since it goes on in another tunnel.
    bool end_goes_on{};
    double hill_begin_s_m{};  ///< Where the ground above it begins and ends.
    double hill_end_s_m{};
  };

  [[nodiscard]] static double Beside_m(const Tunnel& tunnel, double s_m, double d_m);
  [[nodiscard]] static bool HasHill(const Tunnel& tunnel, double s_m) {
    return s_m > tunnel.hill_begin_s_m && s_m < tunnel.hill_end_s_m;
  }
  /// Height above top of rail at a mouth up to which the ground may rise.
  [[nodiscard]] double Limit_m(const Tunnel& tunnel, double behind_m, double beside_m) const;

  const ChunkContext* context_;
  double ditch_m_;  ///< Width of the ditches between formation and slope.
  std::vector<Tunnel> tunnels_;
};

/// Which ground is meant where a tunnel runs through a hill.
enum class GroundLevel {
  kOfTrack,  ///< In the tunnel, its floor.
  kOfHill,   ///< Above the tunnel.
};

/// The height of the ground above the formation, about one chunk of the line. The chunk's context
/// must outlive it.
class GroundRise {
 public:
  explicit GroundRise(const ChunkContext& context);

  /// Height at (s, d), d being left of the alignment. @param section At `s_m`.
  [[nodiscard]] double Height_m(const CrossSection& section,
                                double s_m,
                                double d_m,
                                GroundLevel level = GroundLevel::kOfTrack) const;
  /// The point of the ground at (s, d), in the chunk's frame. @param section At `s_m`.
  [[nodiscard]] Vector3 PointAt(const CrossSection& section,
                                double s_m,
                                double d_m,
                                GroundLevel level = GroundLevel::kOfTrack) const;

  /// How much lower the ground is below and about bridges.
  [[nodiscard]] double Drop_m(double s_m, double d_m) const { return gaps_.Drop_m(s_m, d_m); }

  /// The retaining walls, at which the height has steps.
  [[nodiscard]] const RetainedGround& retained() const { return retained_; }
  [[nodiscard]] const TunnelHills& hills() const { return hills_; }

 private:
  [[nodiscard]] double Undulation_m(double distance_m, double s_m, double d_m) const;

  BridgeGaps gaps_;
  RetainedGround retained_;
  TunnelHills hills_;
  const TerrainSpec& spec_;
  const Landform* land_;  ///< Null: as high as the formation.
  Transform world_from_chunk_ = Transform::Identity();
  NoiseField roughness_;
  NoiseField long_wave_;
  NoiseField short_wave_;
};

/// The point of the ground at (s, d) in the chunk's frame: on the surface that AddTerrain samples
/// at its grid points.
[[nodiscard]] Vector3 GroundPoint(const ChunkContext& context, double s_m, double d_m);
/// The overload with the cross-section at `s_m`.
[[nodiscard]] Vector3 GroundPoint(const ChunkContext& context,
                                  const CrossSection& section,
                                  double s_m,
                                  double d_m);

}  // namespace railcast
