#pragma once

#include "core/rail/base/rail_surfaces.h"
#include "railcast/frame.h"
#include "railcast/material.h"

namespace railcast {

/// Tables with all names that RailSurfaces looks up.
[[nodiscard]] LabelTable RailLabels();
[[nodiscard]] MaterialLibrary RailMaterials();
[[nodiscard]] RailSurfaces TestSurfaces();

}  // namespace railcast
