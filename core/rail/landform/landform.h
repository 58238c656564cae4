#pragma once

#include <cstdint>
#include <optional>

#include "core/rail/base/noise_field.h"
#include "core/rail/landform/elevation.h"
#include "core/rail/landform/strip_width.h"
#include "railcast/world_spec.h"

namespace railcast {

/// The hills of ReliefSpec: heights that depend on the place in plan and the seed alone, so that
/// they are continuous everywhere. Two noises: one on a lattice of the spec's wavelength with 0.9
/// of the variance, and one on a lattice of a third of it.
class Hills {
 public:
  Hills(const ReliefSpec& spec, std::uint64_t seed);
  /// Height at a place in the world; mean 0.
  [[nodiscard]] double Height_m(const Eigen::Vector2d& place_m) const;

 private:
  ReliefSpec spec_;
  NoiseField long_wave_;
  NoiseField short_wave_;
};

/// The shape of the land about the line: how high the terrain is that the line was built through,
/// and how far the ground reaches. Immutable and thread-safe.
class Landform {
 public:
  /// @param elevation Of the spec, if it has any.
  Landform(const TerrainSpec& spec,
           StripWidth width,
           std::optional<DemHeights> elevation,
           std::uint64_t seed);

  /// Whether the terrain is anywhere but at the height of the formation.
  [[nodiscard]] bool has_terrain() const { return hills_ || elevation_; }
  /// Whether the ground is made for sight over long distances: with larger cells far from the
  /// track.
  [[nodiscard]] bool is_wide() const { return has_terrain() || width_.narrows(); }
  /// Height of the terrain above a place of the formation in the world. @pre has_terrain()
  [[nodiscard]] double Rise_m(const Vector3& formation_m) const;
  [[nodiscard]] const StripWidth& width() const { return width_; }

 private:
  StripWidth width_;
  std::optional<DemHeights> elevation_;
  std::optional<Hills> hills_;
};

}  // namespace railcast
