#include "viewer/legend.h"

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkCoordinate.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>

namespace railcast {
namespace {

constexpr int kScaleSteps = 256;

void Style(vtkTextProperty& text, int height_px) {
  text.SetColor(0.88, 0.88, 0.88);
  text.SetBold(false);
  text.SetItalic(false);
  text.SetShadow(false);
  text.SetFontSize(height_px / 45);
}

/// A square, its lower left corner at (left, bottom), in shares of the window.
vtkSmartPointer<vtkActor2D> Swatch(const Rgb& rgb,
                                   const std::array<double, 2>& corner,
                                   const std::array<double, 2>& size) {
  vtkNew<vtkPoints> corners;
  for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
    corners->InsertNextPoint(corner[0] + x * size[0], corner[1] + y * size[1], 0.0);
  }
  vtkNew<vtkCellArray> faces;
  faces->InsertNextCell({0, 1, 2, 3});
  vtkNew<vtkPolyData> square;
  square->SetPoints(corners);
  square->SetPolys(faces);
  vtkNew<vtkCoordinate> shares;
  shares->SetCoordinateSystemToNormalizedViewport();
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(square);
  mapper->SetTransformCoordinate(shares);
  auto actor = vtkSmartPointer<vtkActor2D>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0);
  return actor;
}

void Add(vtkRenderer& renderer,
         const CategoryColoring& coloring,
         const std::array<int, 2>& size_px) {
  // Lines of 3 % of the window's height, less where there are many.
  const auto num_lines = static_cast<double>(coloring.categories.size());
  const double line = std::min(0.03, 0.9 / std::max(1.0, num_lines));
  const double aspect = static_cast<double>(size_px[1]) / size_px[0];
  const double left = 0.02 * aspect;
  double middle = 0.98 - 0.5 * line;
  for (const Category& category : coloring.categories) {
    const double side = 0.6 * line;
    renderer.AddActor2D(Swatch(category.rgb, {left, middle - 0.5 * side}, {side * aspect, side}));
    vtkNew<vtkTextActor> name;
    name->SetInput(category.name.c_str());
    Style(*name->GetTextProperty(), size_px[1]);
    name->GetTextProperty()->SetVerticalJustificationToCentered();
    name->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
    name->SetPosition(left + 1.6 * side * aspect, middle);
    renderer.AddActor2D(name);
    middle -= line;
  }
}

void Add(vtkRenderer& renderer, const ScalarColoring& coloring, const std::array<int, 2>& size_px) {
  vtkNew<vtkLookupTable> colors;
  colors->SetNumberOfTableValues(kScaleSteps);
  colors->SetRange(coloring.lowest, coloring.highest);
  for (int i = 0; i < kScaleSteps; ++i) {
    const Rgb rgb = ScaleColor(i / (kScaleSteps - 1.0));
    colors->SetTableValue(i, rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0);
  }
  vtkNew<vtkScalarBarActor> bar;
  bar->SetLookupTable(colors);
  bar->SetMaximumNumberOfColors(kScaleSteps);
  bar->SetTitle(coloring.title.c_str());
  bar->SetVerticalTitleSeparation(size_px[1] / 60);
  bar->SetNumberOfLabels(5);
  bar->SetLabelFormat("%-.3g");
  bar->SetPosition(0.905, 0.12);
  bar->SetWidth(0.085);
  bar->SetHeight(0.76);
  bar->UnconstrainedFontSizeOn();
  Style(*bar->GetTitleTextProperty(), size_px[1]);
  Style(*bar->GetLabelTextProperty(), size_px[1]);
  renderer.AddActor2D(bar);
}

}  // namespace

void AddLegend(vtkRenderer& renderer, const Coloring& coloring, const std::array<int, 2>& size_px) {
  std::visit([&](const auto& kind) { Add(renderer, kind, size_px); }, coloring);
}

}  // namespace railcast
