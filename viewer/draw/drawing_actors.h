#pragma once

#include <vtkActor.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <vector>

#include "viewer/draw/look.h"
#include "viewer/overlays/drawing.h"

namespace railcast {

/// A drawing's lines as one actor.
[[nodiscard]] vtkSmartPointer<vtkActor> MakeLines(const Drawing& drawing, double width_px);

/// A drawing's words, facing the viewer. @param size_px Of their letters.
[[nodiscard]] std::vector<vtkSmartPointer<vtkProp>> MakeWords(const Drawing& drawing,
                                                              int size_px,
                                                              const Background& background);

/// The drawing with its light lines and words darkened if the background is light, too.
[[nodiscard]] Drawing OnBackground(Drawing drawing, const Background& background);

}  // namespace railcast
