#pragma once

#include <vtkActor.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vector>

#include "railcast/frame.h"
#include "railcast/scene.h"
#include "viewer/draw/look.h"
#include "viewer/overlays/overlays.h"

namespace railcast {

/// Makes one actor of an overlay's lines.
[[nodiscard]] vtkSmartPointer<vtkActor> MakeLines(const Overlay& drawing, double width_px);

/// Makes an overlay's words, which always face the viewer.
/// @param size_px Font size.
[[nodiscard]] std::vector<vtkSmartPointer<vtkProp>> MakeWords(const Overlay& drawing,
                                                              int size_px,
                                                              const Background& background);

/// Returns the colour, darkened if both it and the background are light.
[[nodiscard]] Rgb OnBackground(const Rgb& rgb, const Background& background);

/// Returns the overlay; its light lines and words are darkened if the background is light.
[[nodiscard]] Overlay OnBackground(Overlay drawing, const Background& background);

/// Makes translucent surfaces in the colours of their labels, in the axes of the parts.
[[nodiscard]] std::vector<vtkSmartPointer<vtkActor>> MakeSurfaces(const std::vector<Part>& parts,
                                                                  const LabelTable& labels);

}  // namespace railcast
