#pragma once

#include <vtkSmartPointer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <array>
#include <cstdint>
#include <string>

#include "viewer/draw/look.h"

namespace railcast {

/// Sets the font size to a 45th of the window's height and the colour to that of words on the
/// background.
void StyleText(vtkTextProperty& text, const Background& background, int height_px);

/// Puts text on a faint plate, so that it is legible over points.
void AddPlate(vtkTextProperty& text, const Background& background);

/// Which point of a text lies at its position.
enum class TextAnchor : std::uint8_t {
  kLeftBottom,
  kLeftMiddle,
  kLeftTop,
  kRightTop,
  kRightBottom,
  kMiddle
};

/// Makes text at a place, in pixels from the view's lower left corner.
[[nodiscard]] vtkSmartPointer<vtkTextActor> MakeText(const std::string& words,
                                                     const Background& background,
                                                     int height_px,
                                                     const std::array<double, 2>& place_px,
                                                     TextAnchor anchor);

}  // namespace railcast
