#include "railcast/effects.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"

namespace railcast {
namespace {

template <class Change>
std::string FaultsOf(const Change& change) {
  DetectorSpec spec;
  change(spec);
  try {
    CheckDetectorSpec(spec);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(CheckDetectorSpec, TakesTheDefaults) {
  EXPECT_EQ(FaultsOf([](DetectorSpec&) {}), "none");
}

TEST(CheckDetectorSpec, RefusesAWavelengthAtWhichNoMaterialIsKnown) {
  EXPECT_EQ(FaultsOf([](DetectorSpec& s) { s.beam.wavelength_nm = 1064; }),
            "/beam/wavelength_nm: must be 905 or 1550 (got 1064)");
  EXPECT_EQ(FaultsOf([](DetectorSpec& s) { s.beam.wavelength_nm = 1550; }), "none");
}

TEST(CheckDetectorSpec, NamesEveryNumberThatBreaksItsRule) {
  EXPECT_EQ(FaultsOf([](DetectorSpec& s) {
              s.range_min_m = -1.0;
              s.range_max_m = std::nan("");
              s.beam.divergence_mrad = {-1.0, 1.0};
              s.beam.pulse_length_ns = 0.0;
              s.beam.reference_rays = 0;
              s.beam.footprint_rays = 32;
              s.receiver.range_at_10_percent_m = 0.0;
              s.receiver.snr_at_threshold = -5.0;
            }),
            "/range_min_m: must be >= 0 (got -1)\n"
            "/range_max_m: must be > 0 (got nan)\n"
            "/beam/divergence_mrad/0: must be >= 0 (got -1)\n"
            "/beam/pulse_length_ns: must be > 0 (got 0)\n"
            "/beam/reference_rays: must be >= 1 and <= 4096 (got 0)\n"
            "/beam/footprint_rays: must be 16 or 64 (got 32)\n"
            "/receiver/range_at_10_percent_m: must be > 0 (got 0)\n"
            "/receiver/snr_at_threshold: must be > 0 (got -5)");
}

TEST(CheckDetectorSpec, NamesTheWeatherThatCannotBe) {
  EXPECT_EQ(FaultsOf([](DetectorSpec& s) {
              s.weather.fog_density_per_m = -0.1;
              s.weather.visibility_m = 0.0;
              s.weather.rain_rate_mmph = -1.0;
              s.weather.snow_rate_mmph = INFINITY;
              s.weather.wetness = 1.5;
              s.weather.snow_cover = -0.5;
            }),
            "/weather/fog_density_per_m: must be >= 0 (got -0.1)\n"
            "/weather/visibility_m: must be > 0 (got 0)\n"
            "/weather/rain_rate_mmph: must be >= 0 (got -1)\n"
            "/weather/snow_rate_mmph: must be >= 0 (got inf)\n"
            "/weather/wetness: must be >= 0 and <= 1 (got 1.5)\n"
            "/weather/snow_cover: must be >= 0 and <= 1 (got -0.5)");
}

}  // namespace
}  // namespace railcast
