#pragma once

namespace railcast {

/// Beyond this many standard deviations the tables below are 0 (the density is 6e-9 there).
inline constexpr double kNormalReach = 6.0;

/// Density of the standard normal distribution; error < 1e-9.
[[nodiscard]] double NormalDensity(double x);

/// The standard normal distribution's probability of [a, b], a <= b; error < 3e-9.
///
/// From tables made by the compiler: plain arithmetic that gives the same bits on every machine,
/// which the C library's erf does not promise, and faster.
[[nodiscard]] double NormalShare(double a, double b);

}  // namespace railcast
