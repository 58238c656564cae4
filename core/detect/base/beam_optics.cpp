#include "core/detect/base/beam_optics.h"

#include <cmath>

namespace railcast {
namespace {

constexpr double kSpeedOfLight_m_per_ns = 0.299792458;

// Standard deviation of a Gaussian profile: a quarter of the full 1/e^2 angle.
double SigmaOf_rad(double divergence_mrad) {
  return 1e-3 * divergence_mrad / 4.0;
}

}  // namespace

double PulseLength_m(const BeamSpec& beam) {
  return 0.5 * kSpeedOfLight_m_per_ns * beam.pulse_length_ns;
}

double PulseSigma_m(const BeamSpec& beam) {
  const double full_width_at_half_maximum = 2.0 * std::sqrt(2.0 * std::log(2.0));
  return PulseLength_m(beam) / full_width_at_half_maximum;
}

double LeastPower(const ReceiverSpec& receiver) {
  const double range_m = receiver.range_at_10_percent_m;
  return 0.1 / (range_m * range_m);
}

double DeadLength_m(const ReceiverSpec& receiver) {
  return 0.5 * kSpeedOfLight_m_per_ns * receiver.dead_time_ns;
}

bool StretchLowersPower(const DetectorSpec& spec) {
  return spec.effects.pulse_stretch && spec.receiver.signal == EchoSignal::kPeak;
}

double HorizontalSigma_rad(const BeamSpec& beam) {
  return SigmaOf_rad(beam.divergence_mrad[0]);
}

double VerticalSigma_rad(const BeamSpec& beam) {
  return SigmaOf_rad(beam.divergence_mrad[1]);
}

LaneOptics LaneOpticsOf(const SurfaceOptics& optics) {
  const float s2 = optics.facet_slope_rad * optics.facet_slope_rad;
  const float below = optics.diffuse * (1.0F - optics.specular_f0);
  return {.diffuse = optics.diffuse,
          .a = below * (1.0F - 0.5F * s2 / (s2 + 0.33F)),
          .b = below * (0.45F * s2 / (s2 + 0.09F)),
          .f0 = optics.specular_f0,
          .alpha2 = optics.specular_roughness * optics.specular_roughness,
          .retro = optics.retroreflectance};
}

std::vector<LaneOptics> OpticsTable(const std::vector<Material>& materials,
                                    int wavelength_nm,
                                    double wetness) {
  std::vector<LaneOptics> table;
  for (const Material& material : materials) {
    const SurfaceOptics dry = OpticsAt(material, wavelength_nm);
    table.push_back(LaneOpticsOf(wetness > 0.0 ? WetOptics(dry, wetness, wavelength_nm) : dry));
  }
  return table;
}

}  // namespace railcast
