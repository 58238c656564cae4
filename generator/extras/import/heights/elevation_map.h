#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "generator/extras/import/map/map_projection.h"

namespace railcast {

/// A digital elevation model about the lines of a map: heights by the map's metres.
class ElevationMap {
 public:
  /// Reads the part that covers some bounds, with GDAL: GeoTIFF, ESRI ASCII grid and its other
  /// rasters, in any coordinate system.
  /// @param crs The coordinate system of a file that names none; empty: none.
  /// @param bounds_m Of the map's places, as `projection` made them.
  /// @throws InputError if GDAL cannot read the file to its end, if it is no raster of one height
  ///   in metres for each cell, or if its coordinate system is not known.
  ElevationMap(const std::filesystem::path& file,
               const std::string& crs,
               const MapProjection& projection,
               const Eigen::AlignedBox2d& bounds_m);
  ~ElevationMap();

  /// The file's name, for messages.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Heights at places, linear between the middles of the four cells about each; absent where one
  /// of these has none.
  [[nodiscard]] std::vector<std::optional<double>> HeightsAt(
      const std::vector<Eigen::Vector2d>& places_m) const;
  /// Whether a place lies between the middles of the outermost cells.
  [[nodiscard]] bool Covers(const Eigen::Vector2d& place_m) const;
  /// The longer side of a cell in the map's metres, in the middle of the bounds.
  [[nodiscard]] double cell_m() const { return cell_m_; }
  /// How many of the cells that were read have a height that cannot be (IsHeight) and that the file
  /// does not say to stand for none, such as -32768; and the first of these. They have none.
  [[nodiscard]] std::size_t num_void() const;
  [[nodiscard]] double first_void_m() const;

 private:
  struct Raster;
  std::string name_;
  std::unique_ptr<const Raster> raster_;
  double cell_m_{};
};

/// The heights within some bounds as an ESRI ASCII grid in the map's metres, which is what
/// `terrain.elevation` of a world reads. Cells are as large as those of the source, and larger
/// where they would be more than a million.
[[nodiscard]] std::string ElevationGridText(const ElevationMap& elevation,
                                            const Eigen::AlignedBox2d& bounds_m);

}  // namespace railcast
