#pragma once

#include "core/frame/labels.h"
#include "core/rail/rail_surfaces.h"
#include "core/scene/material.h"

namespace railcast {

/// Tables with all that RailSurfaces looks up.
[[nodiscard]] LabelTable TestLabels();
[[nodiscard]] MaterialLibrary TestMaterials();
[[nodiscard]] RailSurfaces TestSurfaces();

}  // namespace railcast
