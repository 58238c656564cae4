#include "core/rail/motion/track_irregularity.h"

namespace railcast {
namespace {

constexpr double kCorner_rad_per_m = 0.8246;     // Wc
constexpr double kLongWaves_rad_per_m = 0.0206;  // Wr
constexpr double kCant_rad_per_m = 0.4380;       // Ws
constexpr double kHalfTapeDistance_m = 0.75;     // b

constexpr double SquareOf(double value) {
  return value * value;
}

// Per unit of A_v or A_a.
double ShapeOf(double rad_per_m) {
  return SquareOf(kCorner_rad_per_m) / ((SquareOf(rad_per_m) + SquareOf(kLongWaves_rad_per_m)) *
                                        (SquareOf(rad_per_m) + SquareOf(kCorner_rad_per_m)));
}

}  // namespace

double TrackSpectrum::Vertical(double rad_per_m) const {
  return vertical_m_rad * ShapeOf(rad_per_m);
}

double TrackSpectrum::Lateral(double rad_per_m) const {
  return lateral_m_rad * ShapeOf(rad_per_m);
}

double TrackSpectrum::Cant(double rad_per_m) const {
  return vertical_m_rad / SquareOf(kHalfTapeDistance_m) * ShapeOf(rad_per_m) * SquareOf(rad_per_m) /
         (SquareOf(rad_per_m) + SquareOf(kCant_rad_per_m));
}

TrackSpectrum SpectrumOf(TrackQuality quality) {
  return quality == TrackQuality::kGood ? TrackSpectrum{4.032e-7, 2.119e-7}
                                        : TrackSpectrum{1.080e-6, 6.125e-7};
}

}  // namespace railcast
