#include "core/motion/markov_sequence.h"

#include <array>
#include <cmath>
#include <numbers>

#include "core/base/random.h"

namespace railcast {
namespace {

/// By Box and Muller (1958).
double StandardNormal(const SequenceKey& key, RandomUse use, std::uint64_t index) {
  const std::array<std::uint32_t, 4> words =
      RandomWords(key.seed, use, static_cast<std::uint32_t>(index), key.component,
                  static_cast<std::uint32_t>(index >> 32U));
  const auto unit = [](std::uint32_t word) { return (static_cast<double>(word) + 0.5) * 0x1p-32; };
  return std::sqrt(-2.0 * std::log(unit(words[0]))) *
         std::cos(2.0 * std::numbers::pi * unit(words[1]));
}

}  // namespace

double WhiteNoise(const SequenceKey& key, std::uint64_t index) {
  return StandardNormal(key, RandomUse::kMotionNoise, index);
}

double MarkovSequence::Draw(std::uint64_t index) const {
  return StandardNormal(key_, RandomUse::kMotionDrift, index);
}

MarkovSequence::Passage MarkovSequence::Over(std::uint64_t num_steps) const {
  const auto length = static_cast<double>(num_steps);
  if (decay_per_step_ == 0.0) return {1.0, length};
  const double share = std::exp(-decay_per_step_ * length);
  return {share, -std::expm1(-2.0 * decay_per_step_ * length)};
}

double MarkovSequence::At(std::uint64_t index) const {
  const auto following = [&](double before, std::uint64_t num_steps, std::uint64_t to) {
    const Passage passage = Over(num_steps);
    return passage.share * before + std::sqrt(passage.variance) * Draw(to);
  };
  const double first = decay_per_step_ == 0.0 ? 0.0 : Draw(0);
  if (index == 0) return first;
  std::uint64_t begin = 1;
  double at_begin = following(first, 1, begin);
  for (; begin <= index / 2; begin *= 2) at_begin = following(at_begin, begin, 2 * begin);
  if (index == begin) return at_begin;
  double at_end = following(at_begin, begin, 2 * begin);
  for (std::uint64_t half = begin / 2;; half /= 2) {
    const Passage passage = Over(half);
    const double divisor = 1.0 + passage.share * passage.share;
    const double middle = passage.share / divisor * (at_begin + at_end) +
                          std::sqrt(passage.variance / divisor) * Draw(begin + half);
    if (index == begin + half) return middle;
    if (index < begin + half) {
      at_end = middle;
    } else {
      at_begin = middle;
      begin += half;
    }
  }
}

}  // namespace railcast
