#pragma once

#include <vtkRenderWindow.h>

#include <array>
#include <string>

#include "viewer/draw/look.h"
#include "viewer/plan/plan.h"

namespace railcast {

/// A plan, drawn out of sight at equal scale in both directions, with a title, a scale bar, an
/// arrow to the north and a legend. Words that would cover others are left out.
[[nodiscard]] vtkSmartPointer<vtkRenderWindow> DrawPlan(const Plan& plan,
                                                        const std::string& title,
                                                        const Background& background,
                                                        const std::array<int, 2>& size_px);

}  // namespace railcast
