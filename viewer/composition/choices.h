#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "viewer/color/palette.h"
#include "viewer/frames/camera_picture.h"

namespace railcast {

/// Which overlays are drawn over the points.
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
  kBeside,   ///< Side by side, sharing one camera.
  kDistance  ///< In one view, coloured by the distance to the nearest point of the other.
};

/// Limits the time to draw and the memory that accumulated frames take.
inline constexpr std::size_t kMaxAccumulated = 128;

/// How the user wants to see frames.
struct Choices {
  std::string color_by{};                       ///< Empty: the default field of the first frame.
  std::optional<ColorMap> map{};                ///< Empty: coolwarm for differences, else viridis.
  std::optional<std::array<double, 2>> ends{};  ///< Ends of the scale; empty: fitted to the frame.
  /// Ends of the scale for Layout::kDistance.
  std::optional<std::array<double, 2>> distance_ends_m{};
  std::size_t num_accumulated = 1;  ///< Frames shown at once, in world coordinates.
  /// The camera's image; empty: colours where there are images.
  std::optional<PictureKind> picture{};
  bool empty_beams = false;  ///< The fan of firings without a return.
  OverlayChoices overlays{};
  std::set<std::uint32_t> labels{};  ///< Points of other labels are faint; empty: none are.
  Layout layout = Layout::kBeside;
};

}  // namespace railcast
