#include "core/rail/objects/person_body.h"

namespace railcast {
namespace {

/// The measures of a body, all as shares of its height, apart from the girths.
constexpr BodyMeasures kAdult{.height_m = 1.0,
                              .ankle_m = 0.039,
                              .knee_m = 0.285,
                              .hip_m = 0.530,
                              .waist_m = 0.615,
                              .shoulder_m = 0.818,
                              .neck_m = 0.845,
                              .chin_m = 0.870,
                              .upper_arm_m = 0.186,
                              .forearm_m = 0.146,
                              .hand_m = 0.108,
                              .hip_offset_m = 0.052,
                              .shoulder_offset_m = 0.105,
                              .shoe_length_m = 0.160,
                              .trunk_girth = 1.0,
                              .limb_girth = 1.0,
                              .head_girth = 1.0};

constexpr BodyMeasures kChild{.height_m = 1.0,
                              .ankle_m = 0.042,
                              .knee_m = 0.270,
                              .hip_m = 0.500,
                              .waist_m = 0.590,
                              .shoulder_m = 0.780,
                              .neck_m = 0.808,
                              .chin_m = 0.832,
                              .upper_arm_m = 0.183,
                              .forearm_m = 0.143,
                              .hand_m = 0.108,
                              .hip_offset_m = 0.047,
                              .shoulder_offset_m = 0.098,
                              .shoe_length_m = 0.165,
                              .trunk_girth = 0.93,
                              .limb_girth = 0.95,
                              .head_girth = 1.34};

BodyMeasures Shares(Physique physique) {
  if (physique == Physique::kChild) return kChild;
  BodyMeasures shares = kAdult;
  if (physique == Physique::kWoman) {
    shares.shoulder_offset_m = 0.099;
    shares.limb_girth = 0.95;
  }
  return shares;
}

}  // namespace

Sole SoleOf(const BodyMeasures& body) {
  const double ends_z_m = 0.05 * body.shoe_length_m - body.ankle_m;
  return {.heel_back_m = {-0.27 * body.shoe_length_m, ends_z_m},
          .heel_m = {-0.21 * body.shoe_length_m, -body.ankle_m},
          .ball_m = {0.40 * body.shoe_length_m, -body.ankle_m},
          .tip_m = {0.73 * body.shoe_length_m, ends_z_m}};
}

BodyMeasures MeasuresOf(Physique physique, double height_m) {
  constexpr double kManHeight_m = 1.75;
  BodyMeasures body = Shares(physique);
  for (double BodyMeasures::*length :
       {&BodyMeasures::height_m, &BodyMeasures::ankle_m, &BodyMeasures::knee_m,
        &BodyMeasures::hip_m, &BodyMeasures::waist_m, &BodyMeasures::shoulder_m,
        &BodyMeasures::neck_m, &BodyMeasures::chin_m, &BodyMeasures::upper_arm_m,
        &BodyMeasures::forearm_m, &BodyMeasures::hand_m, &BodyMeasures::hip_offset_m,
        &BodyMeasures::shoulder_offset_m, &BodyMeasures::shoe_length_m}) {
    body.*length *= height_m;
  }
  for (double BodyMeasures::*girth :
       {&BodyMeasures::trunk_girth, &BodyMeasures::limb_girth, &BodyMeasures::head_girth}) {
    body.*girth *= height_m / kManHeight_m;
  }
  return body;
}

}  // namespace railcast
