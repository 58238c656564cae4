#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/detect/echo_tiles.h"
#include "core/frame/frame.h"
#include "core/trace/surface.h"

namespace railcast {

/// Which of a firing's detected echoes a sensor reports, in the order of its slots.
enum class ReturnMode {
  kStrongest,
  kFirst,
  kLast,
  kDual,    ///< Strongest and last; if they are the same, strongest and second strongest.
  kTriple,  ///< Strongest, last and first; what coincides gives way to the next strongest.
};

/// @pre `name` is one of the names in ReceiverSpec.
[[nodiscard]] ReturnMode ReturnModeOf(std::string_view name);
[[nodiscard]] std::uint32_t NumReturns(ReturnMode mode);

/// All echoes of one firing: the first one, then the further ones.
/// @param beam A lane of `echoes.first`.
[[nodiscard]] std::vector<EchoTiles::Place> EchoesOf(EchoTiles& echoes, std::size_t beam);
/// Those of them that become returns, in the order of their slots.
[[nodiscard]] std::vector<EchoTiles::Place> ReturnsOf(ReturnMode mode,
                                                      EchoTiles& echoes,
                                                      std::size_t beam);

/// Where a tile's firings go in a frame of one return. Lanes after num_firings fill up a packet:
/// not stored.
struct SlotRange {
  const std::uint32_t* slots{};
  std::size_t num_firings{};
};

/// Writes the returns of a tile's firings, measurement and truth, into the frame. A firing without
/// any has in its first slot what it would have been: the strongest echo of a surface, else what
/// the central ray says.
class ReturnStore {
 public:
  /// @param has_shares Whether beams have a width: else footprint_share and mixed_share are left
  ///   alone.
  ReturnStore(ReturnMode mode, bool has_shares) : mode_(mode), has_shares_(has_shares) {}

  void Store(EchoTiles& echoes,
             const std::vector<Surface>& surfaces,
             const SlotRange& slots,
             Frame& frame) const;

 private:
  ReturnMode mode_;
  bool has_shares_;
};

}  // namespace railcast
