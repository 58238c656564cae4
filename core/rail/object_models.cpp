#include "core/rail/object_models.h"

#include <array>
#include <string>

#include "core/base/error.h"
#include "core/rail/model_parts.h"
#include "core/rail/person.h"
#include "core/rail/rolling_stock.h"
#include "core/scene/obj_import.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

[[noreturn]] void Fail(const ObjectSpec& spec, const std::string& rule) {
  throw InputError("object \"" + spec.name + "\": " + rule);
}

/// Length, width, height.
Vector3 RequiredSize(const ObjectSpec& spec) {
  if (!spec.size_m) Fail(spec, "size_m: required for type \"" + spec.type + "\"");
  const Vector3 size_m((*spec.size_m)[0], (*spec.size_m)[1], (*spec.size_m)[2]);
  if (!(size_m.array() > 0.0).all() || !size_m.allFinite()) {
    Fail(spec, "size_m: must be > 0");
  }
  return size_m;
}

Mesh MakeStandingBox(const Vector3& size_m) {
  return MakeBox(Eigen::AlignedBox3d(Vector3(-0.5 * size_m.x(), -0.5 * size_m.y(), 0.0),
                                     Vector3(0.5 * size_m.x(), 0.5 * size_m.y(), size_m.z())));
}

Mesh MakePole(const ObjectSpec& spec) {
  const Vector3 size_m = RequiredSize(spec);
  if (size_m.x() != size_m.y()) {
    Fail(spec, "size_m: a pole must have one diameter (got " + std::to_string(size_m.x()) +
                   " and " + std::to_string(size_m.y()) + ")");
  }
  constexpr int kSides = 16;
  const std::array<Vector3, 2> axis = {Vector3::Zero(), Vector3(0, 0, size_m.z())};
  return MakeTube(axis, 0.5 * size_m.x(), kSides);
}

Mesh MakeFromFile(const ObjectSpec& spec) {
  if (!spec.file) Fail(spec, "file: required for type \"mesh\"");
  if (spec.up != "y" && spec.up != "z") {
    Fail(spec, "up: must be \"y\" or \"z\" (got \"" + spec.up + "\")");
  }
  Mesh mesh = ReadObj(*spec.file, spec.unit_m, spec.up == "y");
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex.cast<double>());
  const Vector3 foot_m(box.center().x(), box.center().y(), box.min().z());
  Vector3 scale = Vector3::Ones();
  if (spec.size_m) {
    const Vector3 size_m = RequiredSize(spec);
    if (!(box.sizes().array() > 0.0).all()) {
      Fail(spec, "size_m: cannot stretch a mesh that is flat");
    }
    scale = size_m.cwiseQuotient(box.sizes());
  }
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    vertex = scale.cwiseProduct(vertex.cast<double>() - foot_m).cast<float>();
  }
  return mesh;
}

Model MakeWagon(const ObjectSpec& spec, const RailSurfaces& surfaces) {
  if (spec.size_m) Fail(spec, "size_m: a wagon has its own");
  if (spec.type == "open_wagon") return MakeOpenWagon(surfaces);
  if (spec.type == "flat_wagon") return MakeFlatWagon(surfaces);
  return MakeTankWagon(surfaces);
}

/// What a type is by default; for wagons and persons only the label counts.
SurfaceClass DefaultSurface(const ObjectSpec& spec, const RailSurfaces& surfaces) {
  if (spec.type == "box" || spec.type == "mesh") return surfaces.box;
  if (spec.type == "pole") return surfaces.pole;
  if (spec.type == "person") return surfaces.clothing;
  if (spec.type == "open_wagon" || spec.type == "flat_wagon" || spec.type == "tank_wagon") {
    return surfaces.wagon_body;
  }
  Fail(spec, "type: must be box, pole, person, open_wagon, flat_wagon, tank_wagon or mesh (got \"" +
                 spec.type + "\")");
}

Model MakeByType(const ObjectSpec& spec, const RailSurfaces& surfaces) {
  const SurfaceClass surface = DefaultSurface(spec, surfaces);
  if (spec.type == "person") {
    return MakePerson(surfaces, spec.size_m ? RequiredSize(spec).z() : kPersonHeight_m);
  }
  Model model;
  if (spec.type == "box") {
    MeshOf(surface, model) = MakeStandingBox(RequiredSize(spec));
  } else if (spec.type == "pole") {
    MeshOf(surface, model) = MakePole(spec);
  } else if (spec.type == "mesh") {
    MeshOf(surface, model) = MakeFromFile(spec);
  } else {
    model = MakeWagon(spec, surfaces);
  }
  return model;
}

}  // namespace

std::shared_ptr<const Model> MakeObjectModel(const ObjectSpec& spec,
                                             const RailSurfaces& surfaces,
                                             const LabelTable& labels,
                                             const MaterialLibrary& materials) {
  Model model = MakeByType(spec, surfaces);
  model.name = spec.name;
  for (Part& part : model.parts) {
    if (spec.label) part.label = ObjectLabel(spec, surfaces, labels);
    if (spec.material) part.material = materials.Index(*spec.material);
  }
  return std::make_shared<const Model>(std::move(model));
}

std::uint32_t ObjectLabel(const ObjectSpec& spec,
                          const RailSurfaces& surfaces,
                          const LabelTable& labels) {
  const std::uint32_t of_type = DefaultSurface(spec, surfaces).label;
  if (!spec.label) return of_type;
  const Label* label = labels.Find(*spec.label);
  if (label == nullptr) {
    Fail(spec, "label: must be in the label table (got \"" + *spec.label + "\")");
  }
  return label->id;
}

}  // namespace railcast
