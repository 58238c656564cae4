#include "core/rail/objects/object_models.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "core/rail/model_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

/// A horizontal, elliptical cross-section of the body.
struct Section {
  double z_m{};
  double half_depth_m{};  ///< Along x.
  double half_width_m{};  ///< Along y.
  double x_m{};           ///< Of its centre.
};

/// A closed body lofted through sections from the bottom up.
Mesh MakeLoft(const std::vector<Section>& sections, int num_sides) {
  std::vector<Eigen::Vector2d> profile;
  for (const Section& section : sections) {
    profile.emplace_back(section.z_m, section.half_depth_m > 0.0 ? 1.0 : 0.0);
  }
  // The lathe's rings follow the profile: reshape each to its section and turn the axis upright.
  Mesh body = MakeLathe(profile, num_sides);
  std::size_t vertex = 0;
  for (const Section& section : sections) {
    const int count = section.half_depth_m > 0.0 ? num_sides : 1;
    for (int i = 0; i < count; ++i, ++vertex) {
      const double angle_rad = 2.0 * std::numbers::pi * i / num_sides;
      body.vertices[vertex] = Vector3(section.x_m + section.half_depth_m * std::cos(angle_rad),
                                      section.half_width_m * std::sin(angle_rad), section.z_m)
                                  .cast<float>();
    }
  }
  return body;
}

Mesh MakeTorso() {
  return MakeLoft({{0.76, 0.0, 0.0, 0.0},
                   {0.79, 0.10, 0.13, 0.0},
                   {0.90, 0.130, 0.180, -0.01},
                   {0.98, 0.122, 0.172, 0.0},
                   {1.08, 0.110, 0.155, 0.01},
                   {1.22, 0.120, 0.170, 0.01},
                   {1.34, 0.125, 0.195, 0.0},
                   {1.41, 0.105, 0.205, -0.01},
                   {1.45, 0.080, 0.150, -0.01},
                   {1.47, 0.070, 0.100, -0.01},
                   {1.50, 0.060, 0.065, 0.0}},
                  18);
}

Mesh MakeHead() {
  return MakeLoft({{1.46, 0.055, 0.055, 0.0},
                   {1.535, 0.055, 0.052, 0.01},
                   {1.545, 0.078, 0.058, 0.03},
                   {1.59, 0.092, 0.068, 0.025},
                   {1.64, 0.098, 0.076, 0.015},
                   {1.69, 0.093, 0.074, 0.01},
                   {1.728, 0.066, 0.055, 0.005},
                   {1.745, 0.033, 0.028, 0.0},
                   {kPersonHeight_m, 0.0, 0.0, 0.0}},
                  14);
}

/// A limb from joint to joint, with a rounded tip.
Mesh MakeLimb(const std::vector<Vector3>& joints, const std::vector<double>& radii_m) {
  Mesh limb = MakeTube(joints, radii_m, 10);
  limb.Append(MakeEllipsoid(joints.front(), Vector3::Constant(radii_m.front()), 10));
  return limb;
}

/// A shoe with its heel below the ankle, rotated about y by the foot's pitch.
Mesh MakeShoe(const Vector3& ankle_m, double pitch_rad) {
  Mesh shoe = MakeEllipsoid({0.065, 0.0, -0.045}, {0.145, 0.05, 0.045}, 12);
  shoe.Append(MakeEllipsoid({-0.02, 0.0, -0.02}, {0.06, 0.045, 0.07}, 10));
  Mesh placed;
  placed.Append(shoe, MakeTransform(RotationFromYawPitchRoll(0, pitch_rad, 0), ankle_m));
  return placed;
}

/// Adds the limbs of one side: `side` 1 is the left. `stride` 1 puts the leg forward and the arm
/// back, -1 the opposite.
void AddSide(double side, double stride, const RailSurfaces& surfaces, Model& person) {
  Mesh clothes;
  const double hip_y_m = side * 0.09;
  const bool leads = stride > 0.0;
  const Vector3 ankle = leads ? Vector3(0.24, hip_y_m, 0.09) : Vector3(-0.30, hip_y_m, 0.145);
  const Vector3 knee = leads ? Vector3(0.15, hip_y_m, 0.48) : Vector3(-0.06, hip_y_m, 0.475);
  const Vector3 hip(0.0, hip_y_m, 0.87);
  clothes.Append(MakeLimb({hip, 0.5 * (hip + knee), knee, 0.65 * knee + 0.35 * ankle, ankle},
                          {0.090, 0.085, 0.062, 0.060, 0.045}));
  clothes.Append(MakeShoe(ankle, leads ? -0.05 : 0.42));

  const double swing = -0.16 * stride;
  const Vector3 shoulder(-0.01, side * 0.195, 1.375);
  const Vector3 elbow(-0.03 + 0.45 * swing, side * 0.245, 1.13);
  const Vector3 wrist(0.05 + 1.1 * swing, side * 0.265, 0.90);
  clothes.Append(
      MakeLimb({shoulder, 0.5 * (shoulder + elbow), elbow, wrist}, {0.060, 0.056, 0.047, 0.036}));
  MeshOf(surfaces.clothing, person).Append(clothes);
  const Vector3 palm = wrist + 0.07 * (wrist - elbow).normalized();
  MeshOf(surfaces.skin, person).Append(MakeEllipsoid(palm, {0.042, 0.026, 0.085}, 8));
}

}  // namespace

Model MakePerson(const RailSurfaces& surfaces, double height_m) {
  Model person{.name = "person", .parts = {}};
  MeshOf(surfaces.clothing, person).Append(MakeTorso());
  MeshOf(surfaces.skin, person).Append(MakeHead());
  AddSide(1.0, 1.0, surfaces, person);
  AddSide(-1.0, -1.0, surfaces, person);

  // The soles of the shoes define the ground.
  const double ground_m = person.Bounds().min().z();
  const double scale = height_m / (kPersonHeight_m - ground_m);
  for (Part& part : person.parts) {
    for (Eigen::Vector3f& vertex : part.mesh.vertices) {
      vertex = (scale * (vertex.cast<double>() - Vector3(0, 0, ground_m))).cast<float>();
    }
  }
  return person;
}

}  // namespace railcast
