#include "core/rail/objects/object_models.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/objects/mesh_object.h"
#include "core/rail/objects/object_surfaces.h"
#include "core/scene/shapes.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {
namespace {

Vector3 FootOf(const Model& model) {
  const Eigen::AlignedBox3d bounds_m = model.Bounds();
  return {bounds_m.center().x(), bounds_m.center().y(), bounds_m.min().z()};
}

/// Turns a model about its x axis, to the right, and then about its y axis, forwards, and moves it
/// so that the middle of its new bounding box in plan and its new lowest point are where they were
/// before. Angles in degrees, as ObjectSpec::roll_deg and pitch_deg.
void Tilt(double roll_deg, double pitch_deg, Model& model) {
  if (roll_deg == 0.0 && pitch_deg == 0.0) return;
  if (model.Bounds().isEmpty()) return;
  const auto transform = [&](const Transform& to_from_model) {
    for (Part& part : model.parts) {
      for (Eigen::Vector3f& vertex : part.mesh.vertices) {
        vertex = (to_from_model * vertex.cast<double>()).cast<float>();
      }
    }
  };
  const Vector3 foot_m = FootOf(model);
  transform(MakeTransform(
      RotationFromYawPitchRoll(0.0, RadFromDeg(pitch_deg), RadFromDeg(roll_deg)), Vector3::Zero()));
  transform(Transform(Eigen::Translation3d(foot_m - FootOf(model))));
}

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

Model MakeOfTable(const ObjectSpec& spec,
                  const RailSurfaces& surfaces,
                  const LabelTable& labels,
                  const MaterialLibrary& materials) {
  if (spec.size_m) Fail("size_m: type \"" + std::string(NameOf(spec.type)) + "\" has its own");
  std::vector<Model> pieces = MakeTableModel(spec.type, surfaces.box.material, labels, materials);
  if (!IsRailVehicle(spec.type)) return std::move(pieces.front());
  return WholeOf(pieces.front(), pieces.back(), MeasuresOf(spec.type).pivot_distance_m);
}

Model MakeShape(const ObjectSpec& spec,
                const RailSurfaces& surfaces,
                const LabelTable& labels,
                const MaterialLibrary& materials) {
  if (spec.type == ObjectType::kPerson) {
    const PersonBuild build = PersonBuildOf(spec);
    return MakePerson(FindPersonSurfaces(build.look, labels, materials), build);
  }
  Model model{.name = std::string(NameOf(spec.type)), .parts = {}};
  const bool is_pole = spec.type == ObjectType::kPole;
  MeshOf(is_pole ? surfaces.pole : surfaces.box, model) =
      is_pole ? MakePole(spec) : MakeStandingBox(RequiredSize(spec));
  return model;
}

std::uint16_t MaterialOf(const ObjectSpec& spec, const MaterialLibrary& materials) {
  const auto index = IndexOfMaterial(materials, *spec.material);
  if (!index) Fail("material: must be in the material library (got \"" + *spec.material + "\")");
  return *index;
}

/// The highest speed of a motion; 0 if it stands.
double HighestSpeed_mps(const MotionSpec& motion) {
  double highest_mps = 0.0;
  if (motion.path) {
    highest_mps = motion.path->speed_mps;
    for (const PathPoint& point : motion.path->points) {
      highest_mps = std::max(highest_mps, point.speed_mps.value_or(0.0));
    }
  }
  for (const SpeedPoint& point : motion.profile) {
    highest_mps = std::max(highest_mps, point.speed_mps);
  }
  return highest_mps;
}

/// Gives the model the label and the material of the spec, if it has any.
void Repaint(const ObjectSpec& spec,
             const RailSurfaces& surfaces,
             const LabelTable& labels,
             const MaterialLibrary& materials,
             Model& model) {
  for (Part& part : model.parts) {
    if (spec.label) part.label = ObjectLabel(spec, surfaces, labels);
    if (spec.material) part.material = MaterialOf(spec, materials);
  }
}

}  // namespace

PersonBuild PersonBuildOf(const ObjectSpec& spec) {
  PersonBuild build{.look = spec.person.value_or(PersonSpec())};
  build.height_m = spec.size_m ? RequiredSize(spec).z() : StandardHeight_m(build.look.physique);
  const double speed_mps = spec.motion ? HighestSpeed_mps(*spec.motion) : 0.0;
  build.steady_speed_mps = speed_mps > 0.0 ? speed_mps : NaturalPace_mps(build.height_m);
  return build;
}

bool WalksAbout(const ObjectSpec& spec) {
  return spec.type == ObjectType::kPerson && spec.roll_deg == 0.0 && spec.pitch_deg == 0.0 &&
         spec.motion && HighestSpeed_mps(*spec.motion) > 0.0 &&
         PersonBuildOf(spec).look.posture == Posture::kWalking;
}

std::shared_ptr<const Model> MakeObjectModel(const ObjectSpec& spec,
                                             const RailSurfaces& surfaces,
                                             const LabelTable& labels,
                                             const MaterialLibrary& materials) {
  Model model;
  if (spec.type == ObjectType::kMesh) {
    const SurfaceClass surface = SurfaceOfObject(spec, surfaces, labels, materials);
    model = MakeMeshObject(spec, {surface, labels, materials}).model;
  } else {
    model = spec.type.model ? MakeOfTable(spec, surfaces, labels, materials)
                            : MakeShape(spec, surfaces, labels, materials);
    Repaint(spec, surfaces, labels, materials, model);
  }
  Tilt(spec.roll_deg, spec.pitch_deg, model);
  return std::make_shared<const Model>(std::move(model));
}

ObjectModels::Shape ObjectModels::ShapeOf(const ObjectSpec& spec) {
  std::optional<PersonKey> person;
  if (spec.type == ObjectType::kPerson) {
    const PersonBuild build = PersonBuildOf(spec);
    const PersonSpec& look = build.look;
    person = {look.posture, look.physique, look.clothing, look.luggage, build.steady_speed_mps};
  }
  PartsKey parts;
  for (const MeshPartSpec& part : spec.parts)
    parts.emplace_back(part.of, part.material, part.label);
  return {std::string(NameOf(spec.type)),
          spec.size_m,
          spec.file,
          spec.up,
          spec.unit_m,
          spec.label,
          spec.material,
          spec.roll_deg,
          spec.pitch_deg,
          person,
          spec.origin,
          spec.tolerance_mm,
          parts};
}

ObjectModels::Pieces ObjectModels::PiecesOf(const ObjectSpec& spec,
                                            const std::function<std::vector<Model>()>& make) {
  const Shape shape = ShapeOf(spec);
  const auto found = pieces_.find(shape);
  if (found != pieces_.end()) return found->second;
  Pieces pieces;
  for (Model& piece : make()) {
    Repaint(spec, surfaces_, labels_, materials_, piece);
    pieces.push_back(std::make_shared<const Model>(std::move(piece)));
  }
  return pieces_.emplace(shape, std::move(pieces)).first->second;
}

ObjectModels::Pieces ObjectModels::VehiclePiecesOf(const ObjectSpec& spec) {
  Pieces pieces = PiecesOf(
      spec, [&] { return MakeTableModel(spec.type, surfaces_.box.material, labels_, materials_); });
  pieces.push_back(pieces.back());
  return pieces;
}

ObjectModels::Pieces ObjectModels::WalkingPiecesOf(const ObjectSpec& spec) {
  if (!WalksAbout(spec)) return {};
  return PiecesOf(spec, [&] {
    const PersonBuild build = PersonBuildOf(spec);
    return MakePersonPieces(FindPersonSurfaces(build.look, labels_, materials_), build);
  });
}

std::shared_ptr<const Model> ObjectModels::Of(const ObjectSpec& spec) {
  const Shape shape = ShapeOf(spec);
  auto found = models_.find(shape);
  if (found == models_.end()) {
    found = models_.emplace(shape, MakeObjectModel(spec, surfaces_, labels_, materials_)).first;
  }
  return found->second;
}

void GiveLimbs(const ObjectSpec& spec, ObjectModels& models, SceneObject& object) {
  if (!WalksAbout(spec)) return;
  object.pieces = models.WalkingPiecesOf(spec);
  object.pose_step_ns = WalkingPerson::kPoseStep_ns;
}

std::uint32_t ObjectLabel(const ObjectSpec& spec,
                          const RailSurfaces& surfaces,
                          const LabelTable& labels) {
  if (!spec.label && !spec.type.model && spec.type != ObjectType::kPerson) {
    return (spec.type == ObjectType::kPole ? surfaces.pole : surfaces.box).label;
  }
  if (!spec.label) {
    // Where the table could not be read, or lacks the name, the model says so.
    const Label* of_type = labels.Find(spec.type.model ? spec.type.model->label : "person");
    return of_type == nullptr ? 0 : of_type->id;
  }
  const Label* label = labels.Find(*spec.label);
  if (label == nullptr) {
    Fail("label: must be in the label table (got \"" + *spec.label + "\")");
  }
  return label->id;
}

SurfaceClass SurfaceOfObject(const ObjectSpec& spec,
                             const RailSurfaces& surfaces,
                             const LabelTable& labels,
                             const MaterialLibrary& materials) {
  const SurfaceClass& of_type = spec.type == ObjectType::kPole ? surfaces.pole : surfaces.box;
  return {.material = spec.material ? MaterialOf(spec, materials) : of_type.material,
          .label = ObjectLabel(spec, surfaces, labels)};
}

}  // namespace railcast
