#include "viewer/draw/parts_actors.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "viewer/draw/vtk_values.h"

namespace railcast {
namespace {

constexpr double kOpacity = 0.35;
constexpr Rgb kUnknownLabel = {150, 150, 150};

vtkSmartPointer<vtkPolyData> MakeTriangles(const Mesh& mesh) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices.size()));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    points->SetPoint(static_cast<vtkIdType>(i), mesh.vertices[i].cast<double>().eval().data());
  }
  const auto count = static_cast<vtkIdType>(mesh.triangles.size());
  vtkNew<vtkIdTypeArray> offsets;
  offsets->SetNumberOfValues(count + 1);
  vtkNew<vtkIdTypeArray> indices;
  indices->SetNumberOfValues(3 * count);
  for (vtkIdType i = 0; i <= count; ++i) offsets->SetValue(i, 3 * i);
  for (vtkIdType i = 0; i < 3 * count; ++i) {
    indices->SetValue(
        i, mesh.triangles[static_cast<std::size_t>(i / 3)][static_cast<std::size_t>(i % 3)]);
  }
  vtkNew<vtkCellArray> faces;
  faces->SetData(offsets, indices);
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(faces);
  return data;
}

}  // namespace

std::vector<vtkSmartPointer<vtkActor>> MakeSurfaces(const std::vector<Part>& parts,
                                                    const LabelTable& labels) {
  std::vector<vtkSmartPointer<vtkActor>> actors;
  for (const Part& part : parts) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(MakeTriangles(part.mesh));
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    const Label* const label = labels.Find(part.label);
    actor->GetProperty()->SetColor(VtkColor(label == nullptr ? kUnknownLabel : label->rgb).data());
    actor->GetProperty()->SetInterpolationToFlat();
    actor->GetProperty()->SetOpacity(kOpacity);
    BlendInOrder(*actor);
    actors.push_back(std::move(actor));
  }
  return actors;
}

}  // namespace railcast
