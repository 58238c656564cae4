#include "core/rail/objects/person_body.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/objects/loft.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr int kTorsoSides = 24;

// Heights in these tables are those of a man of 1.75 m, whose waist is 0.149 m above the hips and
// whose neck is 0.403 m above the waist; depths and widths are at a girth of 1.
constexpr double kTableWaist_m = 0.149;
constexpr double kTableNeck_m = 0.403;

constexpr LoftSection kManPelvisSections[] = {{-0.112, 0.0, 0.0, 0.0},
                                              {-0.100, 0.055, 0.065, 0.080},
                                              {-0.080, 0.082, 0.098, 0.130},
                                              {-0.040, 0.100, 0.126, 0.168, 0.0, 2.4},
                                              {0.000, 0.105, 0.130, 0.177, 0.0, 2.4},
                                              {0.040, 0.106, 0.118, 0.176, 0.0, 2.4},
                                              {0.090, 0.108, 0.100, 0.166, 0.0, 2.4},
                                              {0.149, 0.110, 0.092, 0.157, 0.0, 2.4},
                                              {0.185, 0.098, 0.082, 0.142},
                                              {0.205, 0.060, 0.050, 0.090},
                                              {0.213, 0.0, 0.0, 0.0}};

constexpr LoftSection kWomanPelvisSections[] = {{-0.112, 0.0, 0.0, 0.0},
                                                {-0.100, 0.055, 0.070, 0.085},
                                                {-0.080, 0.085, 0.108, 0.140},
                                                {-0.040, 0.102, 0.138, 0.184, 0.0, 2.3},
                                                {0.000, 0.106, 0.138, 0.192, 0.0, 2.3},
                                                {0.040, 0.104, 0.118, 0.184, 0.0, 2.3},
                                                {0.090, 0.098, 0.096, 0.163, 0.0, 2.3},
                                                {0.149, 0.092, 0.084, 0.144, 0.0, 2.3},
                                                {0.185, 0.082, 0.074, 0.130},
                                                {0.205, 0.050, 0.045, 0.080},
                                                {0.213, 0.0, 0.0, 0.0}};

constexpr LoftSection kManChestSections[] = {{-0.055, 0.0, 0.0, 0.0},
                                             {-0.045, 0.060, 0.050, 0.090},
                                             {-0.025, 0.098, 0.082, 0.142},
                                             {0.000, 0.110, 0.092, 0.157, 0.0, 2.4},
                                             {0.060, 0.111, 0.096, 0.160, 0.0, 2.4},
                                             {0.120, 0.115, 0.106, 0.167, 0.0, 2.4},
                                             {0.180, 0.122, 0.113, 0.174, 0.0, 2.5},
                                             {0.240, 0.124, 0.119, 0.178, 0.0, 2.6},
                                             {0.295, 0.113, 0.120, 0.181, 0.0, 2.6},
                                             {0.335, 0.097, 0.114, 0.188, -0.004, 2.5},
                                             {0.362, 0.080, 0.102, 0.186, -0.008, 2.4},
                                             {0.382, 0.069, 0.090, 0.172, -0.012, 2.2},
                                             {0.402, 0.061, 0.077, 0.128, -0.012, 2.1},
                                             {0.420, 0.058, 0.067, 0.088, -0.008, 2.0},
                                             {0.436, 0.056, 0.062, 0.066, -0.002, 2.0},
                                             {0.438, 0.0, 0.0, 0.0, -0.002}};

constexpr LoftSection kWomanChestSections[] = {{-0.055, 0.0, 0.0, 0.0},
                                               {-0.045, 0.050, 0.045, 0.080},
                                               {-0.025, 0.082, 0.074, 0.130},
                                               {0.000, 0.092, 0.084, 0.144, 0.0, 2.3},
                                               {0.060, 0.096, 0.090, 0.143, 0.0, 2.3},
                                               {0.120, 0.108, 0.098, 0.148, 0.0, 2.4},
                                               {0.170, 0.140, 0.104, 0.155, 0.0, 2.5},
                                               {0.210, 0.148, 0.108, 0.159, 0.0, 2.5},
                                               {0.250, 0.126, 0.110, 0.162, 0.0, 2.5},
                                               {0.295, 0.101, 0.110, 0.165, 0.0, 2.5},
                                               {0.335, 0.087, 0.104, 0.172, -0.004, 2.4},
                                               {0.362, 0.073, 0.094, 0.170, -0.008, 2.3},
                                               {0.382, 0.062, 0.082, 0.156, -0.012, 2.2},
                                               {0.402, 0.054, 0.069, 0.114, -0.012, 2.1},
                                               {0.420, 0.051, 0.060, 0.077, -0.008, 2.0},
                                               {0.436, 0.049, 0.055, 0.057, -0.002, 2.0},
                                               {0.438, 0.0, 0.0, 0.0, -0.002}};

// Bands of a waistcoat, above the waist of a man of 1.75 m. EN ISO 20471 wants bands of 50 mm, two
// round the torso and one over each shoulder.
constexpr double kWaistBand_m[2] = {0.020, 0.080};
constexpr double kChestBand_m[2] = {0.150, 0.210};
constexpr double kShoulderTop_m[2] = {0.382, 0.402};

bool IsWithin(double value, const double (&limits)[2]) {
  return value > limits[0] && value < limits[1];
}

/// Whether a face of the chest, at a height of the table, is retroreflecting.
bool IsBand(double z_m, int side) {
  if (IsWithin(z_m, kWaistBand_m) || IsWithin(z_m, kChestBand_m)) return true;
  // Counted in each quarter from the front or the back: faces from 30 to 60 degrees.
  const int in_half = side % (kTorsoSides / 2);
  const bool is_strap = in_half == 2 || in_half == 3 || in_half == 8 || in_half == 9;
  if (z_m > kChestBand_m[1] && z_m < kShoulderTop_m[0]) return is_strap;
  return IsWithin(z_m, kShoulderTop_m) && in_half >= 2 && in_half <= 9;
}

constexpr int kHeadSides = 20;

// Heights above the neck's joint, of a man of 1.75 m.
constexpr double kTableCrown_m = 0.2725;
constexpr double kTableHelmet_m = 0.3075;

constexpr LoftSection kNeckSections[] = {{-0.040, 0.0, 0.0, 0.0},
                                         {-0.030, 0.050, 0.056, 0.058},
                                         {0.020, 0.050, 0.055, 0.055, 0.004, 2.0},
                                         {0.075, 0.050, 0.062, 0.055, 0.010, 2.0},
                                         {0.110, 0.0, 0.0, 0.0, 0.010}};

constexpr LoftSection kHeadSections[] = {{0.036, 0.0, 0.0, 0.0, 0.058},
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

constexpr LoftSection kNoseSections[] = {{0.103, 0.0, 0.0, 0.0, 0.098},
                                         {0.107, 0.016, 0.020, 0.016, 0.100},
                                         {0.114, 0.021, 0.020, 0.017, 0.100},
                                         {0.130, 0.011, 0.020, 0.011, 0.098},
                                         {0.156, 0.0, 0.0, 0.0, 0.094}};

/// Hair down to the neck.
constexpr LoftSection kLongHairSections[] = {
    {-0.035, 0.0, 0.0, 0.0, -0.050},      {-0.020, 0.020, 0.030, 0.055, -0.050},
    {0.040, 0.034, 0.052, 0.073, -0.040}, {0.110, 0.050, 0.066, 0.084, -0.030},
    {0.170, 0.060, 0.074, 0.088, -0.022}, {0.220, 0.066, 0.072, 0.084, -0.014},
    {0.252, 0.052, 0.060, 0.062, -0.006}, {0.268, 0.024, 0.030, 0.030, 0.002},
    {kTableCrown_m, 0.0, 0.0, 0.0, 0.004}};

/// EN 397: an industrial safety helmet with a peak.
constexpr LoftSection kHelmetSections[] = {{0.183, 0.0, 0.0, 0.0, 0.015},
                                           {0.184, 0.132, 0.122, 0.100, 0.015},
                                           {0.192, 0.130, 0.120, 0.098, 0.015},
                                           {0.202, 0.105, 0.114, 0.093, 0.015, 2.1},
                                           {0.235, 0.098, 0.106, 0.086, 0.013, 2.1},
                                           {0.268, 0.078, 0.086, 0.070, 0.011, 2.0},
                                           {0.292, 0.050, 0.056, 0.046, 0.009, 2.0},
                                           {0.303, 0.024, 0.027, 0.022, 0.008, 2.0},
                                           {kTableHelmet_m, 0.0, 0.0, 0.0, 0.007}};

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

constexpr int kArmSides = 10;
constexpr int kLegSides = 14;

/// Heights in this and the following tables are shares of the length of the bone, from -1 at the
/// joint farther from the trunk to 0; depths and widths are at a girth of 1.
constexpr LoftSection kUpperArmSections[] = {
    {-1.00, 0.044, 0.045, 0.041}, {-0.80, 0.046, 0.047, 0.043}, {-0.50, 0.052, 0.051, 0.047},
    {-0.25, 0.057, 0.058, 0.051}, {-0.08, 0.055, 0.057, 0.050}, {0.00, 0.050, 0.052, 0.045}};

constexpr LoftSection kForearmSections[] = {{-0.97, 0.034, 0.033, 0.029},
                                            {-0.70, 0.037, 0.036, 0.033},
                                            {-0.40, 0.043, 0.043, 0.040},
                                            {-0.15, 0.047, 0.047, 0.043},
                                            {0.00, 0.044, 0.046, 0.042}};

constexpr LoftSection kThighSections[] = {
    {-1.00, 0.059, 0.060, 0.056}, {-0.85, 0.063, 0.064, 0.060}, {-0.60, 0.075, 0.075, 0.069},
    {-0.35, 0.088, 0.092, 0.079}, {-0.15, 0.096, 0.106, 0.085}, {0.00, 0.098, 0.118, 0.085}};

constexpr LoftSection kShankSections[] = {
    {-0.96, 0.056, 0.060, 0.050}, {-0.92, 0.050, 0.056, 0.048}, {-0.75, 0.046, 0.054, 0.047},
    {-0.50, 0.049, 0.063, 0.051}, {-0.30, 0.052, 0.070, 0.055}, {-0.12, 0.055, 0.064, 0.055},
    {0.00, 0.058, 0.060, 0.056}};

/// Below the wrist, as shares of the hand's length; a relaxed mitten, curved forwards.
constexpr LoftSection kHandSections[] = {{-1.00, 0.0, 0.0, 0.0, 0.022},
                                         {-0.95, 0.016, 0.020, 0.009, 0.020},
                                         {-0.75, 0.029, 0.031, 0.014, 0.014},
                                         {-0.50, 0.040, 0.038, 0.017, 0.006, 2.6},
                                         {-0.25, 0.038, 0.036, 0.019, 0.004, 2.6},
                                         {-0.05, 0.027, 0.027, 0.020},
                                         {0.12, 0.025, 0.025, 0.020},
                                         {0.16, 0.0, 0.0, 0.0}};

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
      WithDomes(0.0, 0.045 * girth, Stretched(kForearmSections, {girth, girth, body.forearm_m})),
      kArmSides, dress.clothing, forearm);
  Transform wrist = Transform::Identity();
  wrist.translation().z() = -body.forearm_m;
  AddLoft(Stretched(kHandSections, {girth, girth, body.hand_m}), kArmSides, dress.skin, forearm,
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
  std::vector<LoftSection> table(std::begin(kShankSections), std::end(kShankSections));
  // Two bands of 60 mm on a shank of 0.43 m, 70 mm apart.
  constexpr double kBands[2][2] = {{-0.30, -0.16}, {-0.60, -0.46}};
  if (dress.is_hi_vis) {
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
    return dress.is_hi_vis && is_band ? dress.band : dress.outer;
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
  AddLoft(Stretched(sections, Vector3::Constant(body.shoe_length_m)), 12, dress.clothing, foot,
          MakeTransform(axes, Vector3::Zero()));
  return foot;
}

void AddTrunk(const BodyMeasures& body,
              Physique physique,
              const PersonDress& dress,
              PersonBones& bones) {
  const auto scale = [&](double length_m, double table_m) {
    return Vector3(body.trunk_girth, body.trunk_girth, length_m / table_m);
  };
  using Sections = std::span<const LoftSection>;
  const bool is_woman = physique == Physique::kWoman;
  const Sections pelvis = is_woman ? Sections(kWomanPelvisSections) : kManPelvisSections;
  const Sections chest = is_woman ? Sections(kWomanChestSections) : kManChestSections;
  AddLoft(Stretched(pelvis, scale(body.waist_m - body.hip_m, kTableWaist_m)), kTorsoSides,
          dress.outer, bones.pelvis);

  std::vector<LoftSection> table(chest.begin(), chest.end());
  if (dress.is_hi_vis) {
    for (const double z_m : {kWaistBand_m[0], kWaistBand_m[1], kChestBand_m[0], kChestBand_m[1]}) {
      table = WithSectionAt(z_m, std::move(table));
    }
  }
  const auto surface = [&](int gap, int side) {
    const auto lower = static_cast<std::size_t>(gap);
    const double z_m = 0.5 * (table[lower].z_m + table[lower + 1].z_m);
    if (z_m > kShoulderTop_m[1]) return dress.clothing;  // The collar of what is worn below.
    return dress.is_hi_vis && IsBand(z_m, side) ? dress.band : dress.outer;
  };
  AddLoft(Stretched(table, scale(body.neck_m - body.waist_m, kTableNeck_m)), kTorsoSides, surface,
          bones.chest);
}

void AddHead(const BodyMeasures& body,
             Physique physique,
             const PersonDress& dress,
             PersonBones& bones) {
  const Vector3 scale(body.head_girth, body.head_girth,
                      (body.height_m - body.neck_m) / kTableCrown_m);
  AddLoft(Stretched(kNeckSections, scale), 14, dress.skin, bones.head);
  const auto surface = [&](int gap, int side) {
    const double z_m = 0.5 * (kHeadSections[gap].z_m + kHeadSections[gap + 1].z_m);
    return IsHair(z_m, side) ? dress.clothing : dress.skin;
  };
  AddLoft(Stretched(kHeadSections, scale), kHeadSides, surface, bones.head);
  AddLoft(Stretched(kNoseSections, scale), 8, dress.skin, bones.head);
  AddEars(scale, dress.skin, bones.head);
  if (physique == Physique::kWoman) {
    AddLoft(Stretched(kLongHairSections, scale), 16, dress.clothing, bones.head);
  }
  if (dress.is_hi_vis) {
    AddLoft(Stretched(kHelmetSections, scale), kHeadSides, dress.helmet, bones.head);
  }
}

void AddLimbs(const BodyMeasures& body, const PersonDress& dress, PersonBones& bones) {
  const double girth = body.limb_girth;
  AddLoft(WithDomes(0.042 * girth, 0.022 * girth,
                    Stretched(kUpperArmSections, {girth, girth, body.upper_arm_m})),
          kArmSides, dress.clothing, bones.limbs.upper_arm);
  bones.limbs.forearm = MakeHandAndForearm(body, dress);
  AddLoft(WithDomes(0.055 * girth, 0.075 * girth,
                    Stretched(kThighSections, {girth, girth, body.thigh_m()})),
          kLegSides, dress.outer, bones.limbs.thigh);
  bones.limbs.shank = MakeShank(body, dress);
  bones.limbs.foot = MakeShoe(body, dress);
}

}  // namespace

double HelmetHeight(Physique physique) {
  const BodyMeasures body = MeasuresOf(physique, 1.0);
  return body.neck_m + (1.0 - body.neck_m) * kTableHelmet_m / kTableCrown_m;
}

PersonBones MakePersonBones(const BodyMeasures& body, Physique physique, const PersonDress& dress) {
  PersonBones bones;
  AddTrunk(body, physique, dress, bones);
  AddHead(body, physique, dress, bones);
  AddLimbs(body, dress, bones);
  return bones;
}

}  // namespace railcast
