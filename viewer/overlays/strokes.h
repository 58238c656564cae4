#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/base/transform.h"
#include "viewer/overlays/drawing.h"

namespace railcast {

// What drawings are made of, from places in double in the sensor's axes.

inline void AddSegment(const Vector3& from_m, const Vector3& to_m, Rgb rgb, Drawing& drawing) {
  drawing.segments.push_back(
      {.from_m = from_m.cast<float>(), .to_m = to_m.cast<float>(), .rgb = rgb});
}

/// Segments from each point to the next.
inline void AddPolyline(const std::vector<Vector3>& points_m, Rgb rgb, Drawing& drawing) {
  for (std::size_t i = 1; i < points_m.size(); ++i) {
    AddSegment(points_m[i - 1], points_m[i], rgb, drawing);
  }
}

inline void AddWord(const Vector3& at_m, std::string text, Rgb rgb, Drawing& drawing) {
  drawing.words.push_back({at_m.cast<float>(), std::move(text), rgb});
}

}  // namespace railcast
