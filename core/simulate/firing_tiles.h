#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/detect/base/detect_tile.h"
#include "core/detect/base/echo_tiles.h"
#include "core/simulate/frame_poses.h"
#include "railcast/frame.h"
#include "railcast/lidar.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// A scan pattern, that of one frame, in tracing order: packets of 16 firings, grouped into tiles.
class FiringTiles {
 public:
  explicit FiringTiles(const ScanPattern& pattern);
  /// Some firings of a pattern, whose other cells need not have any.
  /// @param order Indices of the firings in tracing order, each once.
  FiringTiles(const ScanPattern& pattern, std::vector<std::uint32_t> order);
  /// The firings of some cells (row * columns + column) for a frame that holds these alone, in the
  /// order of the cells.
  /// @param cells By rising number; not empty.
  [[nodiscard]] static FiringTiles OfCells(const ScanPattern& pattern,
                                           std::span<const std::uint32_t> cells);

  [[nodiscard]] std::size_t num_tiles() const {
    return (firing_.size() + kTileSize - 1) / kTileSize;
  }
  [[nodiscard]] std::uint32_t duration_ns() const { return duration_ns_; }

  /// Fills origins, directions, shutter, range_m (= range_max_m) and surface (= nothing).
  void Aim(std::size_t tile, const FramePoses& poses, float range_max_m, RayTile& rays) const;

  /// Stores sensor-frame direction, firing index and channel of a tile's lanes in `detect`.
  void Describe(std::size_t tile, DetectTile& detect) const;
  /// Moves a tile's points, which lie along their beams from the sensor's origin, by the places
  /// where the beams leave. The points are in the sensor's axes.
  void MoveToOrigins(std::size_t tile, EchoTiles& echoes) const;
  /// The slots of the lanes in a frame with one return per firing.
  [[nodiscard]] const std::uint32_t* slots(std::size_t tile) const {
    return &slot_[tile * kTileSize];
  }
  [[nodiscard]] const std::uint32_t* times_ns(std::size_t tile) const {
    return &time_ns_[tile * kTileSize];
  }

  /// Number of lanes that hold firings; the others pad the last packet.
  [[nodiscard]] std::size_t num_firings(std::size_t tile) const;

  /// Stores the fields that are the same in every frame: times, rings, columns and returns.
  void StoreConstants(Frame& frame) const;

  /// Tile and lane in which a firing is traced.
  struct Place {
    std::size_t tile{};
    std::size_t lane{};
  };
  [[nodiscard]] Place PlaceOf(std::uint32_t firing) const;

 private:
  /// Appends a firing to those that are traced.
  void Append(const ScanPattern& pattern, std::uint32_t firing);

  std::size_t num_firings_;
  std::uint32_t duration_ns_{};
  // In tracing order.
  std::vector<std::uint32_t> firing_, slot_, time_ns_, channel_;
  std::vector<float> x_, y_, z_;
  std::vector<float> origin_x_m_, origin_y_m_, origin_z_m_;  // Empty as ScanPattern's.
  // In slot order; empty where not all firings are there.
  std::vector<std::uint32_t> slot_time_ns_, slot_column_;
  std::vector<std::uint16_t> slot_row_;
};

}  // namespace railcast
