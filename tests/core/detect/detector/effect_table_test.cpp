#include "core/detect/detector/effect_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace railcast {
namespace {

using testing::UnorderedElementsAre;

/// A spec in which no effect has a cause: clear air, dry ground, nothing smooth, a receiver and a
/// published model without errors, a beam without width.
DetectorSpec WithoutCauses() {
  DetectorSpec spec;
  spec.plausibility.noise_sigma0_m = spec.plausibility.noise_sigma1 = 0.0;
  spec.receiver.range_noise_floor_m = spec.receiver.range_noise_scale_m = 0.0;
  spec.receiver.channel_bias_sigma_m = spec.receiver.pointing_jitter_deg = 0.0;
  spec.beam.divergence_mrad = {0.0, 0.0};
  spec.has_mirrors = spec.has_texture = false;
  return spec;
}

// The effects that act on every beam that meets a surface.
const std::set<std::string> kAlways = {"threshold", "surface_response", "pulse_stretch",
                                       "detection", "detection_probability"};

std::set<std::string> CausedBeyondAlways(const DetectorSpec& spec) {
  std::set<std::string> names;
  for (const Effect& effect : EffectTable()) {
    if (effect.has_cause(spec) && !kAlways.contains(effect.name)) names.insert(effect.name);
  }
  return names;
}

template <class Change>
std::set<std::string> CausedBy(const Change& change) {
  DetectorSpec spec = WithoutCauses();
  change(spec);
  return CausedBeyondAlways(spec);
}

TEST(EffectTable, SwitchesEachEffectByItsOwnFlag) {
  EffectSet on;
  std::set<std::string> names;
  for (const Effect& effect : EffectTable()) {
    EXPECT_FALSE(on.*effect.is_on) << effect.name;
    on.*effect.is_on = true;
    EXPECT_TRUE(names.insert(effect.name).second) << effect.name;
    EXPECT_EQ(FindEffect(effect.name), &effect);
  }
  EXPECT_EQ(EffectNames(on), EffectNames());
  EXPECT_EQ(FindEffect("rian"), nullptr);
}

TEST(EffectTable, GivesNoEffectTheCauseOfAnother) {
  EXPECT_THAT(CausedBy([](DetectorSpec&) {}), UnorderedElementsAre());
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.weather.rain_rate_mmph = 1.0; }),
              UnorderedElementsAre("rain", "extinction", "clutter", "surface_condition"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) {
                s.weather.rain_rate_mmph = 1.0;
                s.weather.wetness = 0.0;
              }),
              UnorderedElementsAre("rain", "extinction", "clutter"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.weather.snow_rate_mmph = 1.0; }),
              UnorderedElementsAre("snow", "extinction", "clutter"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.weather.visibility_m = 100.0; }),
              UnorderedElementsAre("extinction", "fog_echo"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.weather.wetness = 0.5; }),
              UnorderedElementsAre("surface_condition"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.weather.sun.illuminance_klx = 1.0; }),
              UnorderedElementsAre("sunlight"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.plausibility.dropout_probability = 0.1; }),
              UnorderedElementsAre("sensor_dropout"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.plausibility.noise_sigma1 = 1e-4; }),
              UnorderedElementsAre("noise"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.receiver.range_noise_scale_m = 0.1; }),
              UnorderedElementsAre("range_noise"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.receiver.channel_bias_sigma_m = 0.1; }),
              UnorderedElementsAre("channel_bias"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.receiver.pointing_jitter_deg = 0.1; }),
              UnorderedElementsAre("pointing_jitter"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.plausibility.dropout_per_m = 1e-4; }),
              UnorderedElementsAre("sensor_dropout"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.plausibility.dark_dropout_probability = 0.1; }),
              UnorderedElementsAre("sensor_dropout"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.receiver.dead_time_ns = 8.0; }),
              UnorderedElementsAre("dead_time"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.weather.spray_extinction_per_m = 0.1; }),
              UnorderedElementsAre());
  EXPECT_THAT(CausedBy([](DetectorSpec& s) {
                s.weather.spray_extinction_per_m = 0.1;
                s.weather.snow_cover = 0.5;
              }),
              UnorderedElementsAre("spray", "surface_condition"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.weather.puddle_share = 0.1; }),
              UnorderedElementsAre("mirror_paths"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.has_mirrors = true; }),
              UnorderedElementsAre("mirror_paths"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.has_texture = true; }),
              UnorderedElementsAre("texture"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.cover.snow_coverage = 0.1; }),
              UnorderedElementsAre("cover"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.receiver.halo_share_at_1_deg = 1e-6; }),
              UnorderedElementsAre("halo"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.receiver.range_walk_m = 0.1; }),
              UnorderedElementsAre("range_walk"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.receiver.foreign_pulses_hz = 1.0; }),
              UnorderedElementsAre("interference"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.receiver.saturation_power_ratio = 1e3; }),
              UnorderedElementsAre("saturation"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.receiver.ghost_reflectance = 0.1; }),
              UnorderedElementsAre("ghost"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.receiver.intensity_noise = 0.1; }),
              UnorderedElementsAre("intensity_noise"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.receiver.channel_gain = 0.1; }),
              UnorderedElementsAre("channel_gain"));
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.receiver.channel_gain_variation = 0.1; }),
              UnorderedElementsAre("channel_gain"));
  // It needs a beam that meets two surfaces.
  EXPECT_THAT(CausedBy([](DetectorSpec& s) { s.receiver.edge_loss = 0.1; }),
              UnorderedElementsAre());
  EXPECT_THAT(
      CausedBy([](DetectorSpec& s) { s.beam.divergence_mrad[1] = 1.0; }),
      UnorderedElementsAre("footprint", "thin_conductors", "dense_footprint", "sampled_waveform"));
}

TEST(EffectTable, KnowsThePhysicalEffects) {
  EXPECT_FALSE(IsPhysical({}));
  EXPECT_FALSE(IsPhysical(
      {.threshold = true, .rain = true, .snow = true, .noise = true, .sensor_dropout = true}));
  EXPECT_TRUE(IsPhysical({.extinction = true}));
  EXPECT_TRUE(IsPhysical({.threshold = true, .sampled_waveform = true}));
}

TEST(EffectTable, LeavesRandomErrorsOfMeasurementOutOfComparisonsOnly) {
  std::vector<std::string> names;
  for (const Effect& effect : EffectTable()) {
    if (effect.is_measurement_error) names.emplace_back(effect.name);
  }
  EXPECT_THAT(names, testing::ElementsAre("noise", "range_noise", "channel_bias", "intensity_noise",
                                          "channel_gain"));
}

/// Labels of these names with the identifiers 1, 2 and so on.
LabelTable Labels(const std::vector<std::string>& names) {
  std::vector<Label> labels;
  for (const std::string& name : names) {
    Label& label = labels.emplace_back();
    label.id = static_cast<std::uint32_t>(labels.size());
    label.name = name;
  }
  return LabelTable(labels);
}

TEST(ClutterLabelsOf, AsksForALabelOnlyWhereItsEffectIsOnAndHasACause) {
  DetectorSpec spec;
  EXPECT_EQ(ClutterLabelsOf(Labels({}), spec).halo, 0U);
  spec.effects.halo = true;
  EXPECT_EQ(ClutterLabelsOf(Labels({}), spec).halo, 0U);
  spec.receiver.halo_share_at_1_deg = 1e-6;
  EXPECT_THROW(static_cast<void>(ClutterLabelsOf(Labels({"snow"}), spec)), InputError);
  EXPECT_EQ(ClutterLabelsOf(Labels({"snow", "halo"}), spec).halo, 2U);
  spec.effects.halo = false;
  EXPECT_EQ(ClutterLabelsOf(Labels({"halo"}), spec).halo, 1U) << "it may be switched on later";
}

TEST(ClutterLabelsOf, AsksForFalseAlarmsInTheDark) {
  DetectorSpec spec{.effects = {.sunlight = true}};
  EXPECT_THROW(static_cast<void>(ClutterLabelsOf(Labels({}), spec)), InputError);
}

TEST(EffectBetweenBeams, IsTheHaloWhereItHasACause) {
  DetectorSpec spec{.effects = {.halo = true}};
  EXPECT_EQ(EffectBetweenBeams(spec), nullptr);
  spec.receiver.halo_share_at_1_deg = 1e-6;
  EXPECT_EQ(EffectBetweenBeams(spec), FindEffect("halo"));
  spec.effects.halo = false;
  EXPECT_EQ(EffectBetweenBeams(spec), nullptr);
}

// docs/results/accuracy.md lists every effect with the figure that backs it and the test that holds
// the figure. These tests read the page, the table of effects and the sources of the tests.

std::string TextOf(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// A row of the page's table.
struct Claim {
  std::string effect;
  std::string figure;
  std::string tests;
};

std::vector<Claim> ReadClaims() {
  const std::string page = TextOf(RAILCAST_SOURCE_DIR "/docs/results/accuracy.md");
  const std::size_t begin = page.find("### Each effect\n");
  std::istringstream lines(begin == std::string::npos ? "" : page.substr(begin));
  const std::regex row(R"(\| `([a-z_]+)` \| (.+) \| (.+) \|)");
  std::vector<Claim> claims;
  for (std::string line; std::getline(lines, line);) {
    if (std::smatch cells; std::regex_match(line, cells, row)) {
      claims.push_back({cells[1], cells[2], cells[3]});
    } else if (!claims.empty()) {
      break;  // The table ends.
    }
  }
  return claims;
}

/// The names Suite.Test of all tests in C++.
std::set<std::string> ReadTestNames() {
  const std::regex test(R"(\nTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\))");
  std::set<std::string> names;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(RAILCAST_SOURCE_DIR "/tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = TextOf(entry.path());
    for (std::sregex_iterator found(text.begin(), text.end(), test), end; found != end; ++found) {
      names.insert((*found)[1].str() + "." + (*found)[2].str());
    }
  }
  return names;
}

bool IsThere(const std::string& pattern, const std::set<std::string>& names) {
  if (!pattern.ends_with('*')) return names.contains(pattern);
  const std::string begin = pattern.substr(0, pattern.size() - 1);
  const auto found = names.lower_bound(begin);
  return found != names.end() && found->starts_with(begin);
}

TEST(EffectClaims, HaveARowForEveryEffectAndNoOther) {
  std::vector<std::string> claimed;
  for (const Claim& claim : ReadClaims()) claimed.push_back(claim.effect);
  EXPECT_EQ(claimed, EffectNames());
}

TEST(EffectClaims, HaveAFigureEach) {
  for (const Claim& claim : ReadClaims()) {
    EXPECT_TRUE(std::ranges::any_of(
        claim.figure, [](char letter) { return std::isdigit(static_cast<unsigned char>(letter)); }))
        << claim.effect << ": " << claim.figure;
  }
}

TEST(EffectClaims, NameTestsThatAreThere) {
  const std::set<std::string> names = ReadTestNames();
  const std::regex quoted("`([^`]+)`");
  for (const Claim& claim : ReadClaims()) {
    std::size_t num = 0;
    for (std::sregex_iterator found(claim.tests.begin(), claim.tests.end(), quoted), end;
         found != end; ++found, ++num) {
      EXPECT_TRUE(IsThere((*found)[1], names)) << claim.effect << ": " << (*found)[1];
    }
    EXPECT_GE(num, 1U) << claim.effect;
  }
}

}  // namespace
}  // namespace railcast
