#include "viewer/draw/cloud_actor.h"

#include <vtkIdTypeArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkProperty.h>

#include <numeric>

#include "viewer/draw/vtk_values.h"

namespace railcast {
namespace {

/// Makes one cell of all points.
void MakeVertices(std::size_t num_points, vtkCellArray& vertices) {
  const auto count = static_cast<vtkIdType>(num_points);
  vtkNew<vtkIdTypeArray> offsets;
  offsets->SetNumberOfValues(2);
  offsets->SetValue(0, 0);
  offsets->SetValue(1, count);
  vtkNew<vtkIdTypeArray> indices;
  indices->SetNumberOfValues(count);
  std::iota(indices->GetPointer(0), indices->GetPointer(0) + count, 0);
  vertices.SetData(offsets, indices);
}

Rgb Faint(const Rgb& rgb, const Rgb& background) {
  const auto mix = [](std::uint8_t value, std::uint8_t behind) {
    return static_cast<std::uint8_t>((value + 2 * behind) / 3);
  };
  return {mix(rgb[0], background[0]), mix(rgb[1], background[1]), mix(rgb[2], background[2])};
}

}  // namespace

CloudActor::CloudActor() {
  positions_->SetNumberOfComponents(3);
  rgb_->SetNumberOfComponents(3);
  vtkNew<vtkPoints> points;
  points->SetData(positions_);
  data_->SetPoints(points);
  data_->GetPointData()->SetScalars(rgb_);
  mapper_->SetInputData(data_);
  actor_->SetMapper(mapper_);
  actor_->GetProperty()->SetLighting(false);
  actor_->SetUserMatrix(matrix_);
}

void CloudActor::Show(const PlacedCloud& cloud, const Look& look) {
  shown_ = cloud.shown;
  colors_ = cloud.colors;
  for (std::size_t i = 0; i < cloud.is_faint.size(); ++i) {
    if (cloud.is_faint[i]) colors_[i] = Faint(colors_[i], look.background.rgb);
  }
  // VTK only reads the array, but its interface takes a non-const pointer.
  auto* const positions = const_cast<float*>(shown_->positions_m.data());
  constexpr int kOurs = 1;
  positions_->SetArray(positions, static_cast<vtkIdType>(shown_->positions_m.size()), kOurs);
  rgb_->SetArray(reinterpret_cast<unsigned char*>(colors_.data()),
                 3 * static_cast<vtkIdType>(colors_.size()), kOurs);
  if (vertices_->GetNumberOfConnectivityIds() != static_cast<vtkIdType>(shown_->num_points())) {
    MakeVertices(shown_->num_points(), *vertices_);
  }
  data_->SetVerts(shown_->num_points() > 0 ? vertices_.Get() : nullptr);
  positions_->Modified();
  rgb_->Modified();
  data_->GetPoints()->Modified();
  data_->Modified();
  SetMatrix(cloud.view_from_sensor, *matrix_);
  matrix_->Modified();
  actor_->GetProperty()->SetPointSize(static_cast<float>(look.point_size_px));
}

}  // namespace railcast
