#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "viewer/draw/stage.h"
#include "viewer/frames/shown_frame.h"
#include "viewer/session/session.h"

namespace railcast {

/// A point on the screen.
struct ScreenPoint {
  std::size_t source{};  ///< Of the session.
  std::shared_ptr<const ShownFrame> shown;
  std::size_t point{};
};

/// The point that a click means, of whichever cloud.
/// @param place_px In the window, from its lower left corner.
[[nodiscard]] std::optional<ScreenPoint> PointUnder(Stage& stage,
                                                    const Session& session,
                                                    const std::array<int, 2>& place_px);

}  // namespace railcast
