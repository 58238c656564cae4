// The table rows of the effects of the sensor itself: its window, its stray light, the way it times
// echoes, and other lidars.
#include <cmath>

#include "core/base/text.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/clutter/clutter.h"
#include "core/detect/clutter/cover.h"
#include "core/detect/detector/effect_table.h"
#include "core/detect/kernels/echo_power.h"
#include "core/detect/kernels/measurement.h"

namespace railcast {
namespace {

using SensorLoop = std::function<void(DetectTile&)>;

// Cover.

std::string CoverText(const DetectorSpec& spec) {
  if (!HasCover(spec)) return "none";
  const CoverSpec& cover = spec.cover;
  return "drops " + NumberText(100.0 * cover.drop_coverage) + " %, dirt " +
         NumberText(100.0 * cover.dirt_coverage) + " %, snow " +
         NumberText(100.0 * cover.snow_coverage) + " %, untouched are " +
         ShortText(100.0 * UntouchedShare(cover)) + " % of the beams";
}

SensorLoop CoverLossLoop(const DetectorSpec& /*spec*/, const Kernels& kernels) {
  return kernels.cover_loss;
}

SensorLoop BlameCoverLoop(const DetectorSpec& /*spec*/, const Kernels& kernels) {
  return kernels.blame_cover;
}

// Range walk.

bool HasRangeWalk(const DetectorSpec& spec) {
  return spec.receiver.range_walk_m > 0.0;
}

std::string RangeWalkText(const DetectorSpec& spec) {
  return NumberText(spec.receiver.range_walk_m) + " m at the threshold";
}

SensorLoop RangeWalkLoop(const DetectorSpec& spec, const Kernels& kernels) {
  return [range_walk_m = static_cast<float>(spec.receiver.range_walk_m),
          apply = kernels.range_walk](DetectTile& tile) { apply(tile, range_walk_m); };
}

// Halo acts between tracing and detection, since it needs the echoes of all beams.

bool HasHalo(const DetectorSpec& spec) {
  return spec.receiver.halo_share_at_1_deg > 0.0;
}

std::string HaloText(const DetectorSpec& spec) {
  return "share of " + NumberText(spec.receiver.halo_share_at_1_deg) + " at 1 deg";
}

// Interference acts after detection.

bool HasInterference(const DetectorSpec& spec) {
  return spec.receiver.foreign_pulses_hz > 0.0;
}

std::string InterferenceText(const DetectorSpec& spec) {
  const double rate_hz = spec.receiver.foreign_pulses_hz;
  return NumberText(rate_hz) + " pulses per s, false echoes in " +
         ShortText(-std::expm1(-rate_hz * ListeningTime_s(spec))) + " of the firings";
}

// Saturation.

bool HasSaturation(const DetectorSpec& spec) {
  return spec.receiver.saturation_power_ratio.has_value();
}

std::string SaturationText(const DetectorSpec& spec) {
  const auto& ratio = spec.receiver.saturation_power_ratio;
  return ratio ? "at " + NumberText(*ratio) + " times the threshold" : "none";
}

SensorLoop SaturationLoop(const DetectorSpec& spec, const Kernels& kernels) {
  const SaturationParameters parameters{
      static_cast<float>(spec.receiver.saturation_power_ratio.value()),
      static_cast<float>(PulseSigma_m(spec.beam))};
  return [=, apply = kernels.saturation](DetectTile& tile) { apply(tile, parameters); };
}

// Ghosts are added before detection.

bool HasGhost(const DetectorSpec& spec) {
  return spec.receiver.ghost_reflectance > 0.0;
}

std::string GhostText(const DetectorSpec& spec) {
  if (!HasGhost(spec)) return "none";
  return "share of " + NumberText(spec.receiver.ghost_reflectance) + " of the light in " +
         NumberText(spec.cover.aperture_mm) + " mm goes back";
}

// Intensity noise and channel gain.

float LogSigma(double relative_sigma) {
  return static_cast<float>(std::sqrt(std::log1p(relative_sigma * relative_sigma)));
}

bool HasIntensityNoise(const DetectorSpec& spec) {
  return spec.receiver.intensity_noise > 0.0;
}

std::string IntensityNoiseText(const DetectorSpec& spec) {
  return "sigma " + NumberText(100.0 * spec.receiver.intensity_noise) + " %";
}

SensorLoop IntensityNoiseLoop(const DetectorSpec& spec, const Kernels& kernels) {
  const IntensityErrorParameters parameters{.seed = spec.seed,
                                            .log_sigma = LogSigma(spec.receiver.intensity_noise)};
  return [=, apply = kernels.intensity_noise](DetectTile& tile) { apply(tile, parameters); };
}

bool HasChannelGain(const DetectorSpec& spec) {
  return spec.receiver.channel_gain > 0.0 || spec.receiver.channel_gain_variation > 0.0;
}

std::string ChannelGainText(const DetectorSpec& spec) {
  const double by_range = spec.receiver.channel_gain_variation;
  return "sigma " + NumberText(100.0 * spec.receiver.channel_gain) + " %" +
         (by_range > 0.0 ? ", by range " + NumberText(100.0 * by_range) + " %" : "");
}

SensorLoop ChannelGainLoop(const DetectorSpec& spec, const Kernels& kernels) {
  const ReceiverSpec& receiver = spec.receiver;
  const IntensityErrorParameters parameters{
      .seed = spec.seed,
      .log_sigma = LogSigma(receiver.channel_gain),
      .varying_log_sigma = LogSigma(receiver.channel_gain_variation),
      .log_range_ratio = static_cast<float>(kGainLogRange)};
  const auto apply =
      receiver.channel_gain_variation > 0.0 ? kernels.channel_gain_variation : kernels.channel_gain;
  return [=](DetectTile& tile) { apply(tile, parameters); };
}

// Edge loss acts before detection, since it needs all echoes of a beam.

bool HasEdgeLoss(const DetectorSpec& spec) {
  return spec.receiver.edge_loss > 0.0 && IsWide(spec.beam);
}

std::string EdgeLossText(const DetectorSpec& spec) {
  return NumberText(100.0 * spec.receiver.edge_loss) + " % of the beams halved by a high edge";
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): a table
std::vector<Effect> SensorEffects() {
  const std::vector<Fidelity> physical{Fidelity::kSurface, Fidelity::kFootprint,
                                       Fidelity::kReference};
  return {
      {.name = "cover",
       .is_on = &EffectSet::cover,
       .rungs = physical,
       .has_cause = HasCover,
       .text = &CoverText,
       .loops = {{StepOrder::kCover, &CoverLossLoop}, {StepOrder::kCoverBlame, &BlameCoverLoop}}},
      {.name = "halo",
       .is_on = &EffectSet::halo,
       .rungs = physical,
       .has_cause = HasHalo,
       .text = &HaloText,
       .labels = {{"halo", &ClutterLabels::halo}},
       .acts_between_beams = true},
      {.name = "range_walk",
       .is_on = &EffectSet::range_walk,
       .rungs = physical,
       .has_cause = HasRangeWalk,
       .text = &RangeWalkText,
       .loops = {{StepOrder::kRangeWalk, &RangeWalkLoop}}},
      {.name = "interference",
       .is_on = &EffectSet::interference,
       .rungs = physical,
       .has_cause = HasInterference,
       .text = &InterferenceText,
       .labels = {{"false_alarm", &ClutterLabels::false_alarm}}},
      {.name = "saturation",
       .is_on = &EffectSet::saturation,
       .rungs = physical,
       .has_cause = HasSaturation,
       .text = &SaturationText,
       .loops = {{StepOrder::kSaturation, &SaturationLoop}}},
      {.name = "ghost",
       .is_on = &EffectSet::ghost,
       .rungs = physical,
       .has_cause = HasGhost,
       .text = &GhostText,
       .labels = {{"ghost", &ClutterLabels::ghost}}},
      {.name = "intensity_noise",
       .is_on = &EffectSet::intensity_noise,
       .rungs = physical,
       .has_cause = HasIntensityNoise,
       .text = &IntensityNoiseText,
       .loops = {{StepOrder::kIntensity, &IntensityNoiseLoop}},
       .is_measurement_error = true},
      {.name = "channel_gain",
       .is_on = &EffectSet::channel_gain,
       .rungs = physical,
       .has_cause = HasChannelGain,
       .text = &ChannelGainText,
       .loops = {{StepOrder::kIntensity, &ChannelGainLoop}},
       .is_measurement_error = true},
      {.name = "edge_loss",
       .is_on = &EffectSet::edge_loss,
       .rungs = {Fidelity::kFootprint, Fidelity::kReference},
       .has_cause = HasEdgeLoss,
       .text = &EdgeLossText},
  };
}

}  // namespace railcast
