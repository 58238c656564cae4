#pragma once

#include <vtkSmartPointer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <array>
#include <cstdint>
#include <string>

#include "viewer/draw/look.h"

namespace railcast {

/// Letters of a 45th of the window's height, in the colour of words on that background.
void StyleText(vtkTextProperty& text, const Background& background, int height_px);

/// Puts words on a faint plate, so that they can be read over points.
void AddPlate(vtkTextProperty& text, const Background& background);

/// Which point of a text lies where it is put.
enum class TextAnchor : std::uint8_t {
  kLeftBottom,
  kLeftMiddle,
  kLeftTop,
  kRightTop,
  kRightBottom,
  kMiddle
};

/// Words at a place, in pixels from the view's lower left corner.
[[nodiscard]] vtkSmartPointer<vtkTextActor> MakeText(const std::string& words,
                                                     const Background& background,
                                                     int height_px,
                                                     const std::array<double, 2>& place_px,
                                                     TextAnchor anchor);

}  // namespace railcast
