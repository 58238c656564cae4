#include <algorithm>
#include <numbers>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/objects/loft.h"
#include "core/rail/objects/person_shape.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr int kArmSides = 10;
constexpr int kLegSides = 14;

/// Heights in this and the following tables are shares of the length of the bone, from -1 at the
/// joint farther from the trunk to 0; depths and widths are at a girth of 1.
const std::vector<LoftSection>& UpperArmSections() {
  static const std::vector<LoftSection> sections = {
      {-1.00, 0.044, 0.045, 0.041}, {-0.80, 0.046, 0.047, 0.043}, {-0.50, 0.052, 0.051, 0.047},
      {-0.25, 0.057, 0.058, 0.051}, {-0.08, 0.055, 0.057, 0.050}, {0.00, 0.050, 0.052, 0.045}};
  return sections;
}

const std::vector<LoftSection>& ForearmSections() {
  static const std::vector<LoftSection> sections = {{-0.97, 0.034, 0.033, 0.029},
                                                    {-0.70, 0.037, 0.036, 0.033},
                                                    {-0.40, 0.043, 0.043, 0.040},
                                                    {-0.15, 0.047, 0.047, 0.043},
                                                    {0.00, 0.044, 0.046, 0.042}};
  return sections;
}

const std::vector<LoftSection>& ThighSections() {
  static const std::vector<LoftSection> sections = {
      {-1.00, 0.059, 0.060, 0.056}, {-0.85, 0.063, 0.064, 0.060}, {-0.60, 0.075, 0.075, 0.069},
      {-0.35, 0.088, 0.092, 0.079}, {-0.15, 0.096, 0.106, 0.085}, {0.00, 0.098, 0.118, 0.085}};
  return sections;
}

const std::vector<LoftSection>& ShankSections() {
  static const std::vector<LoftSection> sections = {
      {-0.96, 0.056, 0.060, 0.050}, {-0.92, 0.050, 0.056, 0.048}, {-0.75, 0.046, 0.054, 0.047},
      {-0.50, 0.049, 0.063, 0.051}, {-0.30, 0.052, 0.070, 0.055}, {-0.12, 0.055, 0.064, 0.055},
      {0.00, 0.058, 0.060, 0.056}};
  return sections;
}

/// Below the wrist, as shares of the hand's length; a relaxed mitten, curved forwards.
const std::vector<LoftSection>& HandSections() {
  static const std::vector<LoftSection> sections = {{-1.00, 0.0, 0.0, 0.0, 0.022},
                                                    {-0.95, 0.016, 0.020, 0.009, 0.020},
                                                    {-0.75, 0.029, 0.031, 0.014, 0.014},
                                                    {-0.50, 0.040, 0.038, 0.017, 0.006, 2.6},
                                                    {-0.25, 0.038, 0.036, 0.019, 0.004, 2.6},
                                                    {-0.05, 0.027, 0.027, 0.020},
                                                    {0.12, 0.025, 0.025, 0.020},
                                                    {0.16, 0.0, 0.0, 0.0}};
  return sections;
}

/// A cross-section of a shoe: from the sole to the top, as shares of the shoe's length.
struct ShoeSection {
  double x{};
  double bottom{}, top{};
  double half_width{};
};
constexpr ShoeSection kShoeSections[] = {
    {-0.270, 0.050, 0.200, 0.000}, {-0.262, 0.046, 0.240, 0.075}, {-0.210, 0.000, 0.310, 0.110},
    {-0.050, 0.000, 0.360, 0.125}, {0.080, 0.000, 0.320, 0.130},  {0.250, 0.000, 0.225, 0.155},
    {0.400, 0.000, 0.175, 0.172},  {0.550, 0.024, 0.150, 0.160},  {0.670, 0.043, 0.125, 0.110},
    {0.730, 0.050, 0.090, 0.000}};

Model MakeHandAndForearm(const BodyMeasures& body, const PersonDress& dress) {
  const double girth = body.limb_girth;
  Model forearm;
  AddLoft(
      WithDomes(0.0, 0.045 * girth, Stretched(ForearmSections(), {girth, girth, body.forearm_m})),
      kArmSides, dress.sleeves, forearm);
  Transform wrist = Transform::Identity();
  wrist.translation().z() = -body.forearm_m;
  AddLoft(Stretched(HandSections(), {girth, girth, body.hand_m}), kArmSides, dress.skin, forearm,
          wrist);
  const auto on_hand = [&](double x_m, double y_m, double share) {
    return Vector3(girth * x_m, girth * y_m, -body.forearm_m - share * body.hand_m);
  };
  const Vector3 tip = on_hand(0.060, 0.0, 0.56);
  Mesh& skin = MeshOf(dress.skin, forearm);
  const std::vector<Vector3> thumb = {on_hand(0.018, 0.0, 0.16), on_hand(0.046, 0.0, 0.34), tip};
  const std::vector<double> radii_m = {0.016 * girth, 0.013 * girth, 0.010 * girth};
  skin.Append(MakeTube(thumb, radii_m, 6));
  skin.Append(MakeEllipsoid(tip, Vector3::Constant(0.010 * girth), 6));
  return forearm;
}

Model MakeShank(const BodyMeasures& body, const PersonDress& dress) {
  std::vector<LoftSection> table = ShankSections();
  // Two bands of 60 mm on a shank of 0.43 m, 70 mm apart.
  constexpr double kBands[2][2] = {{-0.30, -0.16}, {-0.60, -0.46}};
  if (dress.has_bands) {
    for (const auto& band : kBands) {
      for (const double edge : band) table = WithSectionAt(edge, std::move(table));
    }
  }
  const double girth = body.limb_girth;
  std::vector<LoftSection> sections =
      WithDomes(0.0, 0.055 * girth, Stretched(table, {girth, girth, body.shank_m()}));
  const auto surface = [&](int gap, int /*side*/) {
    const auto lower = static_cast<std::size_t>(gap);
    const double share = 0.5 * (sections[lower].z_m + sections[lower + 1].z_m) / body.shank_m();
    const bool is_band = std::any_of(std::begin(kBands), std::end(kBands), [&](const auto& band) {
      return share > band[0] && share < band[1];
    });
    return dress.has_bands && is_band ? dress.band : dress.legs;
  };
  Model shank;
  AddLoft(sections, kLegSides, surface, shank);
  return shank;
}

Model MakeShoe(const BodyMeasures& body, const PersonDress& dress) {
  // The loft's z axis points to the toes, its x axis upwards.
  std::vector<LoftSection> sections;
  for (const ShoeSection& section : kShoeSections) {
    const double middle = section.bottom + 0.35 * (section.top - section.bottom);
    const double ankle = body.ankle_m / body.shoe_length_m;
    sections.push_back({.z_m = section.x,
                        .front_m = section.top - middle,
                        .back_m = middle - section.bottom,
                        .half_width_m = section.half_width,
                        .x_m = middle - ankle,
                        .exponent = 2.8});
  }
  // The tip and the back are points at the height of the sole's ends.
  const double end_x = 0.05 - body.ankle_m / body.shoe_length_m;
  for (LoftSection* end : {&sections.front(), &sections.back()}) {
    *end = {.z_m = end->z_m, .x_m = end_x};
  }
  Eigen::Matrix3d axes;
  axes << Vector3::UnitZ(), -Vector3::UnitY(), Vector3::UnitX();
  Model foot;
  AddLoft(Stretched(sections, Vector3::Constant(body.shoe_length_m)), 12, dress.shoes, foot,
          MakeTransform(axes, Vector3::Zero()));
  return foot;
}

}  // namespace

void AddLimbs(const BodyMeasures& body, const PersonDress& dress, PersonBones& bones) {
  const double girth = body.limb_girth;
  AddLoft(WithDomes(0.042 * girth, 0.022 * girth,
                    Stretched(UpperArmSections(), {girth, girth, body.upper_arm_m})),
          kArmSides, dress.sleeves, bones.limbs.upper_arm);
  bones.limbs.forearm = MakeHandAndForearm(body, dress);
  AddLoft(WithDomes(0.055 * girth, 0.075 * girth,
                    Stretched(ThighSections(), {girth, girth, body.thigh_m()})),
          kLegSides, dress.legs, bones.limbs.thigh);
  bones.limbs.shank = MakeShank(body, dress);
  bones.limbs.foot = MakeShoe(body, dress);
}

PersonBones MakePersonBones(const BodyMeasures& body, Physique physique, const PersonDress& dress) {
  PersonBones bones;
  AddTrunk(body, physique, dress, bones);
  AddHead(body, physique, dress, bones);
  AddLimbs(body, dress, bones);
  return bones;
}

}  // namespace railcast
