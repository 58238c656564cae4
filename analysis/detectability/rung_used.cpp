#include "analysis/detectability/detect_report.h"

#include <algorithm>

#include "railcast/effects.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

std::optional<bool> HasWideBeams(const RecordingInfo& run) {
  if (run.scenario->fidelity != Fidelity::kAuto) return SwitchedEffects(*run.scenario).footprint;
  // Fidelity auto always chooses something: the effects that have a cause, jitter for example.
  if (!run.origin || run.origin->chosen_effects.empty()) return {};
  const std::vector<std::string>& chosen = run.origin->chosen_effects;
  return std::ranges::find(chosen, "footprint") != chosen.end();
}

}  // namespace

std::string RungUsed::InWords() const {
  if (!has_wide_beams) {
    return name + ": not known what was chosen, as a run is unfinished or its clouds are merged";
  }
  return name + (*has_wide_beams ? ": beams with a width" : ": one ray per beam");
}

// tests/stability/far_targets_test.cpp holds the figures.
std::string RungUsed::Warning() const {
  if (has_wide_beams.value_or(false)) return {};
  const std::string begin =
      has_wide_beams ? "Rung " + name + " sends one ray into each beam"
                     : "If the rung that was chosen sends one ray into each beam, take care";
  return begin +
         ": the points on objects far off are wrong, and with them the distance of detection. Of a "
         "person before the sky, rung surface gives 0.62 of the reference's points at 100 m and "
         "0.48 at 150 m (published raster), because beams whose centre passes beside the person "
         "see nothing; where the reference hardly detects the person, it gives several times as "
         "many (VLP-32C at 150 m), because a beam whose centre meets the person counts as filled. "
         "Use footprint for a verdict.";
}

RungUsed RungOf(const std::vector<RecordingInfo>& runs) {
  RungUsed rung{std::string(NameOf(runs.front().scenario->fidelity)), true};
  for (const RecordingInfo& run : runs) {
    const std::optional<bool> has_wide_beams = HasWideBeams(run);
    // One run with single rays is enough for a warning.
    if (rung.has_wide_beams.value_or(true)) rung.has_wide_beams = has_wide_beams;
  }
  return rung;
}

}  // namespace railcast
