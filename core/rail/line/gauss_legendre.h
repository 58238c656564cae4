#pragma once

#include <array>

namespace railcast {

/// Nodes on [-1, 1] and weights of 5-point Gauss-Legendre quadrature, exact for polynomials of
/// degree 9 (Abramowitz and Stegun 1964, table 25.4).
struct GaussLegendreNode {
  double position{};
  double weight{};
};
inline constexpr std::array<GaussLegendreNode, 5> kGaussLegendre = {{
    {-0.90617984593866399280, 0.23692688505618908751},
    {-0.53846931010568309104, 0.47862867049936646804},
    {0.0, 0.56888888888888888889},
    {0.53846931010568309104, 0.47862867049936646804},
    {0.90617984593866399280, 0.23692688505618908751},
}};

}  // namespace railcast
