#pragma once

#include <string>

#include "railcast/fidelity.h"

namespace railcast {

/// Describes the choice in sentences: which effects are used, which were left out and what they
/// would have changed, and the deviation on the frames held back. Every line has its end.
[[nodiscard]] std::string ChoiceText(const FidelityChoice& choice);

/// The whole choice as a JSON object. Infinite numbers are written as null.
[[nodiscard]] std::string ChoiceJson(const FidelityChoice& choice);

}  // namespace railcast
