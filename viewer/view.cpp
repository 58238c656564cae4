#include "viewer/view.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>

#include "viewer/legend.h"
#include "viewer/point_colors.h"

namespace railcast {
namespace {

constexpr std::array<double, 3> kBackground = {0.10, 0.10, 0.11};

vtkSmartPointer<vtkActor> MakePoints(const Cloud& cloud, const Coloring& coloring, int height_px) {
  vtkNew<vtkFloatArray> positions;
  positions->SetNumberOfComponents(3);
  positions->SetNumberOfTuples(static_cast<vtkIdType>(cloud.size()));
  std::ranges::copy(cloud.positions_m, positions->GetPointer(0));
  vtkNew<vtkPoints> points;
  points->SetData(positions);

  vtkNew<vtkCellArray> vertices;
  vertices->InsertNextCell(static_cast<int>(cloud.size()));
  for (vtkIdType i = 0; i < static_cast<vtkIdType>(cloud.size()); ++i) vertices->InsertCellPoint(i);

  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(3);
  for (const Rgb& rgb : PointColors(coloring)) colors->InsertNextTypedTuple(rgb.data());

  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetVerts(vertices);
  data->GetPointData()->SetScalars(colors);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetLighting(false);
  // Neighbouring beams of a spinning sensor then nearly touch.
  actor->GetProperty()->SetPointSize(std::max(2.0F, static_cast<float>(height_px) / 300.0F));
  return actor;
}

vtkSmartPointer<vtkTextActor> MakeCaption(const std::string& text, int height_px) {
  auto actor = vtkSmartPointer<vtkTextActor>::New();
  actor->SetInput(text.c_str());
  actor->GetTextProperty()->SetFontSize(height_px / 45);
  actor->GetTextProperty()->SetColor(0.75, 0.75, 0.75);
  actor->SetPosition(height_px / 60.0, height_px / 60.0);
  return actor;
}

struct CameraPlace {
  std::array<double, 3> eye_m;
  std::array<double, 3> target_m;
  std::array<double, 3> up;
};

/// In the sensor's axes: x forward, y left, z up; the sensor is some metres above the rail.
CameraPlace PlaceOf(const std::string& camera) {
  if (camera == "driver") return {{-1.0, 0.0, 0.3}, {60.0, 0.0, -1.5}, {0.0, 0.0, 1.0}};
  if (camera == "side") return {{45.0, -75.0, 18.0}, {45.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
  if (camera == "top") return {{55.0, 0.0, 150.0}, {55.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  return {{-20.0, 0.0, 12.0}, {35.0, 0.0, -2.0}, {0.0, 0.0, 1.0}};
}

/// Where the cloud's sensor is: its origin. A cloud that does not surround it, one in world
/// coordinates say, is looked at as if its sensor were at its middle.
std::array<double, 3> OriginOf(const Cloud& cloud) {
  std::array<double, 3> middle_m{};
  bool surrounds = true;
  for (std::size_t axis = 0; axis < 3 && cloud.size() > 0; ++axis) {
    float lowest = cloud.positions_m[axis];
    float highest = lowest;
    for (std::size_t i = axis; i < cloud.positions_m.size(); i += 3) {
      lowest = std::min(lowest, cloud.positions_m[i]);
      highest = std::max(highest, cloud.positions_m[i]);
    }
    middle_m[axis] = 0.5 * (static_cast<double>(lowest) + static_cast<double>(highest));
    const double size_m = static_cast<double>(highest) - static_cast<double>(lowest);
    if (std::abs(middle_m[axis]) > std::max(2.0 * size_m, 300.0)) surrounds = false;
  }
  return surrounds ? std::array<double, 3>{} : middle_m;
}

void PlaceCamera(vtkRenderer& renderer, const Cloud& cloud, const std::string& camera) {
  const std::array<double, 3> o = OriginOf(cloud);
  const CameraPlace p = PlaceOf(camera);
  vtkCamera* const view = renderer.GetActiveCamera();
  view->SetPosition(o[0] + p.eye_m[0], o[1] + p.eye_m[1], o[2] + p.eye_m[2]);
  view->SetFocalPoint(o[0] + p.target_m[0], o[1] + p.target_m[1], o[2] + p.target_m[2]);
  view->SetViewUp(p.up.data());
  view->SetViewAngle(36.0);
  renderer.ResetCameraClippingRange();
}

void Fill(vtkRenderer& renderer,
          const Cloud& cloud,
          const Coloring& coloring,
          const ViewSpec& spec) {
  renderer.AddActor(MakePoints(cloud, coloring, spec.size_px[1]));
  AddLegend(renderer, coloring, spec.size_px);
  renderer.AddActor2D(MakeCaption(spec.caption, spec.size_px[1]));
}

}  // namespace

vtkSmartPointer<vtkRenderWindow> MakeView(const Cloud& cloud,
                                          const Coloring& coloring,
                                          const ViewSpec& spec) {
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(kBackground[0], kBackground[1], kBackground[2]);
  Fill(*renderer, cloud, coloring, spec);
  PlaceCamera(*renderer, cloud, spec.camera);

  auto window = vtkSmartPointer<vtkRenderWindow>::New();
  window->SetSize(spec.size_px[0], spec.size_px[1]);
  window->SetMultiSamples(0);
  window->SetWindowName("railcast-view");
  window->AddRenderer(renderer);
  return window;
}

void ReplaceCloud(vtkRenderWindow& window,
                  const Cloud& cloud,
                  const Coloring& coloring,
                  const ViewSpec& spec) {
  vtkRenderer& renderer = *window.GetRenderers()->GetFirstRenderer();
  renderer.RemoveAllViewProps();
  Fill(renderer, cloud, coloring, spec);
  renderer.ResetCameraClippingRange();
}

}  // namespace railcast
