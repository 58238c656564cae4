#include "core/rail/objects/object_models.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/base/text.h"
#include "core/mesh/mesh_import.h"
#include "core/rail/model_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

[[noreturn]] void Fail(const std::string& line) {
  throw InputError(line);
}

/// Length, width, height.
Vector3 RequiredSize(const ObjectSpec& spec) {
  if (!spec.size_m) Fail("size_m: required for type \"" + std::string(NameOf(spec.type)) + "\"");
  Vector3 size_m((*spec.size_m)[0], (*spec.size_m)[1], (*spec.size_m)[2]);
  if (!(size_m.array() > 0.0).all() || !size_m.allFinite()) {
    Fail("size_m: must be > 0 (got " + NumberText(size_m.x()) + ", " + NumberText(size_m.y()) +
         ", " + NumberText(size_m.z()) + ")");
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
    Fail("size_m: a pole must have one diameter (got " + NumberText(size_m.x()) + " and " +
         NumberText(size_m.y()) + ")");
  }
  constexpr int kSides = 16;
  const std::array<Vector3, 2> axis = {Vector3::Zero(), Vector3(0, 0, size_m.z())};
  return MakeTube(axis, 0.5 * size_m.x(), kSides);
}

MeshUnits UnitsOf(const ObjectSpec& spec) {
  MeshUnits units{.unit_m = spec.unit_m, .y_up = std::nullopt};
  if (spec.up) units.y_up = *spec.up == UpAxis::kY;
  return units;
}

Mesh MakeFromFile(const ObjectSpec& spec) {
  if (!spec.file) Fail("file: required for type \"mesh\"");
  const ImportedMesh imported = WithinMemory([&] { return ReadingText(*spec.file); },
                                             [&] { return ReadMesh(*spec.file, UnitsOf(spec)); });
  Mesh mesh;
  for (const NamedMesh& part : imported.parts) mesh.Append(part.mesh);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex.cast<double>());
  const Vector3 foot_m(box.center().x(), box.center().y(), box.min().z());
  Vector3 scale = Vector3::Ones();
  if (spec.size_m) {
    const Vector3 size_m = RequiredSize(spec);
    if (!(box.sizes().array() > 0.0).all()) {
      Fail("size_m: cannot stretch a mesh that is flat");
    }
    scale = size_m.cwiseQuotient(box.sizes());
  }
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    vertex = scale.cwiseProduct(vertex.cast<double>() - foot_m).cast<float>();
  }
  return mesh;
}

Model MakeWagon(const ObjectSpec& spec, const RailSurfaces& surfaces) {
  if (spec.size_m) Fail("size_m: a wagon has its own");
  if (spec.type == ObjectType::kOpenWagon) return MakeOpenWagon(surfaces);
  if (spec.type == ObjectType::kFlatWagon) return MakeFlatWagon(surfaces);
  return MakeTankWagon(surfaces);
}

/// Default surface of a type; for wagons and persons only its label is used.
SurfaceClass DefaultSurface(ObjectType type, const RailSurfaces& surfaces) {
  switch (type) {
    case ObjectType::kPole:
      return surfaces.pole;
    case ObjectType::kPerson:
      return surfaces.clothing;
    case ObjectType::kOpenWagon:
    case ObjectType::kFlatWagon:
    case ObjectType::kTankWagon:
      return surfaces.wagon_body;
    case ObjectType::kBox:
    case ObjectType::kMesh:
      break;
  }
  return surfaces.box;
}

Model MakeByType(const ObjectSpec& spec, const RailSurfaces& surfaces) {
  if (IsWagon(spec.type)) return MakeWagon(spec, surfaces);
  if (spec.type == ObjectType::kPerson) {
    return MakePerson(surfaces, spec.size_m ? RequiredSize(spec).z() : kPersonHeight_m);
  }
  Model model{.name = std::string(NameOf(spec.type)), .parts = {}};
  MeshOf(DefaultSurface(spec.type, surfaces), model) =
      spec.type == ObjectType::kPole   ? MakePole(spec)
      : spec.type == ObjectType::kMesh ? MakeFromFile(spec)
                                       : MakeStandingBox(RequiredSize(spec));
  return model;
}

std::uint16_t MaterialOf(const ObjectSpec& spec, const MaterialLibrary& materials) {
  const std::vector<Material>& all = materials.materials();
  const auto it = std::find_if(all.begin(), all.end(), [&](const Material& material) {
    return material.name == *spec.material;
  });
  if (it == all.end()) {
    Fail("material: must be in the material library (got \"" + *spec.material + "\")");
  }
  return static_cast<std::uint16_t>(it - all.begin());
}

}  // namespace

std::shared_ptr<const Model> MakeObjectModel(const ObjectSpec& spec,
                                             const RailSurfaces& surfaces,
                                             const LabelTable& labels,
                                             const MaterialLibrary& materials) {
  Model model = MakeByType(spec, surfaces);
  for (Part& part : model.parts) {
    if (spec.label) part.label = ObjectLabel(spec, surfaces, labels);
    if (spec.material) part.material = MaterialOf(spec, materials);
  }
  return std::make_shared<const Model>(std::move(model));
}

std::shared_ptr<const Model> ObjectModels::Of(const ObjectSpec& spec) {
  const Shape shape{spec.type,   spec.size_m, spec.file,    spec.up,
                    spec.unit_m, spec.label,  spec.material};
  auto found = models_.find(shape);
  if (found == models_.end()) {
    found = models_.emplace(shape, MakeObjectModel(spec, surfaces_, labels_, materials_)).first;
  }
  return found->second;
}

std::uint32_t ObjectLabel(const ObjectSpec& spec,
                          const RailSurfaces& surfaces,
                          const LabelTable& labels) {
  const std::uint32_t of_type = DefaultSurface(spec.type, surfaces).label;
  if (!spec.label) return of_type;
  const Label* label = labels.Find(*spec.label);
  if (label == nullptr) {
    Fail("label: must be in the label table (got \"" + *spec.label + "\")");
  }
  return label->id;
}

}  // namespace railcast
