#include "core/rail/base/model_parts.h"

#include <algorithm>

namespace railcast {

Part& PartOf(const SurfaceClass& surface, Model& model) {
  const auto part =
      std::find_if(model.parts.begin(), model.parts.end(), [&](const Part& candidate) {
        return candidate.material == surface.material && candidate.label == surface.label;
      });
  if (part != model.parts.end()) return *part;
  model.parts.push_back({.mesh = {}, .material = surface.material, .label = surface.label});
  return model.parts.back();
}

}  // namespace railcast
