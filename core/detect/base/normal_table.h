#pragma once

namespace railcast {

/// Beyond this many standard deviations the functions below return 0 (the density there is 6e-9).
inline constexpr double kNormalReach = 6.0;

/// Density of the standard normal distribution; error < 1e-9.
[[nodiscard]] double NormalDensity(double x);

/// Probability of [a, b], a <= b, under the standard normal distribution; error < 3e-9.
///
/// The tables are computed by the compiler with plain arithmetic. This gives the same bits on every
/// machine, which the C library's erf does not guarantee, and it is faster.
[[nodiscard]] double NormalShare(double a, double b);

}  // namespace railcast
