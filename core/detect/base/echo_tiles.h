#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/detect/base/detect_tile.h"

namespace railcast {

/// The echoes of one tile of firings. Lane i of `first` is the first echo of firing i, or has the
/// outcome that explains why there is none. Further echoes are in `more`, in the order in which
/// they were added.
class EchoTiles {
 public:
  // Numbers of echoes within a firing, part of their random keys. Echoes of surfaces count from 0.
  static constexpr std::uint32_t kGhost = 91;
  static constexpr std::uint32_t kMirrorImage = 92;
  // kFirstFogEcho is 93, and so is 94.
  static constexpr std::uint32_t kSprayCloud = 95;
  static constexpr std::uint32_t kHalo = 96;
  static constexpr std::uint32_t kForeignPulse = 97;
  static constexpr std::uint32_t kFalseAlarm = 98;
  static constexpr std::uint32_t kFirstDrop = 100;
  static constexpr std::uint32_t kFirstFlake = 200;

  DetectTile first;
  float mixed_share[kTileSize];  ///< Frame::mixed_share of each firing.

  /// The position of an echo: its tile and its lane there.
  struct Place {
    DetectTile& tile;
    std::size_t lane;
  };

  void ClearMore() { num_more_ = 0; }
  /// Adds an echo to the firing in lane `beam` of `first` and copies that firing's frame, index,
  /// channel, direction and cover. The caller must set everything else.
  Place Add(std::size_t beam, std::uint32_t echo) {
    const std::size_t tile_index = num_more_ / kTileSize;
    const std::size_t lane = num_more_ % kTileSize;
    if (tile_index == more_.size()) more_.push_back(std::make_unique<DetectTile>());
    if (num_more_ == beam_.size()) beam_.resize(beam_.size() + kTileSize);
    DetectTile& tile = *more_[tile_index];
    tile.num_rays = lane + 1;
    tile.frame = first.frame;
    tile.firing[lane] = first.firing[beam];
    tile.echo[lane] = echo;
    tile.channel[lane] = first.channel[beam];
    tile.direction_x[lane] = first.direction_x[beam];
    tile.direction_y[lane] = first.direction_y[beam];
    tile.direction_z[lane] = first.direction_z[beam];
    tile.cover[lane] = first.cover[beam];
    beam_[num_more_++] = static_cast<std::uint32_t>(beam);
    return {tile, lane};
  }

  [[nodiscard]] std::size_t num_more() const { return num_more_; }
  /// @pre i < num_more()
  [[nodiscard]] Place more(std::size_t i) { return {*more_[i / kTileSize], i % kTileSize}; }
  [[nodiscard]] std::size_t beam_of(std::size_t i) const { return beam_[i]; }

  /// Calls `apply(DetectTile&)` on every tile that has lanes in use.
  template <typename Apply>
  void ForEachTile(const Apply& apply) {
    apply(first);
    for (std::size_t begin = 0; begin < num_more_; begin += kTileSize) {
      apply(*more_[begin / kTileSize]);
    }
  }

 private:
  std::vector<std::unique_ptr<DetectTile>> more_;  // Reused from one tile of firings to the next.
  std::vector<std::uint32_t> beam_;
  std::size_t num_more_{};
};

}  // namespace railcast
