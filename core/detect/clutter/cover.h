#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/detect/base/detect_tile.h"
#include "railcast/effects.h"
#include "railcast/lidar.h"

namespace railcast {

/// Opaque discs of one size at random places of a spherical window. Lengths are given as a
/// share of the window's radius, as chords.
class SpotLayer {
 public:
  using Center = std::array<float, 3>;

  SpotLayer() = default;
  /// @param centers Unit vectors.
  SpotLayer(const std::vector<Center>& centers, double spot_chord, double aperture_chord);

  /// The share of the aperture around a direction that no spot covers. Spots cover independent
  /// parts: two that cover a half each leave a quarter.
  [[nodiscard]] float FreeShare(const Center& direction) const;

 private:
  [[nodiscard]] int CellAt(float coordinate) const;
  /// The first cell of a row.
  [[nodiscard]] std::size_t RowAt(int z, int y) const;

  float spot_chord_{};
  float aperture_chord_{};
  int num_cells_{};                   // Along each axis of the cube around the sphere.
  std::vector<Center> centers_;       // Sorted by cell, x fastest.
  std::vector<std::uint32_t> begin_;  // First centre of each cell, then the number of centres.
};

/// The share of a disc's area that another disc covers.
/// @param apart Distance between their centres, in the unit of the radii `disc` and `cover`.
[[nodiscard]] float CoveredShare(float apart, float disc, float cover);

/// Number of spots on the whole sphere of the window with which they cover the given share of it.
[[nodiscard]] std::uint32_t NumSpots(const CoverSpec& cover, double coverage, double diameter_mm);

/// Effect `cover`: drops, dirt and snow on the window in front of the sensor.
///
/// Model: spots are opaque discs of one diameter d per kind, independent and uniformly distributed
/// over the window; their number gives the coverage c, the share of the window that they cover. A
/// beam passes the window as a disc of the aperture's diameter D, on its way out and back. Of its
/// power remains
///
///   T = f^2,  f = product over the spots of (1 - covered share of the aperture)
///
/// so that the mean of f is 1 - c for any size of spots. A share (1 - c)^((1 + D / d)^2) of the
/// beams is untouched; spots smaller than the aperture weaken all beams, larger ones block some.
///
/// Drops are opaque, too: a drop is a lens of a focal length of some millimetres that spreads the
/// light over tens of degrees, so that next to nothing remains in a beam of milliradians. A drop
/// stays for `drop_lifetime_s` and is then replaced by one elsewhere; the lives of the drops begin
/// at random times. Within a frame they stay. Dirt and snow do not change.
///
/// Validity: light that spots throw back into the receiver is neglected; its range is the
/// window's radius, which is below the least range of every sensor that we know. Coverage is the
/// same in all directions, and background light is not weakened.
class Cover {
 public:
  /// The drops of one frame: working memory of a thread.
  struct Drops {
    bool is_known = false;
    std::uint32_t frame{};
    SpotLayer layer;
  };

  Cover(const DetectorSpec& spec, const ScanPattern& pattern);

  /// Fills `cover` of a tile whose firings and directions are known.
  void Fill(DetectTile& tile, Drops& drops) const;

  /// The drops at a time, in seconds of the simulation.
  [[nodiscard]] SpotLayer DropsAt(double time_s) const;

 private:
  /// The share of the aperture around a direction that dirt and snow leave.
  [[nodiscard]] float LastingShare(const SpotLayer::Center& direction) const {
    return dirt_.FreeShare(direction) * snow_.FreeShare(direction);
  }

  CoverSpec spec_;
  std::uint64_t seed_;
  double rate_hz_;
  std::vector<float> drop_phase_;  // Offset of each drop's life in lifetimes, 0 to 1.
  SpotLayer dirt_;
  SpotLayer snow_;
  // Share of the aperture that dirt and snow leave, by firing; empty if firings move.
  std::vector<float> lasting_;
};

/// Whether anything lies on the window.
[[nodiscard]] bool HasCover(const DetectorSpec& spec);

/// The expected share of beams that no spot touches.
[[nodiscard]] double UntouchedShare(const CoverSpec& cover);

}  // namespace railcast
