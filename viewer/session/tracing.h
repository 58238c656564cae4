#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/pick/effect_trace.h"

namespace railcast {

/// The effect trace of the point that was picked last, of whichever source.
class Tracing {
 public:
  explicit Tracing(std::size_t num_sources) : traces_(num_sources) {}

  /// Asks what each effect made of a slot's firing.
  /// @param info Of that source.
  void Ask(std::size_t source,
           const RecordingInfo& info,
           std::shared_ptr<const RecordedFrame> recorded,
           std::uint32_t slot);
  /// Another point is of interest, or none: what was asked is not answered.
  void Forget() { asked_.reset(); }
  /// The answer, once, as soon as it is there.
  [[nodiscard]] std::optional<std::string> Take();

 private:
  std::vector<std::unique_ptr<EffectTrace>> traces_;  ///< By source; made when first asked.
  std::optional<std::size_t> asked_;                  ///< The source whose answer is waited for.
};

}  // namespace railcast
