#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
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
  std::uint32_t surface{};
};

/// Finds the echoes of beams: the maxima of the waveform to which a beam's components add up. Two
/// equal echoes closer together than about 0.85 pulse lengths merge into one, whose range lies
/// between the surfaces (a mixed pixel). Beams are looked at together, since climbs to their maxima
/// go side by side:
///
///   finder.Clear();
///   for (std::vector<Component>& components : beams) finder.Add(components);
///   finder.FindPeaks();
///   finder.EchoesOf(0, echoes);  // Of the beam that was added first.
///
/// Not thread-safe: keeps its working memory.
class EchoFinder {
 public:
  /// With effect `sampled_waveform`, samples the waveform at an eighth of the pulse's sigma and
  /// looks for local maxima, refined by a parabola through the logarithms. Without, climbs to each
  /// maximum with derivatives in closed form.
  EchoFinder(const DetectorSpec& spec, float least_ratio, const Kernels& kernels);

  /// Forgets all beams.
  void Clear();
  /// Adds a beam, whose components it sorts by range.
  void Add(std::vector<Component>& components);
  /// Climbs to the peaks of all beams.
  void FindPeaks();
  /// Fills `echoes`, sorted by range, with the strongest echo of a beam and all that reach
  /// `least_ratio` times the least detectable power.
  /// @param beam How many were added before it.
  void EchoesOf(std::size_t beam, std::vector<Echo>& echoes);

 private:
  struct Beam {
    std::size_t begin{}, end{};  ///< In `components_`.
    std::size_t wave{};          ///< Where its wave begins.
    std::size_t first_climb{}, num_climbs{};
  };
  /// A climb, and where it led.
  struct Climb {
    std::size_t beam{};
    float from_m{};
    WavePeak peak{};
  };

  void AppendWave(const std::vector<Component>& components);
  void AppendClimbs(const std::vector<Component>& components);
  void ClimbTogether(std::span<Climb> climbs);
  void SamplePeaks(std::span<const Component> components);
  void AddPeak(const WavePeak& peak);
  [[nodiscard]] float LeastPeak() const;
  [[nodiscard]] bool HasValley(const WavePeak& near, const WavePeak& far);
  void MeltShallowPeaks();
  void TakeEnergies(std::span<const Component> components);
  [[nodiscard]] const Component* EndOfPeak(std::size_t peak,
                                           const Component* begin,
                                           const Component* last) const;

  float pulse_sigma_m_;
  bool has_stretch_;
  bool is_energy_;  ///< Components give their energies, which an echo adds up.
  bool is_sampled_;
  float least_ratio_;
  const Kernels& kernels_;
  // For all beams.
  std::vector<Beam> beams_;
  std::vector<Component> components_;
  std::vector<float> range_m_, peak_, inverse_variance_;
  std::vector<Climb> climbs_;
  // For climbs side by side, by component and lane.
  std::vector<float> lane_range_m_, lane_peak_, lane_inverse_variance_;
  // For one beam.
  EchoWave wave_;
  std::vector<WavePeak> peaks_;
  std::vector<float> samples_;
};

}  // namespace railcast
