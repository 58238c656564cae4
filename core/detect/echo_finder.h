#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/detect/detect_spec.h"
#include "core/detect/kernels.h"

namespace railcast {

/// A part of what a beam meets: a sub-ray's surface, a wire.
struct Component {
  float range_m{};
  float spread_m{};     ///< Standard deviation of the range inside the component.
  float power_ratio{};  ///< Its own peak over the least detectable power.
  float share{};        ///< Of the beam.
  float intensity{};    ///< Share x effective reflectance.
  float cos_incidence{};
  float reflectivity{};
  std::uint32_t surface{};
};

/// A peak of the light that comes back.
struct Echo {
  float peak_range_m{};   ///< Where the receiver sees it.
  float true_range_m{};   ///< Mean range of the surface that sends most of it.
  float power_ratio{};    ///< Of the peak.
  float share{};          ///< Of the beam, all components together.
  float intensity{};      ///< Likewise.
  float cos_incidence{};  ///< Mean over the surface that sends most of it.
  float reflectivity{};
  std::uint32_t surface{};
};

/// Finds the echoes in what a beam meets: the maxima of the wave that its components make. Echoes
/// nearer together than about 0.85 pulse lengths (two equal ones) melt into one, whose range then
/// lies between the surfaces: mixed pixels. Not thread-safe: keeps its working memory.
class EchoFinder {
 public:
  /// @param is_sampled Effect `sampled_waveform`: samples the wave at an eighth of the pulse's
  ///   sigma and looks for local maxima, refined by a parabola through the logarithms; else climbs
  ///   to each maximum by closed forms.
  EchoFinder(const BeamSpec& beam,
             bool has_stretch,
             bool is_sampled,
             float least_ratio,
             const Kernels& kernels);

  /// Echoes by range: the strongest, and all that reach `least_ratio` of the least detectable
  /// power. Sorts `components` by range.
  void Find(std::vector<Component>& components, std::vector<Echo>& echoes);

 private:
  void MakeWave(const std::vector<Component>& components);
  void ClimbToPeaks(const std::vector<Component>& components);
  void SamplePeaks(const std::vector<Component>& components);
  void AddPeak(const WavePeak& peak);

  float pulse_sigma_m_;
  bool has_stretch_;
  bool is_sampled_;
  float least_ratio_;
  const Kernels& kernels_;
  std::vector<float> range_m_, peak_, inverse_variance_;
  EchoWave wave_;
  std::vector<WavePeak> peaks_;
  std::vector<float> samples_;
};

}  // namespace railcast
