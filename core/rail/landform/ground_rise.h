#pragma once

#include "core/rail/base/noise_field.h"
#include "core/rail/chunk/chunk_context.h"
#include "core/rail/clearance/cleared.h"
#include "core/rail/landform/landform.h"
#include "core/rail/landform/retained_ground.h"
#include "core/rail/landform/tunnel_hills.h"
#include "core/rail/track/cross_section.h"

namespace railcast {

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
/// As above, with the cross-section at `s_m`.
[[nodiscard]] Vector3 GroundPoint(const ChunkContext& context,
                                  const CrossSection& section,
                                  double s_m,
                                  double d_m);

}  // namespace railcast
