#pragma once

#include <cstdint>

#include "core/frame/labels.h"
#include "core/scene/material.h"

namespace railcast {

/// What a triangle is made of and what it is called.
struct SurfaceClass {
  std::uint16_t material{};
  std::uint32_t label{};
};

/// The surfaces that the railway world is built of, looked up by name once.
struct RailSurfaces {
  SurfaceClass rail_head, rail_side, fastening;
  SurfaceClass sleeper_concrete, sleeper_wood, ballast;
  SurfaceClass ground, grass, leaf, bark;
  SurfaceClass contact_wire, messenger_wire, dropper, mast, cantilever, insulator;
  SurfaceClass wagon_body, wagon_frame, wheel, tank;
  SurfaceClass skin, clothing, pole, box;

  /// Material and label 0 everywhere, for what is built only to be checked.
  RailSurfaces() = default;
  /// @throws InputError with a line for every name that the tables lack.
  RailSurfaces(const LabelTable& labels, const MaterialLibrary& materials);
};

}  // namespace railcast
