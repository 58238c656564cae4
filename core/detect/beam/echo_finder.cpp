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

void EchoFinder::Clear() {
  beams_.clear();
  components_.clear();
  climbs_.clear();
  for (std::vector<float>* values : {&range_m_, &peak_, &inverse_variance_}) values->clear();
}

void EchoFinder::Add(std::vector<Component>& components) {
  std::sort(components.begin(), components.end(), &IsNearer);
  beams_.push_back({.begin = components_.size(),
                    .end = components_.size() + components.size(),
                    .wave = range_m_.size(),
                    .first_climb = climbs_.size()});
  components_.insert(components_.end(), components.begin(), components.end());
  if (components.empty()) return;
  AppendWave(components);
  if (!is_sampled_) AppendClimbs(components);
  beams_.back().num_climbs = climbs_.size() - beams_.back().first_climb;
}

void EchoFinder::AppendWave(const std::vector<Component>& components) {
  const float pulse2 = pulse_sigma_m_ * pulse_sigma_m_;
  for (const Component& component : components) {
    const float spread_m = has_stretch_ ? component.spread_m : 0.0F;
    const float inverse = 1.0F / (pulse2 + spread_m * spread_m);
    const float weight = is_energy_ ? pulse_sigma_m_ * std::sqrt(inverse) : 1.0F;
    range_m_.push_back(component.range_m);
    peak_.push_back(component.power_ratio * weight);
    inverse_variance_.push_back(inverse);
  }
  const std::size_t size = (range_m_.size() + kWaveLanes - 1) / kWaveLanes * kWaveLanes;
  range_m_.resize(size, components.front().range_m);
  peak_.resize(size, 0.0F);
  inverse_variance_.resize(size, 1.0F / pulse2);  // The largest: none reaches farther for it.
}

void EchoFinder::AddPeak(const WavePeak& peak) {
  const bool is_known = std::any_of(peaks_.begin(), peaks_.end(), [&](const WavePeak& known) {
    return std::fabs(known.range_m - peak.range_m) < kSamePeak * pulse_sigma_m_;
  });
  if (!is_known) peaks_.push_back(peak);
}

void EchoFinder::AppendClimbs(const std::vector<Component>& components) {
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
      climbs_.push_back({.beam = beams_.size() - 1, .from_m = begin_m + moment / power});
    }
    begin = end;
  }
}

void EchoFinder::ClimbTogether(std::span<Climb> climbs) {
  std::size_t most = 0;
  for (const Climb& climb : climbs) {
    most = std::max(most, beams_[climb.beam].end - beams_[climb.beam].begin);
  }
  lane_range_m_.assign(most * kClimbLanes, 0.0F);
  lane_peak_.assign(most * kClimbLanes, 0.0F);
  lane_inverse_variance_.assign(most * kClimbLanes, 1.0F);
  WaveClimbs together{most, lane_range_m_.data(), lane_peak_.data(), lane_inverse_variance_.data()};
  for (std::size_t k = 0; k < climbs.size(); ++k) {
    const Beam& beam = beams_[climbs[k].beam];
    for (std::size_t i = 0; i < beam.end - beam.begin; ++i) {
      lane_range_m_[i * kClimbLanes + k] = range_m_[beam.wave + i];
      lane_peak_[i * kClimbLanes + k] = peak_[beam.wave + i];
      lane_inverse_variance_[i * kClimbLanes + k] = inverse_variance_[beam.wave + i];
    }
    together.from_m[k] = climbs[k].from_m;
  }
  WavePeak peaks[kClimbLanes];
  kernels_.climb_waves(together, peaks);
  for (std::size_t k = 0; k < climbs.size(); ++k) climbs[k].peak = peaks[k];
}

void EchoFinder::FindPeaks() {
  const std::span<Climb> climbs(climbs_);
  for (std::size_t first = 0; first < climbs.size(); first += kClimbLanes) {
    ClimbTogether(climbs.subspan(first, std::min(kClimbLanes, climbs.size() - first)));
  }
}

void EchoFinder::SamplePeaks(std::span<const Component> components) {
  const float step_m = 0.125F * pulse_sigma_m_;
  const float margin_m = 2.0F * pulse_sigma_m_;
  const auto reach_m = [&](std::size_t i) {
    return 2.0F / std::sqrt(wave_.inverse_variance_per_m2[i]);
  };
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
      const float least = std::min(samples_[k - 1], samples_[k + 1]);
      if (!(y > samples_[k - 1] && y >= samples_[k + 1] && least > 0.0F)) continue;
      const float left = std::log(samples_[k - 1] / y);
      const float right = std::log(samples_[k + 1] / y);
      const float offset = 0.5F * (left - right) / (left + right);
      peaks_.push_back({first_m + step_m * (static_cast<float>(k) + offset),
                        y * std::exp(-0.25F * (left - right) * offset)});
    }
    begin = end;
  }
}

float EchoFinder::LeastPeak() const {
  const auto strongest = std::ranges::max_element(peaks_, {}, &WavePeak::value);
  return std::min(strongest->value, least_ratio_);
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

void EchoFinder::TakeEnergies(std::span<const Component> components) {
  const Component* begin = components.data();
  const Component* const last = begin + components.size();
  for (std::size_t i = 0; i < peaks_.size(); ++i) {
    const Component* const end = EndOfPeak(i, begin, last);
    peaks_[i].value = 0.0F;
    for (; begin != end; ++begin) peaks_[i].value += begin->power_ratio;
  }
}

void EchoFinder::EchoesOf(std::size_t beam, std::vector<Echo>& echoes) {
  echoes.clear();
  peaks_.clear();
  const Beam& its = beams_[beam];
  const std::span<const Component> components(components_.data() + its.begin, its.end - its.begin);
  if (components.empty()) return;
  const std::size_t end = beam + 1 < beams_.size() ? beams_[beam + 1].wave : range_m_.size();
  wave_ = {end - its.wave, &range_m_[its.wave], &peak_[its.wave], &inverse_variance_[its.wave]};
  if (is_sampled_) {
    SamplePeaks(components);
  } else {
    for (std::size_t i = 0; i < its.num_climbs; ++i) AddPeak(climbs_[its.first_climb + i].peak);
  }
  if (peaks_.empty()) return;
  std::sort(peaks_.begin(), peaks_.end(),
            [](const WavePeak& a, const WavePeak& b) { return a.range_m < b.range_m; });
  if (is_energy_) {
    MeltShallowPeaks();
    TakeEnergies(components);
  }
  // What belongs to a peak that is too weak is in no echo, however near the next one is.
  const float least = LeastPeak();
  const Component* begin = components.data();
  const Component* const last = begin + components.size();
  for (std::size_t i = 0; i < peaks_.size(); ++i) {
    const Component* const end_of_peak = EndOfPeak(i, begin, last);
    if (begin != end_of_peak && peaks_[i].value >= least) {
      echoes.push_back(Gather(peaks_[i], begin, end_of_peak));
    }
    begin = end_of_peak;
  }
}

}  // namespace railcast
