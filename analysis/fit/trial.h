#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/detect/beam_optics.h"
#include "core/scene/material.h"

namespace railcast {

/// What became of a firing that should have met a known surface.
enum class Answer : std::uint8_t {
  kLost,       ///< No point.
  kReturned,   ///< A point near where the surface is.
  kElsewhere,  ///< A point so far from there that it is none of the surface's.
};

/// One firing of which it is known what it should have met. Why nothing came back is not part of
/// it: a recording does not say so.
struct Trial {
  float expected_m{};       ///< Range of the surface, from truth or a plane.
  float cos_incidence{};    ///< Between beam and surface normal, > 0.
  float stretch = 1.0F;     ///< What pulse stretch leaves of the power; NaN = not known.
  float slant = 0.0F;       ///< d(range) / d(angle of the beam), m / rad; 0 where ...
                            ///< ... the expected range is that of the beam as it went.
  std::uint16_t surface{};  ///< Index into the surfaces.
  std::uint16_t channel{};  ///< Ring.
  Answer answer = Answer::kLost;
  float residual_m = std::numeric_limits<float>::quiet_NaN();  ///< Measured - expected.
  float intensity = std::numeric_limits<float>::quiet_NaN();   ///< As recorded.
};

/// A kind of surface whose reflectance is looked for: a material, a label, or a plane.
struct FitSurface {
  std::string name;
  /// The shape of its answer, as given: what it answers if its reflectance is 1.
  LaneOptics unit{.diffuse = 1.0F, .a = 1.0F, .b = 0.0F, .f0 = 0.0F, .alpha2 = 1.0F, .retro = 0.0F};
};

/// What a surface of reflectance rho answers, as a share of a white Lambertian that faces the beam:
/// rho x diffuse + lobe (core/detect/surface_response.h).
struct ShapedAnswer {
  double diffuse{};
  double lobe{};
};

/// Lambert: cos, without a lobe. A surface whose material is not known.
[[nodiscard]] FitSurface MakeLambertSurface(const std::string& name);

/// With the shape of a material: facet slope, lobe and retroreflector as given, the reflectance
/// left open. The reflectance that a fit finds is that of the dry material.
[[nodiscard]] FitSurface MakeShapedSurface(const Material& material,
                                           int wavelength_nm,
                                           double wetness);

[[nodiscard]] ShapedAnswer AnswerOf(const FitSurface& surface, double cos_incidence);

}  // namespace railcast
