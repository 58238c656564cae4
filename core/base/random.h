#pragma once

#include <array>
#include <cstdint>

namespace railcast {

/// What a random number is for. Part of its key, so that a change in one effect never moves
/// another.
enum class RandomUse : std::uint32_t {
  kSensorDropout = 1,
  kRain = 2,
  kSnow = 3,
  kNoise = 4,
  kDetection = 5,
  kRangeNoise = 6,
  kChannelBias = 7,
  kPointing = 8,
  kClutter = 9,
  kFogEcho = 10,
  kFalseAlarm = 11,
  kFootprint = 12,
  kGroundRoughness = 100,
  kBallastRoughness = 101,
  kTreePlacement = 102,
  kGrassPlacement = 103,
  kPlantShape = 104,
};

/// Four independent, uniform 32-bit words that depend on the key and on nothing else.
///
/// Philox4x32-10 (Salmon, Moraes, Dror, Shaw 2011, "Parallel random numbers: as easy as 1, 2, 3"),
/// from Random123. `frame` and `item` name the frame and firing of an effect, or the chunk and
/// feature of a piece of the world; `block` counts when four words are not enough.
[[nodiscard]] std::array<std::uint32_t, 4> RandomWords(std::uint64_t seed,
                                                       RandomUse use,
                                                       std::uint32_t frame,
                                                       std::uint32_t item,
                                                       std::uint32_t block = 0);

/// Uniform in [0, 1) from the upper 24 bits of a word; exact in float32.
[[nodiscard]] constexpr float UnitFloat(std::uint32_t word) {
  return static_cast<float>(word >> 8U) * 0x1p-24F;
}

}  // namespace railcast
