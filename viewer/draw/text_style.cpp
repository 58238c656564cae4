#include "viewer/draw/text_style.h"

#include "viewer/draw/vtk_values.h"

namespace railcast {

void StyleText(vtkTextProperty& text, const Background& background, int height_px) {
  text.SetColor(VtkColor(background.words).data());
  text.SetBold(false);
  text.SetItalic(false);
  text.SetShadow(false);
  text.SetFontSize(height_px / 45);
}

void AddPlate(vtkTextProperty& text, const Background& background) {
  text.SetBackgroundColor(VtkColor(background.rgb).data());
  text.SetBackgroundOpacity(0.6);
}

vtkSmartPointer<vtkTextActor> MakeText(const std::string& words,
                                       const Background& background,
                                       int height_px,
                                       const std::array<double, 2>& place_px,
                                       TextAnchor anchor) {
  auto actor = vtkSmartPointer<vtkTextActor>::New();
  actor->SetInput(words.c_str());
  vtkTextProperty& text = *actor->GetTextProperty();
  StyleText(text, background, height_px);
  if (anchor == TextAnchor::kLeftMiddle) text.SetVerticalJustificationToCentered();
  if (anchor == TextAnchor::kRightBottom) text.SetJustificationToRight();
  actor->SetPosition(place_px[0], place_px[1]);
  return actor;
}

}  // namespace railcast
