#include "analysis/fit/trial.h"

#include "core/detect/surface_response.h"

namespace railcast {

FitSurface MakeLambertSurface(const std::string& name) {
  FitSurface surface;
  surface.name = name;
  return surface;
}

FitSurface MakeShapedSurface(const Material& material, int wavelength_nm, double wetness) {
  SurfaceOptics optics = OpticsAt(material, wavelength_nm);
  optics.diffuse = 1.0F;
  if (wetness > 0.0) optics = WetOptics(optics, wetness, wavelength_nm);
  return {material.name, LaneOpticsOf(optics)};
}

ShapedAnswer AnswerOf(const FitSurface& surface, double cos_incidence) {
  const auto cosine = static_cast<float>(cos_incidence);
  LaneOptics lobe = surface.unit;
  lobe.a = lobe.b = 0.0F;
  const auto lobe_answer = static_cast<double>(baseline::EffectiveReflectance(lobe, cosine));
  return {static_cast<double>(baseline::EffectiveReflectance(surface.unit, cosine)) - lobe_answer,
          lobe_answer};
}

}  // namespace railcast
