#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/detect/kernels/kernels.h"

namespace railcast {
namespace {

TEST(SampleWave, IsTheSumOfItsComponents) {
  constexpr float kPulseSigma_m = 0.2F;
  constexpr float kStep_m = 0.125F * kPulseSigma_m;
  constexpr float kFirst_m = 0.5F;
  constexpr std::size_t kNumSamples = 401;
  constexpr std::size_t kNumComponents = 4 * kWaveLanes;
  std::vector<float> range_m(kNumComponents);
  std::vector<float> peak(kNumComponents);
  std::vector<float> inverse_variance(kNumComponents);
  for (std::uint32_t i = 0; i < kNumComponents; ++i) {
    const auto words = RandomWords(5, RandomUse::kNoise, 0, i);
    range_m[i] = 1.5F + 8.0F * UnitFloat(words[0]);
    peak[i] = UnitFloat(words[1]);
    const float sigma_m = kPulseSigma_m * (1.0F + UnitFloat(words[2]));
    inverse_variance[i] = 1.0F / (sigma_m * sigma_m);
  }
  std::ranges::sort(range_m);
  std::vector<float> samples(kNumSamples);
  AvailableKernels().front().sample_wave(
      {kNumComponents, range_m.data(), peak.data(), inverse_variance.data()}, kFirst_m, kStep_m,
      kNumSamples, samples.data());
  for (std::size_t k = 0; k < kNumSamples; ++k) {
    const double at_m = double{kFirst_m} + double{kStep_m} * static_cast<double>(k);
    double wave = 0.0;
    for (std::size_t i = 0; i < kNumComponents; ++i) {
      const double square = std::pow(double{range_m[i]} - at_m, 2) * double{inverse_variance[i]};
      wave += double{peak[i]} * std::exp(-0.5 * square);
    }
    EXPECT_NEAR(double{samples[k]}, wave, 1e-5 * wave + 1e-12) << k;
  }
}

}  // namespace
}  // namespace railcast
