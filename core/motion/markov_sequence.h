#pragma once

#include <cstdint>

namespace railcast {

/// One random sequence among those of a sensor.
struct SequenceKey {
  std::uint64_t seed{};       ///< The sensor's seed.
  std::uint32_t component{};  ///< Which of its sequences.
};

/// Element `index` of a sequence of independent numbers of the standard normal distribution.
[[nodiscard]] double WhiteNoise(const SequenceKey& key, std::uint64_t index);

/// A Gaussian sequence in which each element depends on the one before only. Every element is a
/// function of its index alone, found in about 2 log2(index) steps, whichever were asked for
/// before.
///
/// The elements 0, 1, 2, 4, 8, ... follow from one another, and each element between two of these
/// by halving the span between known ones: given both its ends, the middle of a span of a
/// Gauss-Markov sequence is normal with a mean and a variance in closed form (Levy's construction
/// of Brownian motion). So the sequence has exactly the distribution of one that is summed step by
/// step.
class MarkovSequence {
 public:
  /// A random walk from 0, whose steps have the standard normal distribution.
  [[nodiscard]] static MarkovSequence Walk(const SequenceKey& key) { return {key, 0.0}; }
  /// A stationary sequence of standard normal numbers: the correlation of two of them is
  /// exp(-decay x the difference of their indices).
  /// @pre decay_per_step > 0
  [[nodiscard]] static MarkovSequence Stationary(const SequenceKey& key, double decay_per_step) {
    return {key, decay_per_step};
  }

  [[nodiscard]] double At(std::uint64_t index) const;

 private:
  MarkovSequence(const SequenceKey& key, double decay_per_step)
      : key_(key), decay_per_step_(decay_per_step) {}

  /// How an element follows from the one that is some steps before it: this share of the latter,
  /// and a normal number of this variance.
  struct Passage {
    double share{};
    double variance{};
  };
  [[nodiscard]] Passage Over(std::uint64_t num_steps) const;
  /// The number that is drawn for an element, of the standard normal distribution.
  [[nodiscard]] double Draw(std::uint64_t index) const;

  SequenceKey key_;
  double decay_per_step_;  ///< 0 = a random walk.
};

}  // namespace railcast
