#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/detect/base/echo_tiles.h"
#include "railcast/effects.h"
#include "railcast/frame.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// Number of slots per firing.
[[nodiscard]] std::uint32_t NumReturns(ReturnMode mode);

/// Which of a firing's detected echoes become returns.
struct ReturnRule {
  ReturnMode mode{};
  /// How far behind an echo the receiver is blind, m; 0 without effect `dead_time`.
  float dead_length_m{};
  /// Power ratio at which the receiver saturates; 0 without effect `saturation`.
  float saturation_ratio{};
};

/// Returns all echoes of one firing: the first one, then the others.
/// @param beam A lane of `echoes.first`.
[[nodiscard]] std::vector<EchoTiles::Place> EchoesOf(EchoTiles& echoes, std::size_t beam);
/// Returns those echoes of a firing that become returns, in slot order.
///
/// Effect `dead_time`: from the nearest detected echo on, an echo is passed over if its measured
/// range is less than dead_length_m behind the last one that was not; the mode chooses among the
/// others. Passed-over echoes do not prolong the blindness.
///
/// Effect `saturation`, which comes before it: echoes that are above the threshold without a gap
/// are one where part of them is saturated. It is represented by the strongest, which is above the
/// threshold for longest.
[[nodiscard]] std::vector<EchoTiles::Place> ReturnsOf(const ReturnRule& rule,
                                                      EchoTiles& echoes,
                                                      std::size_t beam);

/// Slots of a tile's firings in a frame with one return per firing. Lanes beyond `num_firings` are
/// padding and are not stored.
struct SlotRange {
  const std::uint32_t* slots{};
  std::size_t num_firings{};
};

/// Leaves a slot without a return: values are NaN, and it is of no label, instance and material.
void ClearSlot(std::size_t slot, Frame& frame);

/// Callback for each echo that is stored in a slot.
/// @param beam A lane of `echoes.first`.
using StoredEcho =
    std::function<void(const EchoTiles::Place& echo, std::size_t beam, std::size_t slot)>;

/// Writes the returns of a tile's firings, both measurement and ground truth, into the frame. The
/// first slot of a firing without returns describes the strongest surface echo that was below the
/// threshold or, if there is none, the result of the central ray.
class ReturnStore {
 public:
  /// @param has_shares Whether beams have a width. If not, footprint_share and mixed_share are not
  ///   written.
  ReturnStore(const ReturnRule& rule, bool has_shares) : rule_(rule), has_shares_(has_shares) {}

  /// @param stored Called after each echo is stored; may be empty.
  void Store(EchoTiles& echoes,
             const std::vector<Surface>& surfaces,
             const SlotRange& slots,
             Frame& frame,
             const StoredEcho& stored = {}) const;

 private:
  void StoreOnlyEcho(const EchoTiles::Place& echo,
                     const std::vector<Surface>& surfaces,
                     std::size_t slot,
                     Frame& frame) const;

  ReturnRule rule_;
  bool has_shares_;
};

}  // namespace railcast
