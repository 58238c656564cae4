#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/detect/detector_spec.h"
#include "core/detect/echo_tiles.h"
#include "core/detect/kernels.h"
#include "core/detect/weather_optics.h"

namespace railcast {

/// Effects `clutter`, `fog_echo` and the false alarms of `sunlight`: echoes that no surface sends,
/// also in beams that meet none. Immutable; thread-safe.
///
/// Drops and flakes: Poisson in number, Maxwell in range (weather_optics.h), with the power of an
/// exponentially distributed diameter above the least that answers. Fog: one echo where its soft
/// response peaks. Both stand in front of the first surface only; extinction up to them is left
/// out, since they lie in the first metres. False alarms: anywhere in range, as strong as the
/// threshold. Which of a firing's echoes become returns, the return mode decides.
class Clutter {
 public:
  Clutter(const DetectorSpec& spec, const Kernels& kernels);

  /// Adds drops, flakes and fog. @pre `echoes.first` knows its true ranges and outcomes.
  void Add(EchoTiles& echoes) const;
  /// Adds false alarms, which need no detection: after it.
  void AddFalseAlarms(EchoTiles& echoes) const;

 private:
  static constexpr std::size_t kMostParticles = 64;
  struct Population {
    bool is_on = false;
    ParticleEchoes echoes;
    std::array<float, kMostParticles> at_most{};  ///< [n]: P(count <= n)
    float intensity_scale{};
    std::uint32_t label{};
    std::uint32_t first_echo{};
  };

  [[nodiscard]] Population MakePopulation(const ParticleSizes& sizes,
                                          double reflectance,
                                          std::uint32_t label,
                                          std::uint32_t first_echo) const;
  void AddParticles(const Population& population, EchoTiles& echoes) const;
  void AddFogEchoes(EchoTiles& echoes) const;

  DetectorSpec spec_;
  decltype(Kernels::uniforms) uniforms_;
  double power_min_{};
  Population drops_;
  Population flakes_;
  bool has_fog_echo_ = false;
  FogEcho fog_echo_;
  double fog_ratio_{};
  float false_alarm_probability_{};
};

}  // namespace railcast
