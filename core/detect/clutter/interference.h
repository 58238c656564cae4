#pragma once

#include "core/detect/base/echo_tiles.h"
#include "core/detect/kernels/kernels.h"
#include "railcast/effects.h"

namespace railcast {

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
/// They come after effect `saturation`, which therefore acts on them here: detection.h.
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
