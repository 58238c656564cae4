#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/rail/base/noise_field.h"
#include "core/rail/line/track_course.h"
#include "railcast/alignment.h"
#include "railcast/scene.h"
#include "railcast/world_spec.h"

namespace railcast {

/// How far the ground reaches to either side of the axis, as a function of chainage.
///
/// As far as the spec says, everywhere, if that is less than the line's tightest radius. Otherwise
/// cross-sections would meet inside tight curves, and between parts of the line that run close to
/// each other. There the ground reaches at most
///
/// - kShareOfRadius of the distance to the centre of the circle that touches the axis at the
///   cross-section and meets the axis again, at the nearest such place: in a curve the radius of
///   curvature, between two parallel parts of the line half of their distance;
/// - kNarrowing more per metre of chainage, so that the edge of the ground is smooth.
///
/// Immutable and thread-safe. Takes 16 bytes for every kStep_m of a line whose ground narrows.
class StripWidth {
 public:
  static constexpr double kShareOfRadius = 0.8;
  static constexpr double kNarrowing = 0.5;
  static constexpr double kStep_m = 5.0;

  StripWidth(const Alignment& alignment, double half_width_m);

  /// Whether the ground is narrower anywhere than the spec says.
  [[nodiscard]] bool narrows() const { return !left_m_.empty(); }
  /// Distance from the axis to the edge of the ground. @param side > 0 for the left.
  [[nodiscard]] double At(double s_m, double side) const;
  /// From a place to the nearer edge of the ground. @param d_m Left of the axis.
  [[nodiscard]] double RoomAt_m(double s_m, double d_m) const {
    return std::min(At(s_m, 1.0) - d_m, At(s_m, -1.0) + d_m);
  }
  /// The least of At().
  [[nodiscard]] double least_m() const { return least_m_; }

 private:
  double half_width_m_;
  double least_m_;
  std::vector<double> left_m_;  ///< At multiples of kStep_m.
  std::vector<double> right_m_;
};

/// Heights on a grid, read from an ESRI ASCII grid (.asc) in metres, in the file's coordinates.
///
/// The header has `ncols`, `nrows`, `xllcorner` or `xllcenter`, `yllcorner` or `yllcenter`, and
/// `cellsize` or, as GDAL writes cells that are no squares, `dx` and `dy`; `NODATA_value` may be
/// missing (-9999). Heights follow row by row from the north, of the middles of the cells.
///
/// Between them, heights are interpolated by cubic convolution (Keys 1981, "Cubic convolution
/// interpolation for digital image processing", a = -1/2), which has a continuous slope and is
/// exact for quadratic surfaces: of hills 400 m long and 20 m high, cells of 30 m keep the height
/// within 0.025 m and the slope within 0.006, where bilinear interpolation errs by 0.54 m and 0.036
/// and shows every cell as a facet (measured by the tests). Cells without data are filled from
/// their neighbours, so that heights are finite everywhere; Covers() tells where they are real.
///
/// Immutable and thread-safe.
class ElevationGrid {
 public:
  /// @throws InputError "dem.asc:7: rule (got value)" if the file is no such grid, or one in
  /// degrees.
  explicit ElevationGrid(const std::filesystem::path& file);
  /// The overload for a file's text.
  /// @param shown Name of the file in messages.
  ElevationGrid(std::string_view text, const std::string& shown);

  /// Height at a place; beyond the grid that of its edge.
  [[nodiscard]] double Height_m(double x_m, double y_m) const;
  /// Whether the place lies in one of the grid's cells, and the cells about it have data.
  [[nodiscard]] bool Covers(double x_m, double y_m) const;
  /// The lesser side of a cell.
  [[nodiscard]] double cell_m() const;

 private:
  /// A place between the middles of four cells: the lower left one, and how far towards the others.
  struct Place {
    std::ptrdiff_t column{};
    std::ptrdiff_t row{};  ///< From the south.
    double along{};        ///< From 0 to 1; within half a cell of the grid's edges, beyond.
    double across{};
  };

  [[nodiscard]] Place PlaceOf(double x_m, double y_m) const;
  /// Height of a cell's middle; of the cells next to the grid's edges, linearly continued.
  [[nodiscard]] double At(std::ptrdiff_t column, std::ptrdiff_t row) const;
  void FillMissing();

  std::size_t num_columns_{};
  std::size_t num_rows_{};
  double west_m_{};   ///< Middle of the first column.
  double south_m_{};  ///< Middle of the last row.
  double dx_m_{};
  double dy_m_{};
  std::vector<double> heights_m_;  ///< Row by row from the south.
  std::vector<bool> has_data_;
};

/// Half width of the formation beside a track's axis: the ground is level up to there. Masts stand
/// on it (their foundations reach 4.2 m).
inline constexpr double kFormationEdge_m = 4.5;

/// Rise per metre of the slopes of cuttings and embankments: 1:1.5, the usual slope of both in
/// cohesive and sandy soils (Ril 836; steeper ones need a proof of stability).
inline constexpr double kCutAndFillSlope = 1.0 / 1.5;

/// Height of the ground above the formation at `beyond_m` outside its edge: the terrain, or where
/// that is higher or lower, the slope of the cutting or the embankment.
/// @param rise_m Height of the terrain above the formation.
[[nodiscard]] inline double CutAndFill_m(double rise_m, double beyond_m) {
  const double slope_m = kCutAndFillSlope * std::max(0.0, beyond_m);
  return std::clamp(rise_m, -slope_m, slope_m);
}

/// Ditches of cuttings, between the formation and the slope: trapezes with sides of 1:1.5.
inline constexpr double kDitchDepth_m = 0.4;
inline constexpr double kDitchBottom_m = 0.4;
inline constexpr double kDitchWidth_m = kDitchBottom_m + 2.0 * kDitchDepth_m / kCutAndFillSlope;

/// As CutAndFill_m(), with a ditch where the terrain is higher than the formation. It is no deeper
/// than the cutting, so that it fades out where an embankment begins.
[[nodiscard]] inline double CutWithDitchAndFill_m(double rise_m, double beyond_m) {
  if (rise_m <= 0.0) return CutAndFill_m(rise_m, beyond_m);
  const double down_m = -kCutAndFillSlope * std::max(0.0, beyond_m);
  const double up_m = kCutAndFillSlope * (beyond_m - kDitchWidth_m);
  const double ditch_m = std::max({down_m, -kDitchDepth_m, up_m});
  return std::min(rise_m, std::max(ditch_m, -rise_m));
}

/// Heights of ElevationSpec in the world. Cheap to copy, immutable, thread-safe.
class DemHeights {
 public:
  /// @throws InputError as ElevationGrid does.
  explicit DemHeights(const ElevationSpec& spec);

  [[nodiscard]] double Height_m(const Eigen::Vector2d& place_m) const;
  [[nodiscard]] bool Covers(const Eigen::Vector2d& place_m) const;
  [[nodiscard]] double cell_m() const { return grid_->cell_m(); }

 private:
  std::shared_ptr<const ElevationGrid> grid_;
  std::array<double, 3> origin_m_;
};

/// What is wrong, if the file does not cover the ground of the whole line, "must cover the ground
/// of the whole line: ends at chainage 1240 m". Ground is examined at places as far apart as its
/// cells and at least 5 m; gaps between them are filled (ElevationGrid).
[[nodiscard]] std::optional<std::string> CoverageFault(const DemHeights& elevation,
                                                       const Alignment& alignment,
                                                       const StripWidth& width);

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

/// What permits the coarser forms of the chunk between two chainages.
[[nodiscard]] std::vector<CoarserSurfaces> CoarserSurfacesBetween(
    const ChainageRange& range,
    const Alignment& alignment,
    const StripWidth& width,
    const Transform& chunk_from_world);

}  // namespace railcast
