#include "core/base/random.h"

#include <Random123/philox.h>

namespace railcast {

std::array<std::uint32_t, 4> RandomWords(std::uint64_t seed,
                                         RandomUse use,
                                         std::uint32_t frame,
                                         std::uint32_t item,
                                         std::uint32_t block) {
  const r123::Philox4x32::ctr_type counter = {
      {item, frame, static_cast<std::uint32_t>(use), block}};
  const r123::Philox4x32::key_type key = {
      {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U)}};
  const r123::Philox4x32::ctr_type words = r123::Philox4x32{}(counter, key);
  return {words[0], words[1], words[2], words[3]};
}

}  // namespace railcast
