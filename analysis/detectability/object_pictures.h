#pragma once

#include <vector>

#include "analysis/detectability/detect_report.h"
#include "analysis/report/report.h"

namespace railcast {

/// A section with a picture for each object in the way, 12 at most: the scene when the object was
/// detected, with the camera's image if there is one, and what was seen of the object then and in
/// the last frame with too few points. It shows the first run that detected the object or, if none
/// did, the first that approached it.
/// @returns a section without pictures if nothing was approached that is in the way.
/// @throws InputError if a frame cannot be read.
[[nodiscard]] Section MakePictureSection(const std::vector<DetectRun>& runs);

}  // namespace railcast
