#include "core/rail/objects/animals.h"

#include <vector>

#include "core/base/error.h"
#include "core/rail/base/model_parts.h"
#include "core/rail/objects/lofted_body.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using Point2 = Eigen::Vector2d;
using Ovals = std::vector<OvalSection>;

constexpr int kTrunkSides = 16;
constexpr int kLimbSides = 10;

/// A leg from the trunk down to the fetlock, and its hoof or paw.
struct Leg {
  Ovals sections;
  Ovals foot;
  double top_y_m{};   ///< Of its axis at the trunk.
  double foot_y_m{};  ///< At the foot.
};

/// Adds both legs of a pair. `stagger_m` puts the left one forward and the right one back.
void AddLegs(const Leg& leg, double stagger_m, const AnimalSurfaces& surfaces, Model& animal) {
  for (const double side : kBothSides) {
    Ovals sections = leg.sections;
    Ovals foot = leg.foot;
    const double top_m = sections.front().z_m;
    const auto shift = [&](OvalSection& section) {
      section.x_m += 0.5 * side * stagger_m * (1.0 - section.z_m / top_m);
    };
    for (OvalSection& section : sections) shift(section);
    for (OvalSection& section : foot) shift(section);
    MeshOf(surfaces.coat, animal)
        .Append(
            MakeOvalBody(sections, {0.6 * side * leg.top_y_m, side * leg.foot_y_m}, kLimbSides));
    MeshOf(surfaces.horn, animal)
        .Append(MakeOvalBody(foot, {side * leg.foot_y_m, side * leg.foot_y_m}, 8));
  }
}

/// A flat, pointed ear from its root to its tip, `half_width_m` wide in the middle.
Mesh MakeEar(const Vector3& root_m, const Vector3& tip_m, const Vector3& across_m) {
  const Vector3 along = tip_m - root_m;
  const Vector3 thick_m = 0.18 * across_m.norm() * along.cross(across_m).normalized();
  std::vector<Rib> ribs;
  for (const Point2& share : {Point2(0.0, 0.55), Point2(0.3, 1.0), Point2(0.65, 0.75),
                              Point2(0.9, 0.25), Point2(1.0, 0.08)}) {
    const Vector3 middle_m = root_m + share.x() * along;
    ribs.push_back({middle_m + share.y() * across_m, middle_m + thick_m,
                    middle_m - share.y() * across_m, middle_m - thick_m});
  }
  return MakeLoftedBody(ribs);
}

/// A tapering, bent horn or tine.
Mesh MakeHorn(const std::vector<Vector3>& line, double foot_radius_m) {
  std::vector<double> radii_m;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(line.size() - 1);
    radii_m.push_back(foot_radius_m * (1.0 - 0.75 * t));
  }
  return MakeTube(line, radii_m, 6);
}

}  // namespace

Model MakeDeer(const AnimalSurfaces& surfaces) {
  Model deer{.name = "deer", .parts = {}};
  Mesh coat;
  const Ovals trunk = {{-0.43, 0.60, 0.07, 0.05},    {-0.38, 0.60, 0.115, 0.10},
                       {-0.28, 0.575, 0.145, 0.125}, {-0.12, 0.545, 0.135, 0.125},
                       {0.06, 0.525, 0.145, 0.125},  {0.22, 0.535, 0.16, 0.115},
                       {0.32, 0.555, 0.13, 0.095},   {0.38, 0.57, 0.08, 0.06}};
  coat.Append(MakeOvalBody(trunk, {0, 0}, kTrunkSides));
  const Ovals neck = {{0.24, 0.58, 0.10, 0.075},
                      {0.33, 0.67, 0.082, 0.062},
                      {0.40, 0.77, 0.066, 0.05},
                      {0.44, 0.86, 0.058, 0.045},
                      {0.46, 0.92, 0.05, 0.042}};
  coat.Append(MakeOvalBody(neck, {0, 0}, 12));
  const Ovals head = {{0.405, 0.945, 0.04, 0.038}, {0.45, 0.945, 0.062, 0.052},
                      {0.50, 0.93, 0.058, 0.05},   {0.55, 0.905, 0.042, 0.036},
                      {0.60, 0.88, 0.031, 0.027},  {0.635, 0.865, 0.026, 0.024}};
  coat.Append(MakeOvalBody(head, {0, 0}, 12));
  coat.Append(
      MakeOvalBody(Ovals{{-0.43, 0.63, 0.02, 0.02}, {-0.46, 0.60, 0.015, 0.015}}, {0, 0}, 6));
  for (const double side : kBothSides) {
    coat.Append(MakeEar({0.43, side * 0.045, 0.985}, {0.38, side * 0.152, 1.06},
                        {0.028, side * 0.018, 0.0}));
  }
  AddLegs({.sections = {{0.27, 0.52, 0.075, 0.05},
                        {0.265, 0.42, 0.048, 0.034},
                        {0.265, 0.33, 0.026, 0.022},
                        {0.27, 0.29, 0.025, 0.022},
                        {0.265, 0.20, 0.015, 0.013},
                        {0.262, 0.09, 0.014, 0.012},
                        {0.27, 0.06, 0.018, 0.014}},
           .foot = {{0.275, 0.05, 0.018, 0.015}, {0.292, 0.01, 0.022, 0.018}},
           .top_y_m = 0.075,
           .foot_y_m = 0.065},
          0.08, surfaces, deer);
  AddLegs({.sections = {{-0.32, 0.56, 0.12, 0.06},
                        {-0.31, 0.45, 0.085, 0.05},
                        {-0.34, 0.36, 0.042, 0.032},
                        {-0.385, 0.305, 0.026, 0.022},
                        {-0.375, 0.22, 0.018, 0.015},
                        {-0.362, 0.10, 0.016, 0.013},
                        {-0.352, 0.06, 0.019, 0.015}},
           .foot = {{-0.347, 0.05, 0.018, 0.015}, {-0.33, 0.01, 0.022, 0.018}},
           .top_y_m = 0.085,
           .foot_y_m = 0.07},
          -0.08, surfaces, deer);
  Mesh horn;
  horn.Append(MakeEllipsoid({0.645, 0.0, 0.868}, {0.014, 0.018, 0.016}, 8));  // Nose.
  for (const double side : kBothSides) {
    const Vector3 foot_m(0.445, side * 0.03, 0.99);
    const Vector3 fork_m(0.455, side * 0.055, 1.10);
    horn.Append(
        MakeHorn({foot_m, fork_m, {0.44, side * 0.075, 1.16}, {0.44, side * 0.07, 1.21}}, 0.012));
    horn.Append(MakeHorn({fork_m, {0.49, side * 0.065, 1.15}}, 0.008));
    horn.Append(MakeHorn({{0.445, side * 0.07, 1.15}, {0.405, side * 0.08, 1.19}}, 0.007));
  }
  MeshOf(surfaces.coat, deer).Append(coat);
  MeshOf(surfaces.horn, deer).Append(horn);
  StandOnOrigin(deer);
  return deer;
}

Model MakeDog(const AnimalSurfaces& surfaces) {
  Model dog{.name = "dog", .parts = {}};
  Mesh coat;
  const Ovals trunk = {{-0.36, 0.47, 0.07, 0.055},   {-0.30, 0.475, 0.115, 0.095},
                       {-0.18, 0.475, 0.115, 0.105}, {-0.04, 0.47, 0.125, 0.115},
                       {0.12, 0.465, 0.145, 0.12},   {0.24, 0.475, 0.15, 0.11},
                       {0.31, 0.485, 0.12, 0.09},    {0.35, 0.49, 0.08, 0.06}};
  coat.Append(MakeOvalBody(trunk, {0, 0}, kTrunkSides));
  const Ovals neck = {{0.25, 0.53, 0.095, 0.085},
                      {0.31, 0.62, 0.095, 0.08},
                      {0.39, 0.69, 0.08, 0.07},
                      {0.42, 0.73, 0.06, 0.06}};
  coat.Append(MakeOvalBody(neck, {0, 0}, 12));
  const Ovals head = {{0.36, 0.735, 0.05, 0.05},    {0.40, 0.74, 0.065, 0.066},
                      {0.455, 0.735, 0.062, 0.062}, {0.50, 0.715, 0.042, 0.04},
                      {0.55, 0.705, 0.034, 0.031},  {0.595, 0.70, 0.028, 0.026}};
  coat.Append(MakeOvalBody(head, {0, 0}, 12));
  const Ovals tail = {{-0.38, 0.50, 0.03, 0.025},
                      {-0.46, 0.42, 0.04, 0.035},
                      {-0.51, 0.32, 0.04, 0.035},
                      {-0.55, 0.24, 0.03, 0.025},
                      {-0.585, 0.21, 0.012, 0.012}};
  coat.Append(MakeOvalBody(tail, {0, 0}, 8));
  for (const double side : kBothSides) {
    coat.Append(MakeEar({0.385, side * 0.042, 0.785}, {0.40, side * 0.058, 0.885},
                        {0.014, side * 0.03, 0.0}));
  }
  AddLegs({.sections = {{0.245, 0.45, 0.08, 0.05},
                        {0.235, 0.35, 0.046, 0.036},
                        {0.24, 0.25, 0.030, 0.027},
                        {0.24, 0.17, 0.026, 0.024},
                        {0.245, 0.09, 0.022, 0.021},
                        {0.26, 0.05, 0.026, 0.026}},
           .foot = {{0.245, 0.025, 0.022, 0.028}, {0.295, 0.02, 0.016, 0.03}},
           .top_y_m = 0.085,
           .foot_y_m = 0.09},
          0.10, surfaces, dog);
  AddLegs({.sections = {{-0.27, 0.46, 0.12, 0.06},
                        {-0.25, 0.36, 0.085, 0.05},
                        {-0.29, 0.27, 0.048, 0.036},
                        {-0.36, 0.20, 0.030, 0.026},
                        {-0.365, 0.17, 0.026, 0.024},
                        {-0.355, 0.09, 0.021, 0.021},
                        {-0.345, 0.05, 0.024, 0.025}},
           .foot = {{-0.36, 0.025, 0.022, 0.027}, {-0.305, 0.02, 0.016, 0.029}},
           .top_y_m = 0.075,
           .foot_y_m = 0.085},
          -0.14, surfaces, dog);
  MeshOf(surfaces.horn, dog).Append(MakeEllipsoid({0.615, 0, 0.708}, {0.014, 0.018, 0.015}, 8));
  MeshOf(surfaces.coat, dog).Append(coat);
  StandOnOrigin(dog);
  return dog;
}

Model MakeCow(const AnimalSurfaces& surfaces) {
  Model cow{.name = "cow", .parts = {}};
  Mesh coat;
  const Ovals trunk = {
      {-0.98, 1.18, 0.16, 0.14}, {-0.90, 1.20, 0.22, 0.23}, {-0.70, 1.16, 0.28, 0.29},
      {-0.40, 1.02, 0.38, 0.33}, {-0.05, 0.98, 0.41, 0.35}, {0.30, 1.02, 0.40, 0.31},
      {0.55, 1.07, 0.375, 0.25}, {0.72, 1.08, 0.30, 0.20},  {0.80, 1.08, 0.20, 0.13}};
  coat.Append(MakeOvalBody(trunk, {0, 0}, 20));
  const Ovals neck = {{0.58, 1.14, 0.27, 0.15},
                      {0.78, 1.19, 0.22, 0.12},
                      {0.96, 1.27, 0.17, 0.10},
                      {1.08, 1.36, 0.12, 0.095}};
  coat.Append(MakeOvalBody(neck, {0, 0}, 14));
  const Ovals head = {{1.02, 1.44, 0.09, 0.09},   {1.10, 1.42, 0.125, 0.115},
                      {1.20, 1.35, 0.12, 0.11},   {1.30, 1.26, 0.09, 0.085},
                      {1.38, 1.18, 0.075, 0.075}, {1.42, 1.14, 0.07, 0.08}};
  coat.Append(MakeOvalBody(head, {0, 0}, 14));
  const Ovals tail = {{-0.98, 1.30, 0.035, 0.03},
                      {-1.03, 1.15, 0.025, 0.022},
                      {-1.03, 0.85, 0.018, 0.018},
                      {-1.02, 0.60, 0.03, 0.03},
                      {-1.02, 0.45, 0.02, 0.02}};
  coat.Append(MakeOvalBody(tail, {0, 0}, 8));
  coat.Append(MakeEllipsoid({-0.62, 0.0, 0.64}, {0.20, 0.16, 0.14}, 14));  // Udder.
  for (const double side : kBothSides) {
    coat.Append(MakeEar({1.07, side * 0.09, 1.46}, {1.04, side * 0.29, 1.44}, {0.02, 0.0, 0.05}));
    coat.Append(MakeEllipsoid({-0.56, side * 0.08, 0.50}, {0.015, 0.015, 0.04}, 6));
    coat.Append(MakeEllipsoid({-0.70, side * 0.07, 0.50}, {0.015, 0.015, 0.04}, 6));
  }
  AddLegs({.sections = {{0.52, 0.95, 0.18, 0.10},
                        {0.50, 0.75, 0.11, 0.08},
                        {0.50, 0.55, 0.065, 0.06},
                        {0.505, 0.47, 0.062, 0.058},
                        {0.50, 0.35, 0.038, 0.036},
                        {0.50, 0.18, 0.038, 0.036},
                        {0.52, 0.12, 0.048, 0.042}},
           .foot = {{0.53, 0.09, 0.05, 0.045}, {0.565, 0.025, 0.06, 0.055}},
           .top_y_m = 0.17,
           .foot_y_m = 0.15},
          0.20, surfaces, cow);
  AddLegs({.sections = {{-0.72, 1.05, 0.24, 0.10},
                        {-0.72, 0.85, 0.18, 0.09},
                        {-0.78, 0.66, 0.085, 0.065},
                        {-0.86, 0.52, 0.06, 0.05},
                        {-0.85, 0.40, 0.045, 0.04},
                        {-0.83, 0.20, 0.042, 0.04},
                        {-0.81, 0.12, 0.05, 0.044}},
           .foot = {{-0.80, 0.09, 0.05, 0.045}, {-0.765, 0.025, 0.06, 0.055}},
           .top_y_m = 0.20,
           .foot_y_m = 0.17},
          -0.20, surfaces, cow);
  Mesh horn;
  horn.Append(MakeEllipsoid({1.465, 0.0, 1.125}, {0.03, 0.065, 0.05}, 10));  // Muzzle.
  for (const double side : kBothSides) {
    horn.Append(MakeHorn(
        {{1.04, side * 0.06, 1.50}, {1.05, side * 0.16, 1.56}, {1.10, side * 0.20, 1.62}}, 0.03));
  }
  MeshOf(surfaces.coat, cow).Append(coat);
  MeshOf(surfaces.horn, cow).Append(horn);
  StandOnOrigin(cow);
  return cow;
}

Model MakeAnimal(ObjectType type, const AnimalSurfaces& surfaces) {
  Check(IsAnimal(type), "an animal has a model");
  if (type == ObjectType::kDeer) return MakeDeer(surfaces);
  return type == ObjectType::kDog ? MakeDog(surfaces) : MakeCow(surfaces);
}

}  // namespace railcast
