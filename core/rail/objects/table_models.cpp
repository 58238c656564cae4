#include "core/rail/objects/mesh_object.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "core/base/error.h"
#include "core/base/shipped_files.h"
#include "core/base/text.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/objects/object_surfaces.h"

namespace railcast {
namespace {

/// The model as an object of type mesh.
ObjectSpec MeshSpecOf(const ModelSpec& model) {
  ObjectSpec spec;
  spec.type = ObjectType::kMesh;
  spec.file = model.file;
  spec.up = model.up;
  spec.unit_m = model.unit_m;
  spec.origin = model.origin;
  spec.parts = model.parts;
  spec.tolerance_mm = model.tolerance_mm;
  return spec;
}

Eigen::AlignedBox3d BoundsOf(const ModelSpec& model, const std::vector<Model>& pieces) {
  Eigen::AlignedBox3d bounds_m = pieces.front().Bounds();
  if (!model.rail_vehicle) return bounds_m;
  const Eigen::AlignedBox3d bogie_m = pieces.back().Bounds();
  const Vector3 to_pivot_m(0.5 * model.rail_vehicle->pivot_distance_m, 0.0, 0.0);
  bounds_m.extend(Eigen::AlignedBox3d(bogie_m.min() - to_pivot_m, bogie_m.max() + to_pivot_m));
  return bounds_m;
}

std::string SizeText(const Vector3& size_m) {
  return ShortText(size_m.x()) + " x " + ShortText(size_m.y()) + " x " + ShortText(size_m.z());
}

/// A wrong unit or axis is found here, before a train is coupled at the ends of that length.
void CheckSize(const ModelSpec& model, const std::vector<Model>& pieces) {
  constexpr double kTolerance_m = 0.02;
  constexpr double kToleranceShare = 0.01;
  const Eigen::AlignedBox3d bounds_m = BoundsOf(model, pieces);
  const Vector3 found_m(bounds_m.sizes().x(), bounds_m.sizes().y(), bounds_m.max().z());
  const Vector3 given_m(model.size_m[0], model.size_m[1], model.size_m[2]);
  const Vector3 tolerance_m = (kToleranceShare * given_m).cwiseMax(kTolerance_m);
  if (((found_m - given_m).cwiseAbs().array() <= tolerance_m.array()).all()) return;
  throw InputError(
      {{"/size_m", "must be the size of its mesh, " + SizeText(found_m), SizeText(given_m)}});
}

std::vector<Model> MakePieces(const ModelSpec& model, const MeshTables& tables) {
  std::vector<std::string> files = {model.file};
  if (model.rail_vehicle) files.push_back(model.rail_vehicle->bogie);
  ObjectSpec spec = MeshSpecOf(model);
  if (tables.labels.labels().empty()) {  // Made only to be checked.
    for (MeshPartSpec& part : spec.parts) part = {part.of, {}, {}};
  }
  std::vector<Model> pieces;
  for (MeshObject& object : MakeMeshObjects(spec, files, tables)) {
    object.model.name = model.name;
    pieces.push_back(std::move(object.model));
  }
  CheckSize(model, pieces);
  return pieces;
}

}  // namespace

RailVehicleMeasures MeasuresOf(const ObjectType& type) {
  Check(IsRailVehicle(type), "the type is a rail vehicle");
  const auto& [length_m, width_m, height_m] = type.model->size_m;
  return {.length_m = length_m,
          .pivot_distance_m = type.model->rail_vehicle->pivot_distance_m,
          .width_m = width_m,
          .height_m = height_m};
}

Model WholeOf(const Model& body, const Model& bogie, double pivot_distance_m) {
  Model whole = body;
  for (const double end : {-1.0, 1.0}) {
    AppendModel(bogie,
                MakeTransform(Eigen::Matrix3d::Identity(), {end * pivot_distance_m / 2.0, 0, 0}),
                whole);
  }
  return whole;
}

void CheckNamesOfModel(const ObjectType& type,
                       const LabelTable& labels,
                       const MaterialLibrary& materials) {
  if (!type.model) return;
  SurfaceFinder finder(labels, materials);
  static_cast<void>(finder.LabelNamed(type.model->label));
  if (type.model->material) static_cast<void>(finder.MaterialNamed(*type.model->material));
  for (const MeshPartSpec& part : type.model->parts) {
    if (part.material) static_cast<void>(finder.MaterialNamed(*part.material));
    if (part.label) static_cast<void>(finder.LabelNamed(*part.label));
  }
  finder.ThrowIfAnyIsMissing("type");
}

std::vector<Model> MakeTableModel(const ObjectType& type,
                                  std::uint16_t otherwise,
                                  const LabelTable& labels,
                                  const MaterialLibrary& materials) {
  CheckNamesOfModel(type, labels, materials);
  const ModelSpec& model = *type.model;
  SurfaceFinder finder(labels, materials);
  const bool is_checked_only = !finder.has_tables();
  const LabelTable none;
  const MeshTables tables{{model.material ? finder.MaterialNamed(*model.material) : otherwise,
                           finder.LabelNamed(model.label)},
                          is_checked_only ? none : labels,
                          materials};
  if (!type.entry) return MakePieces(model, tables);
  try {
    return MakePieces(model, tables);
  } catch (const InputError& error) {
    ErrorList errors;
    AddAtPointer("/models/" + std::to_string(*type.entry), error, errors);
    errors.ThrowIfAny();
    throw;
  }
}

bool MayHaveMaterial(const ObjectType& type, std::string_view name) {
  if (type == ObjectType::kMesh) return true;  // Words in its names may stand for any material.
  if (!type.model) return false;
  const ModelSpec& model = *type.model;
  return model.material == name ||
         std::ranges::any_of(model.parts,
                             [&](const MeshPartSpec& part) { return part.material == name; }) ||
         !ShippedFile(model.file);
}

}  // namespace railcast
