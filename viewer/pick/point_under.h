#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "viewer/draw/stage.h"
#include "viewer/frames/shown_frame.h"
#include "viewer/session/session.h"

namespace railcast {

/// A point that was found on the screen.
struct ScreenPoint {
  std::size_t source{};  ///< Index of the source in the session.
  std::shared_ptr<const ShownFrame> shown;
  std::size_t point{};
};

/// Returns the point that a click means, of any cloud.
/// @param place_px In the window, from its lower left corner.
[[nodiscard]] std::optional<ScreenPoint> PointUnder(Stage& stage,
                                                    const Session& session,
                                                    const std::array<int, 2>& place_px);

}  // namespace railcast
