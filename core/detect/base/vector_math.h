// Include guards instead of `#pragma once`: core/detect/kernels/kernels.cpp is compiled once per
// instruction set, and these functions are in that copy's own namespace, so that the linker cannot
// confuse the copies.
#ifndef RAILCAST_DETECT_VECTOR_MATH_H_
#define RAILCAST_DETECT_VECTOR_MATH_H_

#include <bit>
#include <cmath>
#include <cstdint>

#ifndef RAILCAST_ISA
#define RAILCAST_ISA baseline
#endif

/// Polynomial approximations in float32 that compilers vectorise and that, without contraction,
/// give the same bits on every instruction set (libmvec does not). Errors are measured in
/// tests/core/detect/base/vector_math_test.cpp.
namespace railcast::RAILCAST_ISA {

// ln 2 as a sum. The product of the upper part with any exponent is exact.
inline constexpr float kLn2Upper = 0.693359375F;
inline constexpr float kLn2Lower = -2.12194440e-4F;

/// Natural logarithm of a normal x > 0 (Cephes logf polynomial); error <= 2 ulp, or 1e-7 near 1.
[[nodiscard]] inline float Log(float x) {
  // x = m * 2^e with m in [sqrt(1/2), sqrt(2)).
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
  const std::uint32_t shifted = bits - 0x3F3504F3U;
  const auto exponent = static_cast<std::int32_t>(shifted) >> 23;
  const float m = std::bit_cast<float>((shifted & 0x007FFFFFU) + 0x3F3504F3U);
  const float f = m - 1.0F;
  const float e = static_cast<float>(exponent);
  float p = 7.0376836292e-2F;
  p = p * f - 1.1514610310e-1F;
  p = p * f + 1.1676998740e-1F;
  p = p * f - 1.2420140846e-1F;
  p = p * f + 1.4249322787e-1F;
  p = p * f - 1.6668057665e-1F;
  p = p * f + 2.0000714765e-1F;
  p = p * f - 2.4999993993e-1F;
  p = p * f + 3.3333331174e-1F;
  const float square = f * f;
  return (f + (p * f * square + (e * kLn2Lower - 0.5F * square))) + e * kLn2Upper;
}

/// e^x for x in [-87, 87] (Cephes expf polynomial); error <= 2 ulp. Returns e^-87 below -87.
[[nodiscard]] inline float Exp(float x) {
  const float bounded = x < -87.0F ? -87.0F : x;
  // Adding and subtracting 1.5 * 2^23 rounds to the nearest integer.
  constexpr float kRounder = 12582912.0F;
  const float shifted = bounded * 1.44269504F + kRounder;
  const float n = shifted - kRounder;
  const float r = (bounded - n * kLn2Upper) - n * kLn2Lower;
  float p = 1.9875691500e-4F;
  p = p * r + 1.3981999507e-3F;
  p = p * r + 8.3334519073e-3F;
  p = p * r + 4.1665795894e-2F;
  p = p * r + 1.6666665459e-1F;
  p = p * r + 5.0000001201e-1F;
  const float fraction = (p * (r * r) + r) + 1.0F;
  const std::uint32_t exponent = (std::bit_cast<std::uint32_t>(shifted) << 23U) + 0x3F800000U;
  return fraction * std::bit_cast<float>(exponent);
}

/// Turns less whole ones, in [-1/2, 1/2], of less than 2^22 turns.
[[nodiscard]] inline float WithinHalfATurn(float turns) {
  // Adding and subtracting 1.5 * 2^23 rounds to the nearest integer.
  constexpr float kRounder = 12582912.0F;
  return turns - ((turns + kRounder) - kRounder);
}

/// cos(2 pi u) and sin(2 pi u) for u in [-1/2, 1); error <= 2e-7.
inline void CosSinTurn(float u, float& cosine, float& sine) {
  // q is the nearest quarter turn, x the rest in [-1/8, 1/8] turn, in radians.
  constexpr float kRounder = 12582912.0F;
  const float shifted = u * 4.0F + kRounder;
  const float q = shifted - kRounder;
  const float x = (u - q * 0.25F) * 6.28318530718F;
  const float x2 = x * x;
  const float s =
      x + x * x2 * ((-1.9515295891e-4F * x2 + 8.3321608736e-3F) * x2 - 1.6666654611e-1F);
  const float c =
      1.0F - 0.5F * x2 +
      x2 * x2 * ((2.443315711809948e-5F * x2 - 1.388731625493765e-3F) * x2 + 4.166664568298827e-2F);
  const std::uint32_t quadrant = std::bit_cast<std::uint32_t>(shifted) & 3U;
  const bool swap = (quadrant & 1U) != 0U;
  const float c_abs = swap ? s : c;
  const float s_abs = swap ? c : s;
  cosine = (quadrant == 1U || quadrant == 2U) ? -c_abs : c_abs;
  sine = quadrant >= 2U ? -s_abs : s_abs;
}

/// Arc cosine for x in [0, 1] (Abramowitz and Stegun 4.4.46); error <= 5e-7 rad.
[[nodiscard]] inline float Acos(float x) {
  float p = -0.0012624911F;
  p = p * x + 0.0066700901F;
  p = p * x - 0.0170881256F;
  p = p * x + 0.0308918810F;
  p = p * x - 0.0501743046F;
  p = p * x + 0.0889789874F;
  p = p * x - 0.2145988016F;
  p = p * x + 1.5707963050F;
  const float rest = 1.0F - x;
  return std::sqrt(rest < 0.0F ? 0.0F : rest) * p;
}

/// Distribution function of the standard normal (Abramowitz and Stegun 7.1.26); error <= 4e-7.
[[nodiscard]] inline float NormalCdf(float x) {
  const float z = std::fabs(x) * 0.70710678F;
  const float t = 1.0F / (1.0F + 0.3275911F * z);
  float p = 1.061405429F;
  p = p * t - 1.453152027F;
  p = p * t + 1.421413741F;
  p = p * t - 0.284496736F;
  p = p * t + 0.254829592F;
  const float upper_tail = 0.5F * p * t * Exp(-z * z);
  return x < 0.0F ? upper_tail : 1.0F - upper_tail;
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_VECTOR_MATH_H_
