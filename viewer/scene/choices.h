#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "viewer/color/color_map.h"

namespace railcast {

/// What is drawn over the points.
struct OverlayChoices {
  bool mesh = false;
  bool boxes = false;
  bool track = false;
  bool gauge = false;
  bool frustum = false;
  bool axes = false;
  bool rings = false;
};

/// How two recordings are shown together.
enum class Layout : std::uint8_t {
  kBeside,   ///< Side by side, one camera.
  kDistance  ///< In one view, coloured by the distance to the nearest point of the other.
};

/// More than this is too much to draw and to keep.
inline constexpr std::size_t kMaxAccumulated = 128;

/// How the user wants to see frames.
struct Choices {
  std::string color_by{};         ///< Empty: the first frame's default.
  std::optional<ColorMap> map{};  ///< Empty: coolwarm for differences, viridis for amounts.
  std::optional<std::array<double, 2>> ends{};  ///< Of the scale; empty: fitted to the frame.
  std::optional<std::array<double, 2>> distance_ends_m{};  ///< Likewise, of Layout::kDistance.
  std::size_t num_accumulated = 1;  ///< Frames shown at once, in world coordinates.
  bool empty_beams = false;         ///< The fan of firings that brought nothing back.
  OverlayChoices overlays{};
  std::set<std::uint32_t> labels{};  ///< Others are faint; empty: all are shown alike.
  Layout layout = Layout::kBeside;
};

}  // namespace railcast
