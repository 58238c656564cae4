#include "analysis/detect_options.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/program/command_line.h"

namespace railcast {
namespace {

/// Reads "3/5" into the rule; returns false if the text is not of this form.
bool ReadFrames(std::string_view text, DetectionRule& rule) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return false;
  const auto some = ParseNumber<std::uint32_t>(text.substr(0, slash));
  const auto all = ParseNumber<std::uint32_t>(text.substr(slash + 1));
  if (!some || !all || *some < 1 || *some > *all) return false;
  rule.min_frames = *some;
  rule.of_frames = *all;
  return true;
}

}  // namespace

void AddBrakingOptions(ProgramOptions& command, BrakingSpec& braking) {
  command
      .AddOption("--reaction-s", braking.reaction_s, "Seconds from the detection to full braking")
      .Check(Number({0.0, 60.0}))
      .ShowDefault();
  command
      .AddOption(
          "--deceleration-mps2", braking.deceleration_mps2,
          "Braking deceleration on the level: 0.3 slow freight, 0.5 shunting, 1.0 multiple unit")
      .Check(Number({0.01, 10.0}))
      .ShowDefault();
  command.AddOption("--margin-m", braking.margin_m, "Metres to be left before the object")
      .Check(Number({0.0, 1000.0}))
      .ShowDefault();
}

DetectSpec RuleOptions::Spec() const {
  DetectSpec result = spec;
  (void)ReadFrames(frames, result.rule);
  if (speed_kmph) result.speed_mps = MpsFromKmph(*speed_kmph);
  return result;
}

void AddRuleOptions(ProgramOptions& command, RuleOptions& options) {
  const auto check = [](const std::string& text) {
    DetectionRule trial;
    return ReadFrames(text, trial) ? std::string()
                                   : "must be K/N with 1 <= K <= N (got " + text + ")";
  };
  command
      .AddOption("--frames", options.frames,
                 "An object is detected when it is seen in K of N consecutive frames")
      .Check({check, "K/N"})
      .ShowDefault();
  AddBrakingOptions(command, options.spec.braking);
  command
      .AddOption("--speed-kmph", options.speed_kmph,
                 "Speed to brake from, instead of the vehicle's own at the detection")
      .Check(Number({0.0, 500.0}));
}

}  // namespace railcast
