#pragma once

#include "railcast/rail_world.h"

namespace railcast {

/// Spectra of a track's irregularities by ORE B 176, as Claus and Schiehlen 1998 ("Modeling and
/// simulation of railway bogie structural vibrations", Vehicle System Dynamics 29) give them for
/// low and high disturbances, here good and poor:
///
///   S_v(W) = A_v Wc^2 / ((W^2 + Wr^2) (W^2 + Wc^2))                        vertical, m^2 / (rad/m)
///   S_a(W) = the same with A_a                                              lateral
///   S_c(W) = A_v Wc^2 W^2 / (b^2 (W^2 + Wr^2) (W^2 + Wc^2) (W^2 + Ws^2))    cant, rad^2 / (rad/m)
///
/// Variances are their integrals over positive W, divided by pi.
struct TrackSpectrum {
  double vertical_m_rad{};  ///< A_v.
  double lateral_m_rad{};   ///< A_a.

  [[nodiscard]] double Vertical(double rad_per_m) const;
  [[nodiscard]] double Lateral(double rad_per_m) const;
  [[nodiscard]] double Cant(double rad_per_m) const;
};

[[nodiscard]] TrackSpectrum SpectrumOf(TrackQuality quality);

/// Wavelengths that count: those of EN 13848-1, D1 to D3.
inline constexpr double kShortestIrregularity_m = 3.0;
inline constexpr double kLongestIrregularity_m = 200.0;

}  // namespace railcast
