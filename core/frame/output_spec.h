#pragma once

#include <array>
#include <string>

namespace railcast {

/// In which axes frames carry their points.
struct OutputSpec {
  /// "sensor" (at the firing's own time, as a real sensor delivers it), "vehicle" (the same, moved
  /// by the mounting) or "world" (moved by the pose at the firing's time: no motion distortion).
  std::string frame = "sensor";
  std::string handedness = "right";  ///< "right", or "left": y is negated, as Unreal has it.
  /// Subtracted from world coordinates, which float32 holds to a millimetre only within 8 km.
  std::array<double, 3> origin_m{0.0, 0.0, 0.0};

  bool operator==(const OutputSpec&) const = default;
};

}  // namespace railcast
