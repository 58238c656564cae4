#include "railcast/material.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"

namespace railcast {
namespace {

constexpr double kWetDiffuse905nm = 0.6;
constexpr double kWetDiffuse1550nm = 0.3;
constexpr double kFilmF0 = 0.02;
constexpr double kFilmRoughness = 0.15;
constexpr double kWetFacetSlope = 0.75;

bool Is1550nm(int wavelength_nm) {
  Check(wavelength_nm == 905 || wavelength_nm == 1550, "materials are known at 905 and 1550 nm");
  return wavelength_nm == 1550;
}

}  // namespace

SurfaceOptics OpticsAt(const Material& material, int wavelength_nm) {
  const bool is_1550nm = Is1550nm(wavelength_nm);
  const double diffuse = is_1550nm ? material.reflectivity_1550nm.value_or(material.reflectivity)
                                   : material.reflectivity;
  const double f0 =
      is_1550nm ? material.specular_f0_1550nm.value_or(material.specular_f0) : material.specular_f0;
  return {.diffuse = static_cast<float>(diffuse),
          .facet_slope_rad = static_cast<float>(RadFromDeg(material.facet_slope_deg)),
          .specular_f0 = static_cast<float>(f0),
          .specular_roughness = static_cast<float>(material.specular_roughness),
          .retroreflectance = static_cast<float>(material.retroreflectance)};
}

SurfaceOptics WetOptics(const SurfaceOptics& dry, double wetness, int wavelength_nm) {
  const double soaked = Is1550nm(wavelength_nm) ? kWetDiffuse1550nm : kWetDiffuse905nm;
  SurfaceOptics wet = dry;
  wet.diffuse *= static_cast<float>(std::lerp(1.0, soaked, wetness));
  wet.facet_slope_rad *= static_cast<float>(std::lerp(1.0, kWetFacetSlope, wetness));
  const auto film_f0 = static_cast<float>(kFilmF0 * wetness);
  if (film_f0 > dry.specular_f0) {
    wet.specular_f0 = film_f0;
    wet.specular_roughness = static_cast<float>(kFilmRoughness);
  }
  return wet;
}

MaterialLibrary::MaterialLibrary(const std::vector<Material>& materials) : MaterialLibrary() {
  materials_.insert(materials_.end(), materials.begin(), materials.end());
}

std::uint16_t MaterialLibrary::Index(std::string_view name) const {
  for (std::size_t i = 0; i < materials_.size(); ++i) {
    if (materials_[i].name == name) return static_cast<std::uint16_t>(i);
  }
  throw InputError({{"/materials", "the library must hold \"" + std::string(name) + '"', ""}});
}

}  // namespace railcast
