#pragma once

#include "railcast/scene.h"

namespace railcast {

/// Turns a model about its x axis, to the right, and then about its y axis, forwards, and moves it
/// so that the middle of its new bounding box in plan and its new lowest point are where they were
/// before. Angles in degrees, as ObjectSpec::roll_deg and pitch_deg.
void Lean(double roll_deg, double pitch_deg, Model& model);

}  // namespace railcast
