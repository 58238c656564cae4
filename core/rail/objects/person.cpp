#include "core/rail/objects/person.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh/mesh_import.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/objects/loft.h"
#include "core/rail/objects/person_body.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

// Suitcase: of its frame, the origin is on the axle of its wheels, z points along its handle, and
// the case lies at x < 0.
constexpr double kSuitcaseWheel_m = 0.035;
constexpr double kHandle_m = 1.05;  ///< From the axle to the grip, drawn out.

double PushHeight_m(const BodyMeasures& body) {
  return 0.585 * body.height_m;
}

Vector3 PulledGrip(const BodyMeasures& body) {
  return {-0.09 * body.height_m, -0.155 * body.height_m, 0.42 * body.height_m};
}

Vector3 PramGrip(const BodyMeasures& body, double side) {
  return {0.22 * body.height_m, 0.12 * side, PushHeight_m(body)};
}

/// Where the suitcase is: leaning so that its grip is in the hand, or upright.
Transform PersonFromSuitcase(const PersonSpec& look, const BodyMeasures& body) {
  if (look.posture != Posture::kWalking) {
    return MakeTransform(Eigen::Matrix3d::Identity(),
                         Vector3(0.10, -0.34 * body.height_m, kSuitcaseWheel_m));
  }
  const Vector3 grip = PulledGrip(body);
  const double lean_rad = std::acos((grip.z() - kSuitcaseWheel_m) / kHandle_m);
  Transform placed = Pitched(lean_rad);
  placed.translation() =
      Vector3(grip.x() - kHandle_m * std::sin(lean_rad), grip.y(), kSuitcaseWheel_m);
  return placed;
}

Mesh MakeRod(const std::vector<Vector3>& line, double radius_m) {
  return MakeTube(line, radius_m, 8);
}

/// A wheel or axle about a line along y.
Mesh MakeLuggageWheel(const Vector3& centre_m,
                      double radius_m,
                      double half_width_m,
                      int num_sides) {
  const std::vector<Vector3> axis = {centre_m - Vector3(0.0, half_width_m, 0.0),
                                     centre_m + Vector3(0.0, half_width_m, 0.0)};
  return MakeTube(axis, radius_m, num_sides);
}

void AddSuitcase(const PersonSpec& look,
                 const BodyMeasures& body,
                 const PersonSurfaces& surfaces,
                 Model& model) {
  Model suitcase;
  const double z_m = 0.5 * kSuitcaseWheel_m;
  const auto section = [&](double height_m, double inset_m) {
    return LoftSection{.z_m = z_m + height_m,
                       .front_m = 0.15 - inset_m,
                       .back_m = 0.15 - inset_m,
                       .half_width_m = 0.225 - inset_m,
                       .x_m = -0.15,
                       .exponent = 7.0};
  };
  const std::vector<LoftSection> shell = {section(0.0, 0.03),    section(0.008, 0.012),
                                          section(0.03, 0.0),    section(0.72, 0.0),
                                          section(0.742, 0.012), section(0.75, 0.03)};
  AddLoft(shell, 24, surfaces.suitcase, suitcase);
  const bool is_pulled = look.posture == Posture::kWalking;
  const double grip_z_m = is_pulled ? kHandle_m : z_m + 0.80;
  Mesh& frame = MeshOf(surfaces.frame, suitcase);
  const std::vector<Vector3> bow = {
      {-0.02, -0.12, 0.6},     {-0.02, -0.12, grip_z_m - 0.02}, {-0.01, -0.10, grip_z_m},
      {-0.01, 0.10, grip_z_m}, {-0.02, 0.12, grip_z_m - 0.02},  {-0.02, 0.12, 0.6}};
  frame.Append(MakeRod(bow, 0.011));
  for (const double side : {-1.0, 1.0}) {
    MeshOf(surfaces.tyre, suitcase)
        .Append(MakeLuggageWheel({0.0, side * 0.19, 0.0}, kSuitcaseWheel_m, 0.02, 12));
  }
  AppendModel(suitcase, PersonFromSuitcase(look, body), model);
}

void AddCarrycot(const Vector3& middle_m, const PersonSurfaces& surfaces, Model& model) {
  const auto section = [&](double z_m, double half_length_m, double half_width_m) {
    return LoftSection{.z_m = z_m,
                       .front_m = half_length_m,
                       .back_m = half_length_m,
                       .half_width_m = half_width_m,
                       .x_m = 0.0,
                       .exponent = 3.5};
  };
  const std::vector<LoftSection> cot = {section(-0.16, 0.26, 0.12), section(-0.14, 0.32, 0.16),
                                        section(0.00, 0.37, 0.19), section(0.12, 0.40, 0.20),
                                        section(0.14, 0.39, 0.19)};
  const Transform placed = MakeTransform(Eigen::Matrix3d::Identity(), middle_m);
  AddLoft(cot, 24, surfaces.canvas, model, placed);
  // The hood shelters the child's head, which lies ahead so that it faces the one who pushes.
  MeshOf(surfaces.canvas, model)
      .Append(MakeEllipsoid(middle_m + Vector3(0.17, 0.0, 0.13), {0.23, 0.20, 0.28}, 16));
}

void AddPram(const BodyMeasures& body, const PersonSurfaces& surfaces, Model& model) {
  constexpr double kWheel_m = 0.14;
  constexpr double kHalfWidth_m = 0.22;
  const Vector3 grip = PramGrip(body, 0.0);
  const double rear_x_m = grip.x() + 0.30;
  const double front_x_m = rear_x_m + 0.62;
  Mesh frame;
  for (const double side : {-1.0, 1.0}) {
    const double y_m = side * kHalfWidth_m;
    frame.Append(MakeRod({{grip.x(), y_m, grip.z()}, {front_x_m, y_m, kWheel_m}}, 0.013));
    frame.Append(MakeRod({{rear_x_m, y_m, kWheel_m}, {front_x_m - 0.12, y_m, 0.62}}, 0.013));
  }
  for (const double x_m : {rear_x_m, front_x_m}) {
    frame.Append(MakeLuggageWheel({x_m, 0.0, kWheel_m}, 0.010, kHalfWidth_m + 0.04, 8));
  }
  frame.Append(MakeLuggageWheel(grip, 0.016, kHalfWidth_m + 0.02, 8));
  MeshOf(surfaces.frame, model).Append(frame);
  for (const double x_m : {rear_x_m, front_x_m}) {
    for (const double side : {-1.0, 1.0}) {
      MeshOf(surfaces.tyre, model)
          .Append(
              MakeLuggageWheel({x_m, side * (kHalfWidth_m + 0.02), kWheel_m}, kWheel_m, 0.02, 20));
    }
  }
  AddCarrycot({0.5 * (rear_x_m + front_x_m) + 0.05, 0.0, 0.72}, surfaces, model);
}

// Places on the bicycle of scenarios/models, which is upright beside the person.
const Vector3 kLeftGrip_m(0.21, 0.275, 1.06);
const Vector3 kSaddle_m(-0.36, 0.05, 0.985);

/// Where the middle of the bicycle is: so far to the right that its pedals clear the legs.
Vector3 BicyclePlace(const BodyMeasures& body) {
  return {0.085 * body.height_m, -(0.20 + 0.16 * body.height_m), 0.0};
}

void AddBicycle(const BodyMeasures& body, const PersonSurfaces& surfaces, Model& model) {
  const ImportedMesh bicycle = ReadMesh("railcast:bicycle.ply");
  const auto surface_of = [&](const std::string& part) {
    if (part == "tyre") return surfaces.tyre;
    if (part == "reflector") return surfaces.reflector;
    return part == "trim" ? surfaces.suitcase : surfaces.frame;
  };
  const Transform placed = MakeTransform(Eigen::Matrix3d::Identity(), BicyclePlace(body));
  for (const NamedMesh& part : bicycle.parts) {
    MeshOf(surface_of(part.material), model).Append(part.mesh, placed);
  }
}

/// What a person holds on to, in the person's frame (person.h): where the palms of the left and of
/// the right hand are. Absent: that hand is free.
using Handholds = std::array<std::optional<Vector3>, 2>;

Handholds HandholdsOf(const PersonSpec& look, const BodyMeasures& body) {
  switch (look.luggage) {
    case Luggage::kSuitcase:
      if (look.posture != Posture::kWalking) return {};
      return {std::nullopt, PulledGrip(body)};
    case Luggage::kPram:
      return {PramGrip(body, 1.0), PramGrip(body, -1.0)};
    case Luggage::kBicycle:
      return {BicyclePlace(body) + kLeftGrip_m, BicyclePlace(body) + kSaddle_m};
    case Luggage::kNone:
      break;
  }
  return {};
}

/// Adds what the person pulls or pushes, in the person's frame:
/// - suitcase: 0.75 x 0.45 x 0.30 m on two wheels; pulled behind by the right hand if the person
///   walks, otherwise upright beside it;
/// - pram: carrycot of 0.80 x 0.40 m with a hood on a folding frame, 1.1 m high, ahead;
/// - bicycle: pushed at the right by the left grip and the saddle.
void AddLuggage(const PersonSpec& look,
                const BodyMeasures& body,
                const PersonSurfaces& surfaces,
                Model& model) {
  switch (look.luggage) {
    case Luggage::kSuitcase:
      return AddSuitcase(look, body, surfaces, model);
    case Luggage::kPram:
      return AddPram(body, surfaces, model);
    case Luggage::kBicycle:
      return AddBicycle(body, surfaces, model);
    case Luggage::kNone:
      break;
  }
}

BodyMeasures DressedBody(const PersonBuild& build) {
  const PersonSpec& look = build.look;
  return MeasuresOf(look.physique, look.clothing == Clothing::kHiVis
                                       ? build.height_m / HelmetHeight(look.physique)
                                       : build.height_m);
}

PersonDress DressOf(const PersonSpec& look, const PersonSurfaces& surfaces) {
  const bool is_hi_vis = look.clothing == Clothing::kHiVis;
  return {.skin = surfaces.skin,
          .clothing = surfaces.clothing,
          .outer = is_hi_vis ? surfaces.hi_vis_fabric : surfaces.clothing,
          .band = surfaces.hi_vis_band,
          .helmet = surfaces.helmet,
          .is_hi_vis = is_hi_vis};
}

Model Assembled(const PersonBones& bones, const PersonPose& pose) {
  Model person{.name = "person", .parts = {}};
  AppendModel(bones.pelvis, pose.pelvis, person);
  AppendModel(bones.chest, pose.chest, person);
  AppendModel(bones.head, pose.head, person);
  for (const PersonPose::Limbs& limbs : pose.sides) {
    AppendModel(bones.limbs.upper_arm, limbs.upper_arm, person);
    AppendModel(bones.limbs.forearm, limbs.forearm, person);
    AppendModel(bones.limbs.thigh, limbs.thigh, person);
    AppendModel(bones.limbs.shank, limbs.shank, person);
    AppendModel(bones.limbs.foot, limbs.foot, person);
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
  AppendModel(bones.chest, pose.pelvis.inverse() * pose.chest, trunk);
  AppendModel(bones.head, pose.pelvis.inverse() * pose.head, trunk);
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
