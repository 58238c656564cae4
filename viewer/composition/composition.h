#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "railcast/scene.h"
#include "railcast/transform.h"
#include "viewer/composition/coloring.h"
#include "viewer/frames/camera_picture.h"
#include "viewer/frames/shown_frame.h"
#include "viewer/overlays/overlays.h"

namespace railcast {

/// A frame's points and where they are drawn.
struct PlacedCloud {
  std::shared_ptr<const ShownFrame> shown;
  Transform view_from_sensor = Transform::Identity();
  std::vector<Rgb> colors;       ///< One per point.
  std::vector<bool> is_faint{};  ///< One per point; empty: no point is faint.
  std::size_t source{};          ///< Where one view shows two sources: whose cloud this is.
};

/// Surfaces and where they are drawn.
struct PlacedParts {
  std::shared_ptr<const std::vector<Part>> parts;
  Transform view_from_parts = Transform::Identity();
};

/// All that one view shows, in the axes of its frame's sensor at the stamp: x forward, y left, z
/// up. The camera rides along with the sensor, and the standing scene moves past it.
struct Composition {
  std::vector<PlacedCloud> clouds;  ///< The frame itself first; empty: there is none yet.
  Coloring coloring;                ///< The frame's colours, for the legend.
  Overlay overlays;
  Overlay empty_beams;
  std::vector<Category> beam_kinds;  ///< The colours of empty beams, their meaning and number.
  std::vector<PlacedParts> surfaces;
  LabelTable labels;                ///< Names and colours for the surfaces.
  bool is_origin_on_rails = false;  ///< As that of merged clouds is, in place of a sensor.
  std::shared_ptr<const CameraPicture> picture{};  ///< The camera's image; null: none.
  std::string picture_fault{};                     ///< Why it cannot be read; empty if it can.
  std::string status;  ///< Lines of text: frame, stamp, points, dropout, ...
};

}  // namespace railcast
