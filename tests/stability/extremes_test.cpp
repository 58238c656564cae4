// Every parameter at its limits, on all physical rungs: frames and beams must be sound, and more
// weather must never add returns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "railcast/effects.h"
#include "railcast/simulator.h"
#include "tests/stability/regime.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/frame_checks.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr std::uint16_t kSoil = 1;
constexpr std::uint16_t kPaint = 2;
constexpr std::uint16_t kSheet = 3;
constexpr std::uint16_t kBlack = 4;
constexpr std::uint16_t kSnow = 5;

MaterialLibrary Materials() {
  return MaterialLibrary(
      {{.name = "soil", .reflectivity = 0.25, .facet_slope_deg = 20.0},
       {.name = "paint", .reflectivity = 0.5, .specular_f0 = 0.04, .specular_roughness = 0.2},
       {.name = "sheet", .reflectivity = 0.2, .retroreflectance = 570.0},
       {.name = "black", .reflectivity = 0.0},
       {.name = "snow", .reflectivity = 0.9}});
}
constexpr Fidelity kPhysicalRungs[] = {Fidelity::kSurface, Fidelity::kFootprint,
                                       Fidelity::kReference};

// A tube along x of 6 mm radius, 3 m above the sensor.
Mesh LevelTube(float begin_m, float end_m) {
  Mesh tube = MakeCylinder(0.006, 0.5 * static_cast<double>(end_m - begin_m), 16);
  for (auto& vertex : tube.vertices) {
    vertex = {0.5F * (begin_m + end_m) + vertex.z(), vertex.x(), 3.0F + vertex.y()};
  }
  return tube;
}

// Ground, walls near and far, a black one, a retroreflective sheet, poles, and a wire overhead.
std::shared_ptr<SimpleWorld> MixedWorld() {
  auto world = std::make_shared<SimpleWorld>();
  const auto place = [](Mesh mesh, const Eigen::Vector3f& offset_m) {
    for (auto& vertex : mesh.vertices) vertex += offset_m;
    return mesh;
  };
  Mesh poles;
  for (int i = 1; i <= 12; ++i) {
    poles.Append(place(MakeCylinder(0.04 * i, 4.0, 12),
                       {8.0F * static_cast<float>(i), i % 2 == 0 ? 3.0F : -3.0F, 0.0F}));
  }
  world->ground.parts = {{MakeFloor(-2.0F, 400.0F), kSoil, 2},
                         {poles, kPaint, 3},
                         {place(MakeWall(30.0F, 2.0F), {0, 6, 0}), kPaint, 4},
                         {place(MakeWall(150.0F, 8.0F), {0, -20, 0}), kPaint, 5},
                         {place(MakeWall(25.0F, 1.0F), {0, -6, 0}), kSheet, 6},
                         {place(MakeWall(20.0F, 1.0F), {0, 8, 0}), kBlack, 7},
                         {LevelTube(5.0F, 200.0F), kPaint, 9, true},
                         {place(MakeWall(0.3F, 0.02F), {0, 0.1F, 0}), kPaint, 8}};
  world->wires = {{.material = kPaint,
                   .label = 9,
                   .radius_m = 0.006,
                   .points_m = {Vector3(5, 0, 3), Vector3(200, 0, 3)}}};
  return world;
}

struct Setting {
  std::string name;
  SimulatorSpec spec;
  ScanPattern pattern = MakeRaster(40.0, 16.0, 0.5);
};

Setting Base() {
  Setting setting;
  setting.spec.detector.seed = 3;
  setting.spec.snow_material = kSnow;
  setting.spec.detector.receiver.return_mode = ReturnMode::kTriple;
  return setting;
}

std::vector<Setting> Settings() {
  std::vector<Setting> settings;
  const auto add = [&](const std::string& name, const std::function<void(Setting&)>& change) {
    settings.push_back(Base());
    settings.back().name = name;
    change(settings.back());
  };
  add("visibility 1 m", [](Setting& s) { s.spec.detector.weather.visibility_m = 1.0; });
  add("visibility 0.3 m", [](Setting& s) { s.spec.detector.weather.visibility_m = 0.3; });
  add("rain 200 mm/h", [](Setting& s) { s.spec.detector.weather.rain_rate_mmph = 200.0; });
  add("snow 50 mm/h", [](Setting& s) { s.spec.detector.weather.snow_rate_mmph = 50.0; });
  add("rain of a trace", [](Setting& s) { s.spec.detector.weather.rain_rate_mmph = 1e-6; });
  add("most clutter", [](Setting& s) {
    s.spec.detector.weather.rain_rate_mmph = 200.0;
    s.spec.detector.weather.snow_rate_mmph = 20.0;
    s.spec.detector.receiver.clutter_gain = 10.0;
  });
  add("a ray", [](Setting& s) { s.spec.detector.beam.divergence_mrad = {0.0, 0.0}; });
  add("a line", [](Setting& s) { s.spec.detector.beam.divergence_mrad = {17.453, 0.0}; });
  add("1 degree", [](Setting& s) { s.spec.detector.beam.divergence_mrad = {17.453, 17.453}; });
  add("shortest pulse", [](Setting& s) { s.spec.detector.beam.pulse_length_ns = 0.5; });
  add("longest pulse", [](Setting& s) { s.spec.detector.beam.pulse_length_ns = 100.0; });
  add("one beam", [](Setting& s) { s.pattern = MakeRaster(1.0, 1.0, 1.0); });
  add("range 1 m", [](Setting& s) { s.spec.detector.range_max_m = 1.0; });
  add("range 10 km", [](Setting& s) {
    s.spec.detector.range_max_m = 10'000.0;
    s.spec.detector.receiver.range_at_10_percent_m = 10'000.0;
  });
  for (const double rate_hz : {1.0, 200.0}) {
    add("rate " + std::to_string(rate_hz), [&](Setting& s) {
      s.pattern = BuildScanPattern({rate_hz, RasterSpec{40.0, 16.0, 0.5, RasterOrder::kColumns}});
    });
  }
  add("sun in the face", [](Setting& s) {
    s.spec.detector.weather.sun = {
        .illuminance_klx = 150.0, .azimuth_deg = 0.0, .elevation_deg = 0.0};
  });
  add("soaked and white", [](Setting& s) {
    s.spec.detector.weather.wetness = 1.0;
    s.spec.detector.weather.snow_cover = 1.0;
  });
  add("noise of 10 m", [](Setting& s) {
    s.spec.detector.receiver.range_noise_floor_m = 10.0;
    s.spec.detector.receiver.range_noise_scale_m = 10.0;
    s.spec.detector.receiver.channel_bias_sigma_m = 10.0;
    s.spec.detector.receiver.pointing_jitter_deg = 1.0;
  });
  return settings;
}

Frame Scan(const Setting& setting, Fidelity rung) {
  static const auto scenes = MakeSceneStore(MixedWorld(), Materials());
  SimulatorSpec spec = setting.spec;
  spec.detector.effects = EffectsOfRung(rung);
  return FrameBy(Simulator(scenes, setting.pattern, Materials(), spec, 0), 2);
}

// In addition to what holds on every rung: powers and shares are not negative, and the surfaces
// that one beam hits take no more than all of its power.
void ExpectSoundBeams(const Frame& frame, const SimulatorSpec& spec) {
  ExpectSoundSlots(frame, static_cast<float>(spec.detector.range_min_m),
                   static_cast<float>(spec.detector.range_max_m));
  for (std::size_t first = 0; first < frame.num_slots(); first += frame.returns) {
    double share = 0.0;
    for (std::size_t slot = first; slot < first + frame.returns; ++slot) {
      const bool is_seen = frame.outcome[slot] == Outcome::kReturned ||
                           frame.outcome[slot] == Outcome::kBelowThreshold;
      if (!is_seen || frame.material[slot] == 0) continue;
      const bool is_sound = frame.power_ratio[slot] >= 0.0F &&
                            std::isfinite(frame.power_ratio[slot]) &&
                            frame.intensity[slot] >= 0.0F && frame.footprint_share[slot] >= 0.0F;
      if (!is_sound) FAIL() << "slot " << slot << " has no sound power, intensity or share";
      share += static_cast<double>(frame.footprint_share[slot]);
    }
    if (!(share <= 1.0 + 1e-5)) FAIL() << "the shares of slot " << first << " sum up to " << share;
  }
}

TEST(Extremes, GiveSoundFramesOnEveryRung) {
  RecordRegime("every parameter at its limits",
               {"-", std::to_string(Settings().size()) +
                         " settings: finite points, shares of a beam that add up to 1 at most"});
  for (const Setting& setting : Settings()) {
    for (const Fidelity rung : kPhysicalRungs) {
      SCOPED_TRACE(setting.name + " on " + std::string(NameOf(rung)));
      const Frame frame = Scan(setting, rung);
      ExpectSoundBeams(frame, setting.spec);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(Extremes, AllOfABeamMeetsAWallThatFillsIt) {
  const auto world = WorldOfParts({{MakeWall(20.0F, 100.0F), kPaint, 1}});
  for (const double divergence_mrad : {0.0, 3.0, 17.453}) {
    for (const int num_rays : {16, 256, 1000}) {
      SimulatorSpec spec{.detector = {.effects = {.surface_response = true,
                                                  .footprint = true,
                                                  .dense_footprint = true,
                                                  .sampled_waveform = true}}};
      spec.detector.beam.divergence_mrad = {divergence_mrad, divergence_mrad};
      spec.detector.beam.reference_rays = num_rays;
      const Frame frame =
          FrameBy(Simulator(world, MakeRaster(10.0, 10.0, 1.0), Materials(), spec, 0));
      for (const float share : frame.footprint_share) {
        // Each addition may round by half a step of 6e-8.
        ASSERT_NEAR(static_cast<double>(share), 1.0, 6e-8 * (num_rays + 1)) << num_rays;
      }
    }
  }
}

TEST(Extremes, NothingReturnsFromABlackSurface) {
  for (const Fidelity rung : kPhysicalRungs) {
    const auto world = WorldOfParts({{MakeWall(5.0F, 100.0F), kBlack, 1}});
    // Even at night, one firing in a million is a false alarm, so none is expected among these 400.
    const Frame frame = FrameBy(Simulator(world, MakeRaster(10.0, 10.0, 0.5), Materials(),
                                          {.detector = {.effects = EffectsOfRung(rung)}}, 0));
    // Phi(-5) = 3e-7 of them are detected nevertheless.
    EXPECT_EQ(std::count(frame.outcome.begin(), frame.outcome.end(), Outcome::kBelowThreshold), 400)
        << NameOf(rung);
    EXPECT_EQ(*std::max_element(frame.power_ratio.begin(), frame.power_ratio.end()), 0.0F)
        << NameOf(rung);
  }
}

// A parameter of the weather, from none to its upper limit.
struct Ramp {
  std::string name;
  std::function<void(WeatherSpec&, double)> set;
  std::vector<double> values;
};

std::vector<Ramp> Ramps() {
  return {
      {"rain",
       [](WeatherSpec& w, double v) { w.rain_rate_mmph = v; },
       {0, 0.1, 1, 5, 10, 25, 50, 100, 200}},
      {"fog",
       [](WeatherSpec& w, double v) { w.fog_density_per_m = v; },
       {0, 1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 3}},
      {"dry snow",
       [](WeatherSpec& w, double v) { w.snow_rate_mmph = v; },
       {0, 0.1, 0.5, 1, 2.5, 5, 10, 50}},
      {"wetness", [](WeatherSpec& w, double v) { w.wetness = v; }, {0, 0.1, 0.3, 0.5, 0.7, 0.9, 1}},
      {"sun",
       [](WeatherSpec& w, double v) { w.sun.illuminance_klx = v; },
       {0, 1, 10, 30, 60, 100, 150}}};
}

// The last echo is reported, because raindrops lie in front of surfaces and would take their place
// otherwise.
TEST(Extremes, MoreWeatherNeverGivesMoreSurfaceReturns) {
  for (const Fidelity rung : kPhysicalRungs) {
    for (const Ramp& ramp : Ramps()) {
      std::vector<std::size_t> counts;
      for (const double value : ramp.values) {
        Setting setting = Base();
        setting.spec.detector.receiver.return_mode = ReturnMode::kLast;
        setting.spec.detector.receiver.range_at_10_percent_m = 100.0;
        ramp.set(setting.spec.detector.weather, value);
        const Frame frame = Scan(setting, rung);
        counts.push_back(static_cast<std::size_t>(
            std::count(frame.outcome.begin(), frame.outcome.end(), Outcome::kReturned)));
      }
      EXPECT_TRUE(std::is_sorted(counts.rbegin(), counts.rend()))
          << NameOf(rung) << ", " << ramp.name;
      EXPECT_LT(counts.back(), counts.front()) << NameOf(rung) << ", " << ramp.name;
    }
  }
}

// A pattern may have 2^24 firings; a frame of ten million takes a gigabyte.
TEST(Extremes, TenMillionBeamsMakeOneSoundFrame) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "too slow under a sanitizer";
#endif
  const auto world = WorldOfParts({{MakeFloor(-2.0F, 400.0F), kSoil, 2}});
  SimulatorSpec spec{.detector = {.effects = EffectsOfRung(Fidelity::kSurface)}};
  Simulator simulator(world, MakeRaster(360.0, 69.5, 0.05), Materials(), spec, 0);
  ASSERT_GE(simulator.pattern().num_firings(), 10'000'000U);
  const Frame frame = FrameBy(simulator);
  ExpectSoundBeams(frame, spec);
  // Beams that look down by more than half a degree meet the ground within range.
  const auto num_below = static_cast<std::ptrdiff_t>(7200) * (1390 / 2 - 10);
  EXPECT_GT(std::count_if(frame.label.begin(), frame.label.end(),
                          [](std::uint32_t label) { return label == 2; }),
            num_below);
}

}  // namespace
}  // namespace railcast
