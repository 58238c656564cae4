#include "core/detect/base/beam_optics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/units.h"
#include "railcast/outcome.h"

namespace railcast {
namespace {

constexpr double kSpeedOfLight_m_per_ns = kSpeedOfLight_mps / kNsPerS;

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

void ResolveHits(const RayTile& rays, const SurfaceTable& table, DetectTile& tile) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const Surface& surface = table.surfaces[rays.surface[i]];
    const bool hit = rays.surface[i] != 0;
    const Outcome outcome = !hit             ? Outcome::kNoSurface
                            : surface.is_ego ? Outcome::kEgo
                                             : Outcome::kReturned;
    tile.surface[i] = rays.surface[i];
    tile.true_range_m[i] = hit ? rays.range_m[i] : kNaN;
    tile.reflectivity[i] = hit ? surface.reflectivity : kNaN;
    tile.outcome[i] = static_cast<std::uint32_t>(outcome);
  }
  std::fill_n(tile.echo, tile.num_rays, 0U);
  std::fill_n(tile.clutter, tile.num_rays, kNoClutter);
  std::fill_n(tile.share, tile.num_rays, 1.0F);
  if (table.optics.empty()) return;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const LaneOptics& optics = table.optics[table.surfaces[rays.surface[i]].material];
    tile.reflectivity[i] = optics.diffuse;
    tile.diffuse_a[i] = optics.a;
    tile.diffuse_b[i] = optics.b;
    tile.specular_f0[i] = optics.f0;
    tile.specular_alpha2[i] = optics.alpha2;
    tile.retro[i] = optics.retro;
  }
  std::fill_n(tile.peak_shift_m, tile.num_rays, 0.0F);
}

}  // namespace railcast
