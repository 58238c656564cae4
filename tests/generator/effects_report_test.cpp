#include "generator/effects_report.h"

#include <gtest/gtest.h>

#include <cmath>

namespace railcast {
namespace {

TEST(EffectsReport, ListsThePublishedEffectsThatAreOn) {
  ScenarioSpec scenario;
  scenario.effects = {{"snow", false}, {"sensor_dropout", false}};
  scenario.weather.rain_rate_mmph = 4.0;
  scenario.weather.visibility_m = 500.0;
  EXPECT_EQ(EffectsText(scenario),
            "rung      plausibility\n"
            "          threshold: 0.1 at 200 m, fog 0.005991 per m\n"
            "          rain: 4 mm/h, dropout 0.000365 per m x rate^0.63\n"
            "          noise: sigma 0.01 m + 0.0001 x range, isotropic\n");
}

TEST(EffectsReport, SaysNothingOfTheRungWithoutEffects) {
  ScenarioSpec scenario;
  scenario.fidelity = "geometry";
  EXPECT_EQ(EffectsText(scenario), "rung      geometry\n");
}

// Of physics.md 4.1 and 4.2: at 10 mm/h 157 m of 200, 0.40 echoes a beam of 3 mrad, half of them
// within 3.7 m; at a fifth of them, 0.08.
TEST(EffectsReport, SaysWhatTheWeatherDoesToThePhysicalRungs) {
  ScenarioSpec scenario;
  scenario.fidelity = "footprint";
  scenario.lidar.beam.divergence_mrad = {3.0, 3.0};
  scenario.weather.rain_rate_mmph = 10.0;
  EXPECT_EQ(
      EffectsText(scenario),
      "rung      footprint\n"
      "          sensor_dropout: probability 0\n"
      "          surface_response\n"
      "          surface_condition: wetness 0, snow cover 0\n"
      "          extinction: fog 0 per m, rain 0.001556, snow 0, both ways\n"
      "          pulse_stretch: pulse of 5 ns, sigma 0.3183 m\n"
      "          detection: 10 % at 200 m, in this weather at 156.7 m, return mode strongest\n"
      "          detection_probability: SNR 5 at the threshold\n"
      "          clutter: rain 0.08029 echoes a beam, half within 3.735 m\n"
      "          fog_echo: none\n"
      "          sunlight: 0 klx, false alarms in 1e-06 of the firings\n"
      "          range_noise: sigma 0.015 m, at the threshold 0.035 m\n"
      "          channel_bias: sigma 0.01 m\n"
      "          pointing_jitter: sigma 0.01 deg\n"
      "          footprint: 1/e^2 width 3 x 3 mrad\n"
      "          thin_conductors\n");
}

TEST(EffectsReport, NamesTheSubRaysOfTheReferenceAndTheFogsOwnEcho) {
  ScenarioSpec scenario;
  scenario.fidelity = "reference";
  scenario.weather.visibility_m = 100.0;
  const std::string text = EffectsText(scenario);
  EXPECT_NE(text.find("dense_footprint: 256 sub-rays a beam\n          sampled_waveform\n"),
            std::string::npos);
  EXPECT_NE(text.find("at 200 m, in this weather at 47.79 m"), std::string::npos) << text;
  // Near 2 m, where half of the overlap is reached.
  EXPECT_NE(text.find("fog_echo: reflectance 0.000487"), std::string::npos) << text;
}

}  // namespace
}  // namespace railcast
