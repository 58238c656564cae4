#include "core/scene/material.h"

#include "core/base/error.h"

namespace railcast {

SurfaceOptics OpticsAt(const Material& material, int) {
  return {static_cast<float>(material.reflectivity),
          static_cast<float>(material.facet_slope_deg * 3.14159265 / 180.0),
          static_cast<float>(material.specular_f0),
          static_cast<float>(material.specular_roughness),
          static_cast<float>(material.retroreflectance)};
}

SurfaceOptics WetOptics(const SurfaceOptics& dry, double, int) {
  return dry;
}

MaterialLibrary::MaterialLibrary(const std::vector<Material>& materials) : MaterialLibrary() {
  materials_.insert(materials_.end(), materials.begin(), materials.end());
}

std::uint16_t MaterialLibrary::Index(std::string_view name) const {
  for (std::size_t i = 0; i < materials_.size(); ++i) {
    if (materials_[i].name == name) return static_cast<std::uint16_t>(i);
  }
  throw InputError("materials: the library must hold \"" + std::string(name) + "\"");
}

}  // namespace railcast
