#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "railcast/transform.h"
#include "viewer/overlays/overlays.h"

namespace railcast {

// The strokes that overlays are made of, from positions in double precision in the sensor's axes.

inline void AddSegment(const Vector3& from_m, const Vector3& to_m, Rgb rgb, Overlay& drawing) {
  drawing.segments.push_back(
      {.from_m = from_m.cast<float>(), .to_m = to_m.cast<float>(), .rgb = rgb});
}

/// Adds segments from each point to the next.
inline void AddPolyline(const std::vector<Vector3>& points_m, Rgb rgb, Overlay& drawing) {
  for (std::size_t i = 1; i < points_m.size(); ++i) {
    AddSegment(points_m[i - 1], points_m[i], rgb, drawing);
  }
}

inline void AddWord(const Vector3& at_m, std::string text, Rgb rgb, Overlay& drawing) {
  drawing.words.push_back({at_m.cast<float>(), std::move(text), rgb});
}

}  // namespace railcast
