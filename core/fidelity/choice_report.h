#pragma once

#include <string>

#include "core/fidelity/choice.h"

namespace railcast {

/// The choice in sentences: what is used, what was left out and what it would have changed, and how
/// it did on the frames held back. Whole lines.
[[nodiscard]] std::string ChoiceText(const FidelityChoice& choice, const ToleranceSpec& tolerance);

/// The whole choice as a JSON object. What is infinite is null.
[[nodiscard]] std::string ChoiceJson(const FidelityChoice& choice, const ToleranceSpec& tolerance);

}  // namespace railcast
