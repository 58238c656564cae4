#pragma once

#include <array>
#include <optional>

#include "core/rail/objects/object_surfaces.h"
#include "core/rail/objects/person_body.h"
#include "railcast/objects.h"
#include "railcast/scene.h"

namespace railcast {

/// What a person holds on to, in the person's frame (person.h): where the palms of the left and of
/// the right hand are. Absent: that hand is free.
using Handholds = std::array<std::optional<Vector3>, 2>;
[[nodiscard]] Handholds HandholdsOf(const PersonSpec& look, const BodyMeasures& body);

/// Adds what the person pulls or pushes, in the person's frame:
/// - suitcase: 0.75 x 0.45 x 0.30 m on two wheels; pulled behind by the right hand if the person
///   walks, otherwise upright beside it;
/// - pram: carrycot of 0.80 x 0.40 m with a hood on a folding frame, 1.1 m high, ahead;
/// - bicycle: pushed at the right by the left grip and the saddle.
void AddLuggage(const PersonSpec& look,
                const BodyMeasures& body,
                const PersonSurfaces& surfaces,
                Model& model);

}  // namespace railcast
