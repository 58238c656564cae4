#pragma once

#include <vtkActor.h>
#include <vtkSmartPointer.h>

#include <vector>

#include "core/frame/labels.h"
#include "core/scene/mesh.h"

namespace railcast {

/// Surfaces in the colours of their labels, translucent; in the axes that the parts have.
[[nodiscard]] std::vector<vtkSmartPointer<vtkActor>> MakeSurfaces(const std::vector<Part>& parts,
                                                                  const LabelTable& labels);

}  // namespace railcast
