#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/detect/kernels/kernels.h"
#include "railcast/effects.h"

namespace railcast {

/// A part of what a beam meets: the surface that a sub-ray hits, or a wire.
struct Component {
  float range_m{};
  float spread_m{};     ///< Standard deviation of the range within the component.
  float power_ratio{};  ///< Signal of the component alone over the least detectable power.
  float share{};        ///< Share of the beam.
  float intensity{};    ///< Share x effective reflectance.
  float cos_incidence{};
  float reflectivity{};
  std::uint32_t surface{};
};

/// An echo: a peak of the received waveform.
struct Echo {
  float peak_range_m{};   ///< Range of the peak.
  float true_range_m{};   ///< Mean range of the surface that sends most of it.
  float power_ratio{};    ///< Peak, or energy, over what is least detectable (EchoSignal).
  float share{};          ///< Share of the beam, summed over all components.
  float intensity{};      ///< Intensity, summed over all components.
  float cos_incidence{};  ///< Mean over the surface that sends most of it.
  float reflectivity{};
  std::uint32_t surface{};
};

/// Finds the echoes of a beam: the maxima of the waveform to which its components add up. Two equal
/// echoes closer together than about 0.85 pulse lengths merge into one, whose range lies between
/// the surfaces (a mixed pixel). Not thread-safe: keeps its working memory.
class EchoFinder {
 public:
  /// With effect `sampled_waveform`, samples the waveform at an eighth of the pulse's sigma and
  /// looks for local maxima, refined by a parabola through the logarithms. Without, climbs to each
  /// maximum with derivatives in closed form.
  EchoFinder(const DetectorSpec& spec, float least_ratio, const Kernels& kernels);

  /// Fills `echoes`, sorted by range, with the strongest echo and all that reach `least_ratio`
  /// times the least detectable power. Sorts `components` by range.
  void Find(std::vector<Component>& components, std::vector<Echo>& echoes);

 private:
  void MakeWave(const std::vector<Component>& components);
  void ClimbToPeaks(const std::vector<Component>& components);
  void SamplePeaks(const std::vector<Component>& components);
  void AddPeak(const WavePeak& peak);
  void DropWeakPeaks();
  [[nodiscard]] bool HasValley(const WavePeak& near, const WavePeak& far);
  void MeltShallowPeaks();
  void TakeEnergies(const std::vector<Component>& components);
  [[nodiscard]] const Component* EndOfPeak(std::size_t peak,
                                           const Component* begin,
                                           const Component* last) const;

  float pulse_sigma_m_;
  bool has_stretch_;
  bool is_energy_;  ///< Components give their energies, which an echo adds up.
  bool is_sampled_;
  float least_ratio_;
  const Kernels& kernels_;
  std::vector<float> range_m_, peak_, inverse_variance_;
  EchoWave wave_;
  std::vector<WavePeak> peaks_;
  std::vector<float> samples_;
};

}  // namespace railcast
