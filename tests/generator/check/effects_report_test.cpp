#include "generator/check/check_report.h"

#include <gtest/gtest.h>

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
  scenario.fidelity = Fidelity::kGeometry;
  EXPECT_EQ(EffectsText(scenario), "rung      geometry\n");
}

TEST(EffectsReport, TellsTheWindOnEveryRung) {
  ScenarioSpec scenario;
  scenario.fidelity = Fidelity::kGeometry;
  scenario.weather.wind_speed_mps = 7.5;
  EXPECT_EQ(EffectsText(scenario),
            "rung      geometry\n"
            "wind      7.5 m/s from 180 deg: trees and wires sway, fog drifts\n");
}

TEST(EffectsReport, NamesTheKeysOfTheWeatherThatNoEffectReads) {
  ScenarioSpec scenario;
  scenario.weather.rain_rate_mmph = 4.0;
  scenario.weather.rain_drop_sizes = RainDrops::kDrizzle;
  scenario.weather.wetness = 0.5;
  scenario.weather.snow_cover = 0.25;
  scenario.weather.sun.illuminance_klx = 80.0;
  const auto last_line = [&] {
    const std::string text = EffectsText(scenario);
    return text.substr(text.rfind('\n', text.size() - 2) + 1);
  };
  EXPECT_EQ(last_line(),
            "          no effect that is on reads these keys of weather: rain_drop_sizes, wetness, "
            "snow_cover, sun\n");
  scenario.fidelity = Fidelity::kGeometry;
  EXPECT_EQ(last_line(),
            "          no effect that is on reads these keys of weather: rain_rate_mmph, "
            "rain_drop_sizes, wetness, snow_cover, sun\n");
  scenario.fidelity = Fidelity::kSurface;
  scenario.weather.rain_dropout_per_m = 4e-4;
  scenario.effects["sunlight"] = false;
  EXPECT_EQ(
      last_line(),
      "          no effect that is on reads these keys of weather: rain_dropout_per_m, sun\n");
  scenario.weather = {};
  EXPECT_EQ(last_line(), "          channel_gain: sigma 0 %\n");
}

TEST(EffectsReport, CountsAmongTheReadersOfTheWeatherTheCamera) {
  ScenarioSpec scenario;
  scenario.weather.sun.illuminance_klx = 80.0;
  EXPECT_NE(EffectsText(scenario).find("reads these keys of weather: sun\n"), std::string::npos);
  scenario.camera = CameraSpec{.width_px = 64, .height_px = 32, .horizontal_fov_deg = 60.0};
  EXPECT_EQ(EffectsText(scenario).find("reads these keys"), std::string::npos);
}

// From docs/physics.md 4.1 and 4.2: at 10 mm/h, 157 m of 200 m, and 0.40 echoes per beam of 3 mrad,
// half of them within 3.7 m; a clutter_gain of 0.2 makes them 0.08.
TEST(EffectsReport, SaysWhatTheWeatherDoesToThePhysicalRungs) {
  ScenarioSpec scenario;
  scenario.fidelity = Fidelity::kFootprint;
  scenario.lidar.beam.divergence_mrad = {3.0, 3.0};
  scenario.weather.rain_rate_mmph = 10.0;
  EXPECT_EQ(
      EffectsText(scenario),
      "rung      footprint\n"
      "          sensor_dropout: probability 0\n"
      "          surface_response\n"
      "          surface_condition: wetness 1, snow cover 0\n"
      "          texture: none: no material has one\n"
      "          extinction: fog 0 per m, rain 0.001556, snow 0, both ways\n"
      "          pulse_stretch: pulse of 5 ns, sigma 0.3183 m\n"
      "          mirror_paths: none: no puddles and nothing smooth\n"
      "          detection: 10 % at 200 m, in this weather at 156.7 m, return mode strongest\n"
      "          detection_probability: SNR 5 at the threshold\n"
      "          clutter: rain 0.08029 echoes a beam, half within 3.735 m\n"
      "          fog_echo: none\n"
      "          spray: none\n"
      "          sunlight: 0 klx, false alarms in 1e-06 of the firings\n"
      "          range_noise: sigma 0.015 m, at the threshold 0.035 m\n"
      "          channel_bias: sigma 0.01 m\n"
      "          pointing_jitter: sigma 0.01 deg\n"
      "          dead_time: 0 ns, 0 m behind an echo\n"
      "          cover: none\n"
      "          halo: share of 0 at 1 deg\n"
      "          range_walk: 0 m at the threshold\n"
      "          interference: 0 pulses per s, false echoes in 0 of the firings\n"
      "          saturation: none\n"
      "          ghost: none\n"
      "          intensity_noise: sigma 0 %\n"
      "          channel_gain: sigma 0 %\n"
      "          edge_loss: 0 % of the beams halved by a high edge\n"
      "          footprint: 1/e^2 width 3 x 3 mrad, 64 sub-rays\n"
      "          thin_conductors\n");
}

TEST(EffectsReport, NamesTheSubRaysOfTheReferenceAndTheFogsOwnEcho) {
  ScenarioSpec scenario;
  scenario.fidelity = Fidelity::kReference;
  scenario.weather.visibility_m = 100.0;
  const std::string text = EffectsText(scenario);
  EXPECT_NE(text.find("dense_footprint: 256 sub-rays a beam\n          sampled_waveform\n"),
            std::string::npos);
  EXPECT_NE(text.find("at 200 m, in this weather at 47.79 m"), std::string::npos) << text;
  // docs/physics.md 4.3 has 0.88 at 7.2 m; gates lie on both sides of it.
  EXPECT_NE(
      text.find("fog_echo: at most 0.8797 of the threshold at 7.307 m, patches of sigma 0.2\n"),
      std::string::npos)
      << text;
}

// A tenth of the window under drops of 3 mm leaves 0.9^((13 / 3)^2) of the beams untouched. 2 x
// 299.5 m are 1.998 us, and 0.5 of the spray's extinction is left on ground that is half wet.
TEST(EffectsReport, SaysWhatTheSensorItselfDoes) {
  ScenarioSpec scenario;
  scenario.fidelity = Fidelity::kSurface;
  scenario.lidar.cover.drop_coverage = 0.1;
  scenario.lidar.receiver.halo_share_at_1_deg = 1e-6;
  scenario.lidar.receiver.range_walk_m = 0.05;
  scenario.lidar.receiver.foreign_pulses_hz = 1000.0;
  scenario.lidar.receiver.saturation_power_ratio = 500.0;
  scenario.lidar.receiver.ghost_reflectance = 0.1;
  scenario.weather.wetness = 0.5;
  scenario.weather.spray_extinction_per_m = 0.2;
  const std::string text = EffectsText(scenario);
  for (const char* line :
       {"          spray: extinction 0.1 per m at a train of 100 km/h\n",
        "          cover: drops 10 %, dirt 0 %, snow 0 %, untouched are 13.83 % of the beams\n",
        "          halo: share of 1e-06 at 1 deg\n",
        "          range_walk: 0.05 m at the threshold\n",
        "          interference: 1000 pulses per s, false echoes in 0.001996 of the firings\n",
        "          saturation: at 500 times the threshold\n",
        "          ghost: share of 0.1 of the light in 10 mm goes back\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
  }
}

TEST(EffectsReport, SaysWhatMirrors) {
  ScenarioSpec scenario;
  scenario.fidelity = Fidelity::kSurface;
  scenario.materials = {{.name = "glass", .height_rms_um = 0.002}};
  const auto line = [&] {
    const std::string text = EffectsText(scenario);
    const std::size_t begin = text.find("mirror_paths: ");
    return text.substr(begin, text.find('\n', begin) - begin);
  };
  EXPECT_EQ(line(), "mirror_paths: none: no puddles and nothing smooth");
  ObjectSpec pane;
  pane.material = "glass";
  scenario.world.objects = {pane};
  EXPECT_EQ(line(), "mirror_paths: smooth surfaces");
  scenario.weather.puddle_share = 0.3;
  EXPECT_EQ(line(), "mirror_paths: puddles on 30 % of the level ground, smooth surfaces");
  // Wagons are painted without a word in the scenario.
  scenario.world.objects.clear();
  scenario.weather.puddle_share = 0.0;
  for (const MeshPartSpec& part : TypeNamed("open_wagon").model->parts) {
    scenario.materials = {{.name = part.material.value(), .height_rms_um = 0.05}};
    EXPECT_EQ(line(), "mirror_paths: smooth surfaces") << *part.material;
  }
}

}  // namespace
}  // namespace railcast
