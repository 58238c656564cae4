#include "viewer/draw/actors.h"

#include <array>
#include <cmath>
#include <numeric>

#include <vtkBillboardTextActor3D.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty.h>
#include <vtkProperty2D.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include "viewer/draw/text_style.h"
#include "viewer/draw/vtk_values.h"

namespace railcast {

namespace {

/// Makes cells of `size` points each: 0 1 2 ..., as far as the cells go.
void MakeCells(std::size_t num_cells, std::size_t size, vtkCellArray& cells) {
  const auto count = static_cast<vtkIdType>(num_cells);
  const auto step = static_cast<vtkIdType>(size);
  vtkNew<vtkIdTypeArray> offsets;
  offsets->SetNumberOfValues(count + 1);
  for (vtkIdType i = 0; i <= count; ++i) offsets->SetValue(i, step * i);
  vtkNew<vtkIdTypeArray> indices;
  indices->SetNumberOfValues(step * count);
  std::iota(indices->GetPointer(0), indices->GetPointer(0) + step * count, 0);
  cells.SetData(offsets, indices);
}

Rgb Faint(const Rgb& rgb, const Rgb& background) {
  const auto mix = [](std::uint8_t value, std::uint8_t behind) {
    return static_cast<std::uint8_t>((value + 2 * behind) / 3);
  };
  return {mix(rgb[0], background[0]), mix(rgb[1], background[1]), mix(rgb[2], background[2])};
}

unsigned char Alpha(float opacity) {
  return static_cast<unsigned char>(std::lround(255.0F * opacity));
}

bool IsLight(const Rgb& rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2] > 140.0;  // Rec. 709 luma.
}

/// Makes a colour dark enough for a white background.
Rgb Darkened(const Rgb& rgb) {
  return {static_cast<std::uint8_t>(rgb[0] / 2), static_cast<std::uint8_t>(rgb[1] / 2),
          static_cast<std::uint8_t>(rgb[2] / 2)};
}

constexpr double kOpacity = 0.35;
constexpr Rgb kUnknownLabel = {150, 150, 150};

vtkSmartPointer<vtkPolyData> MakeTriangles(const Mesh& mesh) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices.size()));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    points->SetPoint(static_cast<vtkIdType>(i), mesh.vertices[i].cast<double>().eval().data());
  }
  vtkNew<vtkCellArray> faces;
  faces->AllocateEstimate(static_cast<vtkIdType>(mesh.triangles.size()), 3);
  for (const auto& triangle : mesh.triangles) {
    faces->InsertNextCell({triangle[0], triangle[1], triangle[2]});
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(faces);
  return data;
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
    MakeCells(1, shown_->num_points(), *vertices_);
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

vtkSmartPointer<vtkActor> MakeLines(const Overlay& drawing, double width_px) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(2 * static_cast<vtkIdType>(drawing.segments.size()));
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(4);
  colors->SetNumberOfTuples(points->GetNumberOfPoints());
  vtkIdType next = 0;
  for (const Overlay::Segment& segment : drawing.segments) {
    for (const Eigen::Vector3f* const end_m : {&segment.from_m, &segment.to_m}) {
      const Eigen::Vector3d place_m = end_m->cast<double>();
      points->SetPoint(next, place_m.data());
      const auto& [red, green, blue] = segment.rgb;
      const std::array<unsigned char, 4> rgba = {red, green, blue, Alpha(segment.opacity)};
      colors->SetTypedTuple(next++, rgba.data());
    }
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  vtkNew<vtkCellArray> pairs;
  MakeCells(drawing.segments.size(), 2, *pairs);
  data->SetLines(pairs);
  data->GetPointData()->SetScalars(colors);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetLighting(false);
  BlendInOrder(*actor);
  actor->GetProperty()->SetLineWidth(static_cast<float>(width_px));
  return actor;
}

std::vector<vtkSmartPointer<vtkProp>> MakeWords(const Overlay& drawing,
                                                int size_px,
                                                const Background& background) {
  std::vector<vtkSmartPointer<vtkProp>> props;
  for (const Overlay::Word& word : drawing.words) {
    auto actor = vtkSmartPointer<vtkBillboardTextActor3D>::New();
    actor->SetInput(word.text.c_str());
    Eigen::Vector3d at_m = word.at_m.cast<double>();
    actor->SetPosition(at_m.data());
    vtkTextProperty& text = *actor->GetTextProperty();
    text.SetFontSize(size_px);
    text.SetColor(VtkColor(word.rgb).data());
    text.SetJustificationToCentered();
    text.SetVerticalJustificationToBottom();
    // Without a plate, words would be illegible among points of their own colour.
    AddPlate(text, background);
    actor->ForceOpaqueOn();
    props.emplace_back(actor);
  }
  return props;
}

Rgb OnBackground(const Rgb& rgb, const Background& background) {
  return IsLight(background.rgb) && IsLight(rgb) ? Darkened(rgb) : rgb;
}

Overlay OnBackground(Overlay drawing, const Background& background) {
  for (Overlay::Segment& segment : drawing.segments) {
    segment.rgb = OnBackground(segment.rgb, background);
  }
  for (Overlay::Word& word : drawing.words) word.rgb = OnBackground(word.rgb, background);
  return drawing;
}

vtkSmartPointer<vtkActor2D> MakeShape(const std::vector<Eigen::Vector2d>& points_px,
                                      bool is_filled,
                                      const Rgb& rgb) {
  vtkNew<vtkPoints> places;
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(static_cast<int>(points_px.size()));
  for (const Eigen::Vector2d& point_px : points_px) {
    cells->InsertCellPoint(places->InsertNextPoint(point_px.x(), point_px.y(), 0.0));
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(places);
  if (is_filled) {
    data->SetPolys(cells);
  } else {
    data->SetLines(cells);
  }
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(data);
  auto actor = vtkSmartPointer<vtkActor2D>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(VtkColor(rgb).data());
  return actor;
}

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
