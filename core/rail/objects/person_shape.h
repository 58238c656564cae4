#pragma once

#include <array>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/objects/person_body.h"
#include "railcast/objects.h"
#include "railcast/scene.h"

namespace railcast {

/// How the parts of a person are covered.
struct PersonDress {
  SurfaceClass skin, hair, sleeves, torso, legs, shoes;
  SurfaceClass band, helmet;  ///< Only if it wears them.
  bool has_bands = false;     ///< EN ISO 20471: round and over the torso and round the legs.
  bool has_helmet = false;
};

/// The solid of every bone, each in the bone's frame (person_body.h). Trunk, head and limbs are
/// lofts through superellipses whose half axes are working values near the medians of DIN 33402-2
/// (head 155 x 195 mm, hips 355 mm, shoulders over the arms 470 mm for a man of 1.75 m), scaled by
/// the body's girths; limbs end in domes about their joints.
struct PersonBones {
  struct Limbs {
    Model upper_arm, forearm, thigh, shank, foot;
  };
  Model pelvis, chest, head;
  Limbs limbs;  ///< The same on both sides.
};

/// Height of the top of the helmet as a multiple of the body's height.
[[nodiscard]] double HelmetHeight(Physique physique);

[[nodiscard]] PersonBones MakePersonBones(const BodyMeasures& body,
                                          Physique physique,
                                          const PersonDress& dress);

/// Parts of MakePersonBones().
void AddTrunk(const BodyMeasures& body,
              Physique physique,
              const PersonDress& dress,
              PersonBones& bones);
void AddHead(const BodyMeasures& body,
             Physique physique,
             const PersonDress& dress,
             PersonBones& bones);
void AddLimbs(const BodyMeasures& body, const PersonDress& dress, PersonBones& bones);

}  // namespace railcast
