#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/detect/detect_spec.h"

namespace railcast {

/// The rungs of the fidelity ladder, from the cheapest to the dearest.
[[nodiscard]] std::vector<std::string> RungNames();

/// A scenario's fidelity that is no rung: `footprint`, less what the scene does not need
/// (core/fidelity/choice.h).
inline constexpr std::string_view kAutoFidelity = "auto";

/// What a scenario may name as its fidelity: the rungs, and `auto`.
[[nodiscard]] std::vector<std::string> FidelityNames();

/// The effects that a rung stands for.
/// @throws InputError if there is no such rung.
[[nodiscard]] EffectSet EffectsOfRung(std::string_view rung);

/// What is wrong with a set of effects, naming the two that do not go together; nothing if it is
/// sound. The published model and physics describe the same things twice, so effects of only one of
/// them may be on; `sensor_dropout` belongs to both. The dense footprint is a footprint, and it
/// samples the wires' triangles, which `thin_conductors` would count a second time.
[[nodiscard]] std::optional<std::string> ConflictIn(const EffectSet& effects);

}  // namespace railcast
