#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/pick/effect_trace.h"

namespace railcast {

/// The effect trace of the point that was picked last, of any source.
class Tracing {
 public:
  explicit Tracing(std::size_t num_sources) : traces_(num_sources) {}

  /// Asks what each effect did to a slot's firing.
  /// @param info Recording of that source.
  void Ask(std::size_t source,
           const RecordingInfo& info,
           std::shared_ptr<const RecordedFrame> recorded,
           std::uint32_t slot);
  /// Drops the question, because another point or none is picked now.
  void Forget() { asked_.reset(); }
  /// Returns the answer, once, as soon as it is ready.
  [[nodiscard]] std::optional<std::string> Take();

 private:
  /// By source; each is made for its first question.
  std::vector<std::unique_ptr<EffectTrace>> traces_;
  std::optional<std::size_t> asked_;  ///< Source of the pending answer.
};

}  // namespace railcast
