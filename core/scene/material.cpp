#include "core/scene/material.h"

#include "core/base/error.h"

namespace railcast {

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
