#include "core/detect/beam/echo_finder.h"

#include <algorithm>
#include <cmath>

#include "core/detect/base/beam_optics.h"

namespace railcast {
namespace {

// Peaks closer together than this many pulse sigmas are one peak that two climbs have reached.
constexpr float kSamePeak = 0.5F;

// Maxima whose wave falls by less than a tenth between them are one echo of a receiver of energy:
// the ripple of sub-rays must not divide the energy of a surface.
constexpr float kShallow = 0.9F;

bool IsNearer(const Component& a, const Component& b) {
  return a.range_m != b.range_m ? a.range_m < b.range_m : a.surface < b.surface;
}

// Combines the components in [begin, end) into one echo at `peak`.
Echo Gather(const WavePeak& peak, const Component* begin, const Component* end) {
  Echo echo{.peak_range_m = peak.range_m, .power_ratio = peak.value};
  // Find the surface that sends most power: sum by surface, in the order of first appearance.
  float most = -1.0F;
  for (const Component* c = begin; c != end; ++c) {
    echo.share += c->share;
    echo.intensity += c->intensity;
    const bool is_counted = std::any_of(
        begin, c, [&](const Component& before) { return before.surface == c->surface; });
    if (is_counted) continue;
    float power = 0.0F;
    float weight = 0.0F;
    float range_m = 0.0F;
    float cosine = 0.0F;
    for (const Component* same = c; same != end; ++same) {
      if (same->surface != c->surface) continue;
      power += same->power_ratio;
      weight += same->share;
      range_m += same->share * same->range_m;
      cosine += same->share * same->cos_incidence;
    }
    if (power <= most) continue;
    most = power;
    echo.surface = c->surface;
    echo.true_range_m = range_m / weight;
    echo.cos_incidence = cosine / weight;
    echo.reflectivity = c->reflectivity;
  }
  return echo;
}

}  // namespace

EchoFinder::EchoFinder(const DetectorSpec& spec, float least_ratio, const Kernels& kernels)
    : pulse_sigma_m_(static_cast<float>(PulseSigma_m(spec.beam))),
      has_stretch_(spec.effects.pulse_stretch),
      is_energy_(spec.receiver.signal == EchoSignal::kEnergy),
      is_sampled_(spec.effects.sampled_waveform),
      least_ratio_(least_ratio),
      kernels_(kernels) {}

void EchoFinder::MakeWave(const std::vector<Component>& components) {
  const std::size_t size = (components.size() + kWaveLanes - 1) / kWaveLanes * kWaveLanes;
  range_m_.assign(size, components.front().range_m);
  peak_.assign(size, 0.0F);
  inverse_variance_.assign(size, 1.0F);
  const float pulse2 = pulse_sigma_m_ * pulse_sigma_m_;
  for (std::size_t i = 0; i < components.size(); ++i) {
    const float spread_m = has_stretch_ ? components[i].spread_m : 0.0F;
    range_m_[i] = components[i].range_m;
    peak_[i] = components[i].power_ratio;
    inverse_variance_[i] = 1.0F / (pulse2 + spread_m * spread_m);
    if (is_energy_) peak_[i] *= pulse_sigma_m_ * std::sqrt(inverse_variance_[i]);
  }
  wave_ = {size, range_m_.data(), peak_.data(), inverse_variance_.data()};
}

void EchoFinder::AddPeak(const WavePeak& peak) {
  const bool is_known = std::any_of(peaks_.begin(), peaks_.end(), [&](const WavePeak& known) {
    return std::fabs(known.range_m - peak.range_m) < kSamePeak * pulse_sigma_m_;
  });
  if (!is_known) peaks_.push_back(peak);
}

void EchoFinder::ClimbToPeaks(const std::vector<Component>& components) {
  // Start a climb from the mean of every run of components that is at most one pulse sigma long.
  // The basin of attraction of a maximum is wider, so that no maximum is missed.
  std::size_t begin = 0;
  while (begin < components.size()) {
    const float begin_m = components[begin].range_m;
    float power = 0.0F;
    float moment = 0.0F;
    std::size_t end = begin;
    while (end < components.size() && components[end].range_m - begin_m <= pulse_sigma_m_) {
      power += components[end].power_ratio;
      moment += components[end].power_ratio * (components[end].range_m - begin_m);
      ++end;
    }
    if (power > 0.0F) {
      // Two equal pulses have two peaks only if they are more than 2 sigma apart. At that distance
      // their common peak is 1 sigma from either.
      const WaveKnown known{peaks_.data(), peaks_.size(), pulse_sigma_m_};
      AddPeak(kernels_.climb_wave(wave_, begin_m + moment / power, known));
    }
    begin = end;
  }
}

void EchoFinder::SamplePeaks(const std::vector<Component>& components) {
  const float step_m = 0.125F * pulse_sigma_m_;
  const float margin_m = 2.0F * pulse_sigma_m_;
  const auto reach_m = [&](std::size_t i) { return 2.0F / std::sqrt(inverse_variance_[i]); };
  std::size_t begin = 0;
  while (begin < components.size()) {
    // Sample components together that may have a peak between them.
    std::size_t end = begin + 1;
    while (end < components.size() && components[end].range_m - components[end - 1].range_m <=
                                          reach_m(end - 1) + reach_m(end)) {
      ++end;
    }
    const float first_m = components[begin].range_m - margin_m;
    const float length_m = components[end - 1].range_m + margin_m - first_m;
    const auto num_samples = static_cast<std::size_t>(length_m / step_m) + 2;
    samples_.resize(num_samples);
    kernels_.sample_wave(wave_, first_m, step_m, num_samples, samples_.data());
    for (std::size_t k = 1; k + 1 < num_samples; ++k) {
      const float y = samples_[k];
      if (!(y > samples_[k - 1] && y >= samples_[k + 1] && samples_[k + 1] > 0.0F)) continue;
      const float left = std::log(samples_[k - 1] / y);
      const float right = std::log(samples_[k + 1] / y);
      const float offset = 0.5F * (left - right) / (left + right);
      peaks_.push_back({first_m + step_m * (static_cast<float>(k) + offset),
                        y * std::exp(-0.25F * (left - right) * offset)});
    }
    begin = end;
  }
}

void EchoFinder::DropWeakPeaks() {
  const float strongest =
      std::max_element(peaks_.begin(), peaks_.end(), [](const WavePeak& a, const WavePeak& b) {
        return a.value < b.value;
      })->value;
  const float least = std::min(strongest, least_ratio_);
  std::erase_if(peaks_, [&](const WavePeak& peak) { return peak.value < least; });
}

// Every component belongs to the nearest peak.
const Component* EchoFinder::EndOfPeak(std::size_t peak,
                                       const Component* begin,
                                       const Component* last) const {
  if (peak + 1 == peaks_.size()) return last;
  const float middle_m = 0.5F * (peaks_[peak].range_m + peaks_[peak + 1].range_m);
  return std::partition_point(begin, last,
                              [&](const Component& c) { return c.range_m < middle_m; });
}

// Whether the wave between two peaks falls by a tenth of the lower one anywhere.
bool EchoFinder::HasValley(const WavePeak& near, const WavePeak& far) {
  const float deep = kShallow * std::min(near.value, far.value);
  const float length_m = far.range_m - near.range_m;
  float middle = 0.0F;
  kernels_.sample_wave(wave_, near.range_m + 0.5F * length_m, 0.0F, 1, &middle);
  if (middle < deep) return true;
  const float step_m = 0.125F * pulse_sigma_m_;
  samples_.resize(static_cast<std::size_t>(length_m / step_m) + 1);
  kernels_.sample_wave(wave_, near.range_m, step_m, samples_.size(), samples_.data());
  return *std::min_element(samples_.begin(), samples_.end()) < deep;
}

void EchoFinder::MeltShallowPeaks() {
  for (std::size_t i = 0; i + 1 < peaks_.size();) {
    if (HasValley(peaks_[i], peaks_[i + 1])) {
      ++i;
      continue;
    }
    const std::size_t lower = peaks_[i].value < peaks_[i + 1].value ? i : i + 1;
    peaks_.erase(peaks_.begin() + static_cast<std::ptrdiff_t>(lower));
    if (i > 0) --i;
  }
}

void EchoFinder::TakeEnergies(const std::vector<Component>& components) {
  const Component* begin = components.data();
  const Component* const last = begin + components.size();
  for (std::size_t i = 0; i < peaks_.size(); ++i) {
    const Component* const end = EndOfPeak(i, begin, last);
    peaks_[i].value = 0.0F;
    for (; begin != end; ++begin) peaks_[i].value += begin->power_ratio;
  }
}

void EchoFinder::Find(std::vector<Component>& components, std::vector<Echo>& echoes) {
  echoes.clear();
  peaks_.clear();
  if (components.empty()) return;
  std::sort(components.begin(), components.end(), &IsNearer);
  MakeWave(components);
  if (is_sampled_) {
    SamplePeaks(components);
  } else {
    ClimbToPeaks(components);
  }
  if (peaks_.empty()) return;
  std::sort(peaks_.begin(), peaks_.end(),
            [](const WavePeak& a, const WavePeak& b) { return a.range_m < b.range_m; });
  if (is_energy_) {
    MeltShallowPeaks();
    TakeEnergies(components);
  }
  DropWeakPeaks();
  const Component* begin = components.data();
  const Component* const last = begin + components.size();
  for (std::size_t i = 0; i < peaks_.size(); ++i) {
    const Component* const end = EndOfPeak(i, begin, last);
    if (begin != end) echoes.push_back(Gather(peaks_[i], begin, end));
    begin = end;
  }
}

}  // namespace railcast
