#include "viewer/pick/tracing.h"

#include <utility>

namespace railcast {

void Tracing::Ask(std::size_t source,
                  const RecordingInfo& info,
                  std::shared_ptr<const RecordedFrame> recorded,
                  std::uint32_t slot) {
  auto& trace = traces_[source];
  if (!trace) trace = std::make_unique<EffectTrace>(info);
  (void)trace->Take();  // Discard the answer to an earlier question.
  trace->Ask(std::move(recorded), slot);
  asked_ = source;
}

std::optional<std::string> Tracing::Take() {
  if (!asked_) return std::nullopt;
  auto answer = traces_[*asked_]->Take();
  if (answer) asked_.reset();
  return answer;
}

}  // namespace railcast
