#include <vector>

#include "core/rail/objects/loft.h"
#include "core/rail/objects/person_shape.h"

namespace railcast {
namespace {

constexpr int kTorsoSides = 24;

// Heights in these tables are those of a man of 1.75 m, whose waist is 0.149 m above the hips and
// whose neck is 0.403 m above the waist; depths and widths are at a girth of 1.
constexpr double kTableWaist_m = 0.149;
constexpr double kTableNeck_m = 0.403;

const std::vector<LoftSection>& PelvisSections(Physique physique) {
  static const std::vector<LoftSection> man = {{-0.112, 0.0, 0.0, 0.0},
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
  static const std::vector<LoftSection> woman = {{-0.112, 0.0, 0.0, 0.0},
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
  return physique == Physique::kWoman ? woman : man;
}

const std::vector<LoftSection>& ChestSections(Physique physique) {
  static const std::vector<LoftSection> man = {{-0.055, 0.0, 0.0, 0.0},
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
  static const std::vector<LoftSection> woman = {{-0.055, 0.0, 0.0, 0.0},
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
  return physique == Physique::kWoman ? woman : man;
}

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

std::vector<LoftSection> WithBandEdges(std::vector<LoftSection> sections) {
  for (const double z_m : {kWaistBand_m[0], kWaistBand_m[1], kChestBand_m[0], kChestBand_m[1]}) {
    sections = WithSectionAt(z_m, std::move(sections));
  }
  return sections;
}

}  // namespace

void AddTrunk(const BodyMeasures& body,
              Physique physique,
              const PersonDress& dress,
              PersonBones& bones) {
  const auto scale = [&](double length_m, double table_m) {
    return Vector3(body.trunk_girth, body.trunk_girth, length_m / table_m);
  };
  AddLoft(Stretched(PelvisSections(physique), scale(body.waist_m - body.hip_m, kTableWaist_m)),
          kTorsoSides, dress.legs, bones.pelvis);

  const std::vector<LoftSection>& plain = ChestSections(physique);
  const std::vector<LoftSection> table = dress.has_bands ? WithBandEdges(plain) : plain;
  const auto surface = [&](int gap, int side) {
    const auto lower = static_cast<std::size_t>(gap);
    const double z_m = 0.5 * (table[lower].z_m + table[lower + 1].z_m);
    if (z_m > kShoulderTop_m[1]) return dress.sleeves;  // The collar of what is worn below.
    return dress.has_bands && IsBand(z_m, side) ? dress.band : dress.torso;
  };
  AddLoft(Stretched(table, scale(body.neck_m - body.waist_m, kTableNeck_m)), kTorsoSides, surface,
          bones.chest);
}

}  // namespace railcast
