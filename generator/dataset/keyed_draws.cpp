#include "generator/dataset/keyed_draws.h"

#include <array>

#include "core/base/random.h"

namespace railcast {
namespace {

/// FNV-1a, 64 bits (Fowler, Noll, Vo), over the name and then the bytes of `turn`.
std::uint64_t HashOfName(std::string_view name, std::uint32_t turn) {
  constexpr std::uint64_t kOffset = 0xcbf29ce484222325U;
  constexpr std::uint64_t kPrime = 0x100000001b3U;
  std::uint64_t hash = kOffset;
  for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * kPrime;
  for (int i = 0; i < 4; ++i) hash = (hash ^ ((turn >> (8 * i)) & 0xFFU)) * kPrime;
  return hash;
}

std::uint64_t WordsOfName(std::uint64_t seed,
                          std::uint32_t scenario,
                          std::string_view name,
                          std::uint32_t turn) {
  const std::uint64_t hash = HashOfName(name, turn);
  const std::array<std::uint32_t, 4> words =
      RandomWords(seed, RandomUse::kDatasetDraw, scenario, static_cast<std::uint32_t>(hash),
                  static_cast<std::uint32_t>(hash >> 32U));
  return (std::uint64_t{words[0]} << 32U) | words[1];
}

}  // namespace

double KeyedDraws::Unit(std::string_view name, std::uint32_t turn) const {
  return static_cast<double>(WordsOfName(seed_, scenario_, name, turn) >> 11U) * 0x1p-53;
}

std::uint64_t KeyedDraws::Seed(std::string_view name) const {
  return WordsOfName(seed_, scenario_, name, 0);
}

}  // namespace railcast
