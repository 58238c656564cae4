#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/detect/base/echo_tiles.h"
#include "core/detect/base/weather_optics.h"
#include "core/detect/clutter/fog_profile.h"
#include "core/detect/kernels/kernels.h"
#include "railcast/effects.h"
#include "railcast/ray_caster.h"
#include "railcast/transform.h"

namespace railcast {

/// Where and when a tile's beams pass through the air.
struct AirView {
  const RayTile& rays;  ///< The central rays of the tile's firings, in the frame of a window.
  Transform world_from_window;
  double time_s{};  ///< Simulation time.
};

/// Effects `clutter` and `fog_echo` and the false alarms of `sunlight`: echoes that no surface
/// sends. They also occur in beams that meet no surface. Immutable; thread-safe.
///
/// Drops and flakes: their number is Poisson distributed, their range follows Maxwell's law
/// (weather_optics.h), and their power results from an exponential distribution of diameters above
/// the least detectable one. Fog: an echo where its soft response peaks, up to two in other modes
/// than `strongest`, each detected already (fog_echo.h). Both occur only in front of the first
/// surface, drops and flakes by at least two sigmas of the pulse. Effect `extinction` weakens drops
/// and flakes, too. False alarms: uniformly distributed over the range gate, as strong as the
/// threshold. The return mode decides which of a firing's echoes become returns.
class Clutter {
 public:
  Clutter(const DetectorSpec& spec, const Kernels& kernels);

  [[nodiscard]] bool has_particles() const { return drops_.is_on || flakes_.is_on; }
  [[nodiscard]] bool has_fog_echo() const { return !fog_.ratio.empty(); }
  [[nodiscard]] bool has_false_alarms() const { return false_alarm_probability_ > 0.0F; }

  /// Adds drops and flakes. @pre The true ranges and outcomes of `echoes.first` are set.
  void AddParticles(EchoTiles& echoes) const;
  /// Adds fog's echoes. @pre As AddParticles().
  void AddFogEchoes(const AirView& air, EchoTiles& echoes) const;
  /// Adds false alarms. They do not pass detection, so call this after it.
  void AddFalseAlarms(EchoTiles& echoes) const;

 private:
  static constexpr std::size_t kMostParticles = 64;
  struct Population {
    bool is_on = false;
    ParticleEchoes echoes;
    std::array<float, kMostParticles> at_most{};  ///< [n]: P(count <= n)
    std::uint32_t label{};
    std::uint32_t first_echo{};
  };

  [[nodiscard]] Population MakePopulation(const ParticleSizes& sizes,
                                          double reflectance,
                                          std::uint32_t label,
                                          std::uint32_t first_echo) const;
  void AddPopulation(const Population& population, EchoTiles& echoes) const;

  DetectorSpec spec_;
  decltype(Kernels::uniforms) uniforms_;
  double power_min_{};
  Population drops_;
  Population flakes_;
  decltype(Kernels::fog_peaks) find_fog_peaks_;
  FogProfile fog_;
  FogPatches fog_patches_;
  float extinction_per_m_{};
  float false_alarm_probability_{};
};

/// The range gate as the time during which the receiver listens after each firing.
[[nodiscard]] double ListeningTime_s(const DetectorSpec& spec);

/// Effect `interference`: pulses of other lidars that the receiver takes for echoes of its own.
///
///   P(false echo) = 1 - exp(-foreign_pulses_hz x listening time)
///   range uniform over the range gate, P(power ratio > p) = 1 / p for p >= 1
///
/// Foreign pulses come at random times, so that their number while the receiver listens is Poisson
/// distributed and their apparent ranges are uniform; of several within one firing only the first
/// drawn counts. Received power falls with the square of the distance, and the number of lidars
/// within a distance grows with its square, where they are spread evenly over the ground: the
/// power's distribution follows.
///
/// They come after effect `saturation`, which therefore acts on them here: echo_power.h.
///
/// Validity: sparse interference. Other lidars are not part of the scene, so that their false
/// echoes neither come in bursts nor from a direction. Immutable; thread-safe.
class Interference {
 public:
  Interference(const DetectorSpec& spec, const Kernels& kernels);

  [[nodiscard]] bool is_on() const { return probability_ > 0.0F; }
  /// Adds false echoes. They do not pass detection, so call this after it.
  void AddEchoes(EchoTiles& echoes) const;

 private:
  DetectorSpec spec_;
  decltype(Kernels::uniforms) uniforms_;
  float probability_{};
  float saturation_{};  // Power ratio at which the receiver saturates; 0 = never.
  float pulse_sigma_m_{};
};

}  // namespace railcast
