#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/transform.h"
#include "core/scene/mesh.h"
#include "viewer/color/coloring.h"
#include "viewer/frames/shown_frame.h"
#include "viewer/overlays/drawing.h"

namespace railcast {

/// A frame's points where they are drawn.
struct PlacedCloud {
  std::shared_ptr<const ShownFrame> shown;
  Transform view_from_sensor = Transform::Identity();
  std::vector<Rgb> colors;       ///< Of each point.
  std::vector<bool> is_faint{};  ///< Of each point; empty: none is.
};

/// Surfaces where they are drawn.
struct PlacedParts {
  std::shared_ptr<const std::vector<Part>> parts;
  Transform view_from_parts = Transform::Identity();
};

/// All that one view shows, in the axes of its frame's sensor at the stamp: x forward, y left, z
/// up. The camera rides along with the sensor; what stands in the world moves past it.
struct Scene {
  std::vector<PlacedCloud> clouds;  ///< The frame first; empty: there is none yet.
  Coloring coloring;                ///< Of the frame, for the legend.
  Drawing overlays;
  Drawing empty_beams;
  std::vector<Category> beam_kinds;  ///< What their colours mean, and how many there are of each.
  std::vector<PlacedParts> surfaces;
  LabelTable labels;   ///< Of the surfaces.
  std::string status;  ///< Lines for people: frame, stamp, points, dropout, ...
};

}  // namespace railcast
