#pragma once

#include <cstdint>
#include <string_view>

#include "railcast/frame.h"
#include "railcast/material.h"

namespace railcast {

/// Material and label of a triangle.
struct SurfaceClass {
  std::uint16_t material{};
  std::uint32_t label{};
};

/// The surfaces of the railway world, looked up by name once.
struct RailSurfaces {
  SurfaceClass rail_head, rail_side, fastening;
  SurfaceClass sleeper_concrete, sleeper_wood, ballast;
  SurfaceClass ground, grass, leaf, bark;
  SurfaceClass contact_wire, messenger_wire, dropper, mast, cantilever, insulator;
  SurfaceClass wagon_body, wagon_frame, wheel, tank;
  SurfaceClass skin, clothing, pole, box;

  /// Sets all materials and labels to 0, for geometry that is built only to be checked.
  RailSurfaces() = default;
  /// @throws InputError with a line for every name that the tables lack.
  RailSurfaces(const LabelTable& labels, const MaterialLibrary& materials);
};

/// Whether the railway itself or one of its models has surfaces of the material.
[[nodiscard]] bool IsRailMaterial(std::string_view name);

}  // namespace railcast
