#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/loft.h"
#include "core/rail/objects/person_shape.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr int kHeadSides = 20;

// Heights above the neck's joint, of a man of 1.75 m.
constexpr double kTableCrown_m = 0.2725;
constexpr double kTableHelmet_m = 0.3075;

const std::vector<LoftSection>& NeckSections() {
  static const std::vector<LoftSection> sections = {{-0.040, 0.0, 0.0, 0.0},
                                                    {-0.030, 0.050, 0.056, 0.058},
                                                    {0.020, 0.050, 0.055, 0.055, 0.004, 2.0},
                                                    {0.075, 0.050, 0.062, 0.055, 0.010, 2.0},
                                                    {0.110, 0.0, 0.0, 0.0, 0.010}};
  return sections;
}

const std::vector<LoftSection>& HeadSections() {
  static const std::vector<LoftSection> sections = {{0.036, 0.0, 0.0, 0.0, 0.058},
                                                    {0.041, 0.026, 0.030, 0.026, 0.058},
                                                    {0.053, 0.046, 0.062, 0.046, 0.046},
                                                    {0.070, 0.062, 0.078, 0.056, 0.032},
                                                    {0.092, 0.074, 0.086, 0.064, 0.024},
                                                    {0.112, 0.078, 0.092, 0.069, 0.021},
                                                    {0.136, 0.077, 0.097, 0.073, 0.020},
                                                    {0.154, 0.077, 0.098, 0.075, 0.020},
                                                    {0.166, 0.081, 0.099, 0.0765, 0.020},
                                                    {0.196, 0.081, 0.099, 0.0775, 0.018},
                                                    {0.222, 0.074, 0.094, 0.073, 0.016, 2.1},
                                                    {0.243, 0.060, 0.080, 0.062, 0.013, 2.0},
                                                    {0.259, 0.042, 0.057, 0.045, 0.010, 2.0},
                                                    {0.269, 0.020, 0.028, 0.022, 0.008, 2.0},
                                                    {kTableCrown_m, 0.0, 0.0, 0.0, 0.006}};
  return sections;
}

const std::vector<LoftSection>& NoseSections() {
  static const std::vector<LoftSection> sections = {{0.103, 0.0, 0.0, 0.0, 0.098},
                                                    {0.107, 0.016, 0.020, 0.016, 0.100},
                                                    {0.114, 0.021, 0.020, 0.017, 0.100},
                                                    {0.130, 0.011, 0.020, 0.011, 0.098},
                                                    {0.156, 0.0, 0.0, 0.0, 0.094}};
  return sections;
}

/// Hair down to the neck.
const std::vector<LoftSection>& LongHairSections() {
  static const std::vector<LoftSection> sections = {
      {-0.035, 0.0, 0.0, 0.0, -0.050},      {-0.020, 0.020, 0.030, 0.055, -0.050},
      {0.040, 0.034, 0.052, 0.073, -0.040}, {0.110, 0.050, 0.066, 0.084, -0.030},
      {0.170, 0.060, 0.074, 0.088, -0.022}, {0.220, 0.066, 0.072, 0.084, -0.014},
      {0.252, 0.052, 0.060, 0.062, -0.006}, {0.268, 0.024, 0.030, 0.030, 0.002},
      {kTableCrown_m, 0.0, 0.0, 0.0, 0.004}};
  return sections;
}

/// EN 397: an industrial safety helmet with a peak.
const std::vector<LoftSection>& HelmetSections() {
  static const std::vector<LoftSection> sections = {{0.183, 0.0, 0.0, 0.0, 0.015},
                                                    {0.184, 0.132, 0.122, 0.100, 0.015},
                                                    {0.192, 0.130, 0.120, 0.098, 0.015},
                                                    {0.202, 0.105, 0.114, 0.093, 0.015, 2.1},
                                                    {0.235, 0.098, 0.106, 0.086, 0.013, 2.1},
                                                    {0.268, 0.078, 0.086, 0.070, 0.011, 2.0},
                                                    {0.292, 0.050, 0.056, 0.046, 0.009, 2.0},
                                                    {0.303, 0.024, 0.027, 0.022, 0.008, 2.0},
                                                    {kTableHelmet_m, 0.0, 0.0, 0.0, 0.007}};
  return sections;
}

/// Whether a face of the head, at a height of the table, is covered with hair.
bool IsHair(double z_m, int side) {
  const int from_front = side < kHeadSides / 2 ? side : kHeadSides - 1 - side;
  if (z_m > 0.228) return true;
  if (z_m > 0.175) return from_front >= 3;
  return z_m > 0.085 && from_front >= 6;
}

void AddEars(const Vector3& scale, const SurfaceClass& skin, Model& head) {
  for (const double side : {-1.0, 1.0}) {
    const Vector3 centre_m(0.008, side * 0.078, 0.137);
    MeshOf(skin, head)
        .Append(MakeEllipsoid(scale.cwiseProduct(centre_m),
                              scale.cwiseProduct(Vector3(0.019, 0.010, 0.031)), 8));
  }
}

}  // namespace

double HelmetHeight(Physique physique) {
  const BodyMeasures body = MeasuresOf(physique, 1.0);
  return body.neck_m + (1.0 - body.neck_m) * kTableHelmet_m / kTableCrown_m;
}

void AddHead(const BodyMeasures& body,
             Physique physique,
             const PersonDress& dress,
             PersonBones& bones) {
  const Vector3 scale(body.head_girth, body.head_girth,
                      (body.height_m - body.neck_m) / kTableCrown_m);
  AddLoft(Stretched(NeckSections(), scale), 14, dress.skin, bones.head);
  const std::vector<LoftSection>& table = HeadSections();
  const auto surface = [&](int gap, int side) {
    const auto lower = static_cast<std::size_t>(gap);
    const double z_m = 0.5 * (table[lower].z_m + table[lower + 1].z_m);
    return IsHair(z_m, side) ? dress.hair : dress.skin;
  };
  AddLoft(Stretched(table, scale), kHeadSides, surface, bones.head);
  AddLoft(Stretched(NoseSections(), scale), 8, dress.skin, bones.head);
  AddEars(scale, dress.skin, bones.head);
  if (physique == Physique::kWoman) {
    AddLoft(Stretched(LongHairSections(), scale), 16, dress.hair, bones.head);
  }
  if (dress.has_helmet) {
    AddLoft(Stretched(HelmetSections(), scale), kHeadSides, dress.helmet, bones.head);
  }
}

}  // namespace railcast
