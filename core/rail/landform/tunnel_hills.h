#pragma once

#include <vector>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/clearance/tunnel_shape.h"
#include "core/rail/landform/retained_ground.h"
#include "core/rail/track/cross_section.h"

namespace railcast {

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
    kBeside,  ///< Of no concern, or the hill beside a tunnel.
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

}  // namespace railcast
