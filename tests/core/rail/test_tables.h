#pragma once

#include "core/rail/rail_surfaces.h"
#include "railcast/frame.h"
#include "railcast/material.h"

namespace railcast {

/// Tables with all names that RailSurfaces looks up.
[[nodiscard]] LabelTable TestLabels();
[[nodiscard]] MaterialLibrary TestMaterials();
[[nodiscard]] RailSurfaces TestSurfaces();

}  // namespace railcast
