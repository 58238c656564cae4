#include "core/fidelity/choice_report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/join.h"
#include "core/detect/detector/effect_table.h"
#include "core/fidelity/effect_search.h"

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
  return names.empty() ? "nothing" : JoinInProse(names, " and ");
}

std::string PercentText(double share) {
  return Rounded(100.0 * share, 1) + " %";
}

// What of a part is beyond the tolerance.
std::string PartText(const PartDeviation& part, const ToleranceSpec& t) {
  std::vector<std::string> errors;
  const auto add_share = [&](const char* what, const SampledError& share, std::uint64_t num,
                             double limit) {
    if (share.least <= limit) return;
    errors.push_back(what + (" " + PercentText(share.value)) + " of " + std::to_string(num) +
                     " echoes (at least " + PercentText(share.least) + ")");
  };
  add_share("missed", part.missed_share, part.num_reference, t.missed_share);
  add_share("false", part.false_share, part.num, t.false_share);
  if (part.is_object && part.range_m.least > t.range_m) {
    errors.push_back("range " + Rounded(1e3 * part.range_m.value, 1) + " mm (at least " +
                     Rounded(1e3 * part.range_m.least, 1) + ")");
  }
  if (part.is_object && part.intensity.least > t.intensity) {
    errors.push_back("intensity " + PercentText(part.intensity.value) + " (at least " +
                     PercentText(part.intensity.least) + ")");
  }
  return part.part + ": " + List(errors);
}

// The parts beyond the tolerance, the first ones of many.
std::string PartsText(const Deviation& deviation, const ToleranceSpec& tolerance) {
  constexpr std::size_t kMost = 5;
  const std::vector<PartDeviation> beyond = PartsBeyond(deviation, tolerance);
  std::string text;
  for (std::size_t i = 0; i < std::min(beyond.size(), kMost); ++i) {
    text += "    " + PartText(beyond[i], tolerance) + "\n";
  }
  if (beyond.size() > kMost) {
    text += "    and " + Amount(beyond.size() - kMost, "others\n");
  }
  return text;
}

ToleranceSpec SearchTolerance(ToleranceSpec tolerance) {
  for (const DeviationQuantity& quantity : kDeviationQuantities) {
    tolerance.*quantity.limit *= kSearchMargin;
  }
  return tolerance;
}

Json ObjectOf(const ToleranceSpec& t) {
  Json object = {{"range_m", t.range_m},
                 {"missed_share", t.missed_share},
                 {"false_share", t.false_share},
                 {"thin_missed_share", t.thin_missed_share},
                 {"intensity", t.intensity}};
  if (!t.of.empty()) object["of"] = t.of;
  return object;
}

Json ErrorObject(const SampledError& error) {
  return {{"value", error.value}, {"at_least", error.least}};
}

Json PartsOf(const std::vector<PartDeviation>& parts) {
  Json list = Json::array();
  for (const PartDeviation& part : parts) {
    if (part.num_reference == 0 && part.num == 0) continue;
    list.push_back({{"part", part.part},
                    {"num_reference_echoes", part.num_reference},
                    {"num_echoes", part.num},
                    {"missed_share", ErrorObject(part.missed_share)},
                    {"false_share", ErrorObject(part.false_share)},
                    {"range_m", ErrorObject(part.range_m)},
                    {"intensity", ErrorObject(part.intensity)}});
  }
  return list;
}

// With the parts beyond the tolerance, or with all.
Json ObjectOf(const Deviation& d, const ToleranceSpec& tolerance, bool has_all_parts = false) {
  Json object = {{"range_m", d.range_m},
                 {"missed_share", d.missed_share},
                 {"false_share", d.false_share},
                 {"thin_missed_share", d.thin_missed_share},
                 {"intensity", d.intensity}};
  object[has_all_parts ? "parts" : "parts_beyond_tolerance"] =
      PartsOf(has_all_parts ? d.parts : PartsBeyond(d, tolerance));
  return object;
}

std::size_t NumBeyond(const FidelityChoice& choice) {
  return static_cast<std::size_t>(
      std::count_if(choice.held_back.begin(), choice.held_back.end(),
                    [](const auto& held) { return !held.is_within_tolerance; }));
}

}  // namespace

std::string ChoiceText(const FidelityChoice& choice) {
  const ToleranceSpec& t = choice.tolerance;
  std::string text = "fidelity auto uses " + List(EffectNames(choice.effects)) + "\n";
  if (choice.effects.footprint) {
    text += "  sub-rays:  " + std::to_string(choice.footprint_rays);
    if (!choice.footprint_of.empty()) {
      text += ", where a beam may meet " + List(choice.footprint_of);
    }
    text += "\n";
  }
  text +=
      choice.has_full_detail
          ? "  scene detail: full, as the scenario has it\n"
          : "  scene detail: auto, as the scenario has it: far away a coarser scene gives about as "
            "many echoes of about the same intensity, but other ones\n";
  text += "  tolerance: " +
          Text({t.range_m, t.missed_share, t.false_share, t.thin_missed_share, t.intensity, {}}) +
          (t.of.empty() ? "" : " of " + List(t.of)) + "\n";
  text += "  chosen:    " + Text(choice.deviation) + ", about " + Rounded(choice.instructions, 0) +
          " instructions a firing\n";
  text += "  all:       " + Text(choice.full_deviation) + ", about " +
          Rounded(choice.full_instructions, 0) + "\n";
  if (!choice.is_within_tolerance) {
    text += "  beyond the tolerance, of which all effects together reach 0.8 or more:\n" +
            PartsText(choice.deviation, t);
  }
  if (!choice.has_echoes) text += "  the reference has no echo to compare with: all are kept\n";
  for (const FidelityChoice::Measured& measured : choice.measured) {
    if (measured.is_kept) {
      text += "  needs " + measured.what + ": without it " + Text(measured.without) + "\n" +
              PartsText(measured.without, SearchTolerance(t));
      continue;
    }
    text += "  without " + measured.what +
            (measured.without == choice.full_deviation ? ": changes nothing here\n"
                                                       : ": " + Text(measured.without) + "\n");
  }
  if (!choice.without_cause.empty()) {
    text += "  without " + List(choice.without_cause) + ": no cause in this scenario\n";
  }
  if (choice.held_back.empty()) {
    return text + "  on frames held back: not measured, the run has one frame\n";
  }
  text += "  on frames held back: beyond the tolerance in " + std::to_string(NumBeyond(choice)) +
          " of " + std::to_string(choice.held_back.size()) + "\n";
  return text;
}

std::string ChoiceJson(const FidelityChoice& choice) {
  const ToleranceSpec& t = choice.tolerance;
  Json measured = Json::array();
  for (const FidelityChoice::Measured& effect : choice.measured) {
    measured.push_back({{"what", effect.what},
                        {"is_kept", effect.is_kept},
                        {"deviation_without", ObjectOf(effect.without, t)}});
  }
  Json held_back = Json::array();
  for (const FidelityChoice::HeldBack& held : choice.held_back) {
    held_back.push_back({{"frame", held.frame},
                         {"deviation", ObjectOf(held.deviation, t)},
                         {"is_within_tolerance", held.is_within_tolerance}});
  }
  Json json = {{"effects", EffectNames(choice.effects)},
               {"footprint_rays", choice.footprint_rays},
               {"detail", choice.has_full_detail ? "full" : "auto"},
               {"tolerance", ObjectOf(t)},
               {"deviation", ObjectOf(choice.deviation, t, true)},
               {"is_within_tolerance", choice.is_within_tolerance},
               {"deviation_of_all_effects", ObjectOf(choice.full_deviation, t, true)},
               {"instructions_per_firing", choice.instructions},
               {"instructions_per_firing_of_all_effects", choice.full_instructions},
               {"measured", measured},
               {"kept_unmeasured", choice.kept},
               {"left_out_without_cause", choice.without_cause},
               {"sample_frames", choice.sample_frames},
               {"has_echoes", choice.has_echoes},
               {"held_back", held_back},
               {"held_back_beyond_tolerance", NumBeyond(choice)}};
  if (!choice.footprint_of.empty()) json["footprint_of"] = choice.footprint_of;
  return json.dump(2);
}

}  // namespace railcast
