#pragma once

#include <array>
#include <cstdint>

namespace railcast {

/// Purpose of a random number. It is part of the random number's key, so that changing one effect
/// never alters the draws of another.
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
  kCover = 13,
  kInterference = 14,
  kSpray = 15,
  kSensorKey = 16,
  kFogPatches = 17,
  kVelocity = 18,
  kRecordedDetection = 19,
  kCertificate = 20,
  kIntensityNoise = 21,
  kChannelGain = 22,
  kEdgeLoss = 23,
  kGroundRoughness = 100,
  kBallastRoughness = 101,
  kTreePlacement = 102,
  kGrassPlacement = 103,
  kPlantShape = 104,
  kGusts = 105,
  kTreeSway = 106,
  kSpanSway = 107,
  kPuddles = 108,
  kRelief = 120,
  kWoods = 121,
  kBushPlacement = 122,
  kGrassFade = 123,
  kFields = 124,
  kTrackIrregularity = 125,
  kRandomWeather = 200,
  kDatasetDraw = 201,
  kMotionNoise = 300,
  kMotionDrift = 301,
  kForestDraw = 400,
  kLabelShuffle = 401,
  kRareDraw = 402,
};

/// Four independent, uniform 32-bit words that depend on the arguments only.
///
/// Philox4x32-10 (Salmon, Moraes, Dror, Shaw 2011, "Parallel random numbers: as easy as 1, 2, 3"),
/// from Random123.
/// @param frame, item Frame and firing of an effect, or chunk and feature of a piece of the world.
/// @param block Counter for draws that need more than four words.
[[nodiscard]] std::array<std::uint32_t, 4> RandomWords(std::uint64_t seed,
                                                       RandomUse use,
                                                       std::uint32_t frame,
                                                       std::uint32_t item,
                                                       std::uint32_t block = 0);

/// Converts the upper 24 bits of a word to a uniform number in [0, 1); exact in float32.
[[nodiscard]] constexpr float UnitFloat(std::uint32_t word) {
  return static_cast<float>(word >> 8U) * 0x1p-24F;
}

}  // namespace railcast
