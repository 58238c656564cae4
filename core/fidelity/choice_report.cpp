#include "core/fidelity/choice_report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/detect/effect_table.h"

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;

std::string Rounded(double value, int num_digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(num_digits) << value;
  return text.str();
}

std::string Text(const Deviation& d) {
  return "range " + Rounded(1e3 * d.range_m, 1) + " mm, missed " +
         Rounded(100.0 * d.missed_share, 2) + " %, false " + Rounded(100.0 * d.false_share, 2) +
         " %, wires missed " + Rounded(100.0 * d.thin_missed_share, 2) + " %, intensity " +
         (std::isinf(d.intensity) ? "none" : Rounded(100.0 * d.intensity, 2) + " %");
}

// Lists names as "a, b and c", or "nothing" if there are none.
std::string List(const std::vector<std::string>& names) {
  if (names.empty()) return "nothing";
  std::string text = names.front();
  for (std::size_t i = 1; i < names.size(); ++i) {
    text += (i + 1 == names.size() ? " and " : ", ") + names[i];
  }
  return text;
}

Json ObjectOf(const Deviation& d) {
  Json object = {{"range_m", d.range_m},
                 {"missed_share", d.missed_share},
                 {"false_share", d.false_share},
                 {"thin_missed_share", d.thin_missed_share},
                 {"intensity", d.intensity}};
  return object;
}

std::size_t NumBeyond(const FidelityChoice& choice) {
  return static_cast<std::size_t>(
      std::count_if(choice.held_back.begin(), choice.held_back.end(),
                    [](const auto& held) { return !held.is_within_tolerance; }));
}

}  // namespace

std::string ChoiceText(const FidelityChoice& choice, const ToleranceSpec& tolerance) {
  const ToleranceSpec& t = tolerance;
  std::string text = "fidelity auto uses " + List(EffectNames(choice.effects)) + "\n";
  text += "  tolerance: " +
          Text({t.range_m, t.missed_share, t.false_share, t.thin_missed_share, t.intensity}) + "\n";
  text += "  chosen:    " + Text(choice.deviation) + ", about " + Rounded(choice.instructions, 0) +
          " instructions a firing\n";
  text += "  all:       " + Text(choice.full_deviation) + ", about " +
          Rounded(choice.full_instructions, 0) + "\n";
  if (!choice.is_within_tolerance) {
    text += "  beyond the tolerance, as all effects together are\n";
  }
  if (!choice.has_echoes) text += "  the reference has no echo to compare with: all are kept\n";
  for (const FidelityChoice::Measured& measured : choice.measured) {
    if (measured.is_kept) continue;
    text += "  without " + measured.effect +
            (measured.without == choice.full_deviation ? ": changes nothing here\n"
                                                       : ": " + Text(measured.without) + "\n");
  }
  if (!choice.without_cause.empty()) {
    text += "  without " + List(choice.without_cause) + ": no cause in this scenario\n";
  }
  text += "  on frames held back: beyond the tolerance in " + std::to_string(NumBeyond(choice)) +
          " of " + std::to_string(choice.held_back.size()) + "\n";
  return text;
}

std::string ChoiceJson(const FidelityChoice& choice, const ToleranceSpec& t) {
  Json measured = Json::array();
  for (const FidelityChoice::Measured& effect : choice.measured) {
    measured.push_back({{"effect", effect.effect},
                        {"is_kept", effect.is_kept},
                        {"deviation_without", ObjectOf(effect.without)}});
  }
  Json held_back = Json::array();
  for (const FidelityChoice::HeldBack& held : choice.held_back) {
    held_back.push_back({{"frame", held.frame},
                         {"deviation", ObjectOf(held.deviation)},
                         {"is_within_tolerance", held.is_within_tolerance}});
  }
  const Json json = {{"effects", EffectNames(choice.effects)},
                     {"tolerance", ObjectOf({t.range_m, t.missed_share, t.false_share,
                                             t.thin_missed_share, t.intensity})},
                     {"deviation", ObjectOf(choice.deviation)},
                     {"is_within_tolerance", choice.is_within_tolerance},
                     {"deviation_of_all_effects", ObjectOf(choice.full_deviation)},
                     {"instructions_per_firing", choice.instructions},
                     {"instructions_per_firing_of_all_effects", choice.full_instructions},
                     {"measured", measured},
                     {"kept_unmeasured", choice.kept},
                     {"left_out_without_cause", choice.without_cause},
                     {"sample_frames", choice.sample_frames},
                     {"has_echoes", choice.has_echoes},
                     {"held_back", held_back},
                     {"held_back_beyond_tolerance", NumBeyond(choice)}};
  return json.dump(2);
}

}  // namespace railcast
