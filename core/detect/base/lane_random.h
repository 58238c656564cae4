// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_LANE_RANDOM_H_
#define RAILCAST_DETECT_LANE_RANDOM_H_

#include <cstdint>

#include "core/base/random.h"
#include "core/detect/base/detect_tile.h"
#include "core/detect/base/effect_parameters.h"
#include "core/detect/base/vector_math.h"

namespace railcast::RAILCAST_ISA {

/// The part of a random key that the lanes of a tile share.
struct LaneKey {
  std::uint64_t seed{};
  RandomUse use{};
  std::uint32_t frame{};
};

struct Words {
  std::uint32_t a, b, c, d;
};

/// The words of railcast::RandomWords, bit for bit, in a form that vectorises over lanes.
[[nodiscard]] inline Words LaneWords(const LaneKey& key,
                                     std::uint32_t firing,
                                     std::uint32_t block) {
  Words w{firing, key.frame, static_cast<std::uint32_t>(key.use), block};
  auto k0 = static_cast<std::uint32_t>(key.seed);
  auto k1 = static_cast<std::uint32_t>(key.seed >> 32U);
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53U} * w.a;
    const std::uint64_t p1 = std::uint64_t{0xCD9E8D57U} * w.c;
    w = {static_cast<std::uint32_t>(p1 >> 32U) ^ w.b ^ k0, static_cast<std::uint32_t>(p1),
         static_cast<std::uint32_t>(p0 >> 32U) ^ w.d ^ k1, static_cast<std::uint32_t>(p0)};
    k0 += 0x9E3779B9U;
    k1 += 0xBB67AE85U;
  }
  return w;
}

/// As UnitFloat, but converts a signed integer: older instruction sets cannot convert unsigned
/// ones.
[[nodiscard]] inline float LaneUnit(std::uint32_t word) {
  return static_cast<float>(static_cast<std::int32_t>(word >> 8U)) * 0x1p-24F;
}

/// One uniform number in [0, 1) for each lane's firing.
inline void DrawUniforms(const DetectTile& tile, const DrawKey& draw, float* uniforms) {
  const LaneKey key{draw.seed, draw.use, tile.frame};
  const std::uint32_t block = draw.block;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    uniforms[i] = LaneUnit(LaneWords(key, tile.firing[i], block).a);
  }
}

struct Normals {
  float a, b, c, d;
};

/// Four standard normal deviates from four words (Box and Muller 1958). The uniform under the
/// logarithm has 24 bits and is never 0, so no deviate is larger than 5.77.
[[nodiscard]] inline Normals LaneNormals(const Words& w) {
  const float r0 = std::sqrt(-2.0F * Log(LaneUnit(w.a) + 0x1p-24F));
  const float r1 = std::sqrt(-2.0F * Log(LaneUnit(w.c) + 0x1p-24F));
  float c0{};
  float s0{};
  float c1{};
  float s1{};
  CosSinTurn(LaneUnit(w.b), c0, s0);
  CosSinTurn(LaneUnit(w.d), c1, s1);
  return {r0 * c0, r0 * s0, r1 * c1, r1 * s1};
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_LANE_RANDOM_H_
