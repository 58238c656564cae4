#include "core/rail/objects/person.h"

#include <cmath>
#include <limits>
#include <utility>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/objects/person_body.h"
#include "core/rail/objects/person_luggage.h"
#include "core/rail/objects/person_shape.h"

namespace railcast {
namespace {

bool WearsHelmet(const PersonSpec& look) {
  return look.clothing == Clothing::kHiVis;
}

BodyMeasures DressedBody(const PersonBuild& build) {
  const PersonSpec& look = build.look;
  return MeasuresOf(look.physique, WearsHelmet(look) ? build.height_m / HelmetHeight(look.physique)
                                                     : build.height_m);
}

PersonDress DressOf(const PersonSpec& look, const PersonSurfaces& surfaces) {
  PersonDress dress{.skin = surfaces.skin,
                    .hair = surfaces.clothing,
                    .sleeves = surfaces.clothing,
                    .torso = surfaces.clothing,
                    .legs = surfaces.clothing,
                    .shoes = surfaces.clothing,
                    .band = {},
                    .helmet = {}};
  if (look.clothing == Clothing::kHiVis) {
    dress.torso = surfaces.hi_vis_fabric;
    dress.legs = surfaces.hi_vis_fabric;
    dress.band = surfaces.hi_vis_band;
    dress.helmet = surfaces.helmet;
    dress.has_bands = true;
    dress.has_helmet = true;
  }
  return dress;
}

void AppendBone(const Model& other, const Transform& model_from_other, Model& model) {
  for (const Part& part : other.parts) {
    MeshOf({part.material, part.label}, model).Append(part.mesh, model_from_other);
  }
}

Model Assembled(const PersonBones& bones, const PersonPose& pose) {
  Model person{.name = "person", .parts = {}};
  AppendBone(bones.pelvis, pose.pelvis, person);
  AppendBone(bones.chest, pose.chest, person);
  AppendBone(bones.head, pose.head, person);
  for (const PersonPose::Limbs& limbs : pose.sides) {
    AppendBone(bones.limbs.upper_arm, limbs.upper_arm, person);
    AppendBone(bones.limbs.forearm, limbs.forearm, person);
    AppendBone(bones.limbs.thigh, limbs.thigh, person);
    AppendBone(bones.limbs.shank, limbs.shank, person);
    AppendBone(bones.limbs.foot, limbs.foot, person);
  }
  return person;
}

/// Scales a model about its origin after moving it by `shift_m`.
void MoveAndScale(const Vector3& shift_m, double scale, Model& model) {
  for (Part& part : model.parts) {
    for (Eigen::Vector3f& vertex : part.mesh.vertices) {
      vertex = (scale * (vertex.cast<double>() + shift_m)).cast<float>();
    }
  }
}

void Hold(const Handholds& holds, const BodyMeasures& body, PersonPose& pose) {
  for (std::size_t side = 0; side < 2; ++side) {
    if (!holds[side]) continue;
    const Vector3 elbow(-0.6, 0.6 * kSideSigns[side], -0.8);
    ReachFor(body, side, *holds[side], elbow, pose);
  }
}

}  // namespace

double StandardHeight_m(Physique physique) {
  switch (physique) {
    case Physique::kWoman:
      return 1.65;
    case Physique::kChild:
      return 1.20;
    case Physique::kMan:
      break;
  }
  return kPersonHeight_m;
}

double NaturalPace_mps(double height_m) {
  return 1.3 * std::sqrt(height_m / kPersonHeight_m);
}

Model MakePerson(const PersonSurfaces& surfaces, const PersonBuild& build) {
  const PersonSpec& look = build.look;
  const BodyMeasures body = DressedBody(build);
  const bool walks = look.posture == Posture::kWalking;
  const bool is_upright = walks || look.posture == Posture::kStanding;
  PersonPose pose =
      walks ? WalkingGait(body, build.steady_speed_mps).WidestPose() : PoseOf(look.posture, body);
  if (is_upright) Hold(HandholdsOf(look, body), body, pose);
  const PersonBones bones = MakePersonBones(body, look.physique, DressOf(look, surfaces));
  Model person = Assembled(bones, pose);
  const Eigen::AlignedBox3d box = person.Bounds();
  const Vector3 middle_m = is_upright ? Vector3::Zero() : Vector3(box.center());
  MoveAndScale(Vector3(-middle_m.x(), 0.0, -box.min().z()), 1.0, person);
  AddLuggage(look, body, surfaces, person);
  if (walks) MoveAndScale(Vector3::Zero(), build.height_m / box.sizes().z(), person);
  return person;
}

std::vector<Model> MakePersonPieces(const PersonSurfaces& surfaces, const PersonBuild& build) {
  const BodyMeasures body = DressedBody(build);
  const PersonBones bones =
      MakePersonBones(body, build.look.physique, DressOf(build.look, surfaces));
  // The trunk's bones do not move against each other.
  const PersonPose pose = StandingPose(body);
  Model trunk = bones.pelvis;
  AppendBone(bones.chest, pose.pelvis.inverse() * pose.chest, trunk);
  AppendBone(bones.head, pose.pelvis.inverse() * pose.head, trunk);
  std::vector<Model> pieces = {std::move(trunk)};
  const PersonBones::Limbs& limbs = bones.limbs;
  for (std::size_t side = 0; side < 2; ++side) {
    pieces.insert(pieces.end(),
                  {limbs.upper_arm, limbs.forearm, limbs.thigh, limbs.shank, limbs.foot});
  }
  if (build.look.luggage != Luggage::kNone) {
    AddLuggage(build.look, body, surfaces, pieces.emplace_back());
  }
  for (Model& piece : pieces) piece.name = "person";
  return pieces;
}

WalkingPerson::WalkingPerson(const PersonBuild& build)
    : look_(build.look), body_(DressedBody(build)), gait_(body_, build.steady_speed_mps) {}

std::vector<Transform> WalkingPerson::ObjectFromPieces(double distance_m, double speed_mps) const {
  PersonPose pose = gait_.PoseAt(distance_m, speed_mps);
  Hold(HandholdsOf(look_, body_), body_, pose);
  std::vector<Transform> pieces = {pose.pelvis};
  for (const PersonPose::Limbs& limbs : pose.sides) {
    pieces.insert(pieces.end(),
                  {limbs.upper_arm, limbs.forearm, limbs.thigh, limbs.shank, limbs.foot});
  }
  if (look_.luggage != Luggage::kNone) pieces.push_back(Transform::Identity());
  return pieces;
}

}  // namespace railcast
