#pragma once

#include <vector>

#include "railcast/material.h"
#include "railcast/transform.h"

namespace railcast {

/// Returns the reflectance of each material in red, green and blue light, by index. Materials that
/// the table of docs/camera.md does not name are grey, as bright as at 905 nm.
[[nodiscard]] std::vector<Vector3> MaterialColors(const MaterialLibrary& materials);

}  // namespace railcast
