#include "generator/replay/frame_source.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

/// Says of each slot whether it has a point, where the recording says no more.
void FillOutcomes(RecordedFrame& recorded) {
  if (recorded.Has("outcome")) return;
  Frame& frame = recorded.frame;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    frame.outcome[i] = std::isnan(frame.x[i]) ? Outcome::kNoSurface : Outcome::kReturned;
  }
}

}  // namespace

FrameSource::FrameSource(std::unique_ptr<Recording> recording, const FrameReplaySpec& spec)
    : recording_(std::move(recording)), spec_(spec), times_(spec.pace) {
  for (std::uint64_t i = 0; i < spec.frames.start && recording_->Next(); ++i) continue;
  next_ = Read();
  if (!next_) throw NoSuchFrame(ShownPath(info().source), spec.frames.start);
  if (!next_->Has("x")) {
    throw InputError(ShownPath(info().source) + ": must have points (got a sequence without)");
  }
}

std::string FrameSource::name() const {
  const auto& scenario = info().scenario;
  return scenario && !scenario->lidar.name.empty() ? scenario->lidar.name : "lidar";
}

std::optional<RecordedFrame> FrameSource::Read() {
  if (num_read_ == spec_.frames.count) return std::nullopt;
  const auto read = recording_->Next();
  if (!read) return std::nullopt;
  RecordedFrame recorded = (*read)();
  FillOutcomes(recorded);
  if (spec_.rate_hz) {
    recorded.frame.stamp_ns = std::llround(1e9 * static_cast<double>(num_read_) / *spec_.rate_hz);
  }
  ++num_read_;
  if (next_ && recorded.frame.stamp_ns == next_->frame.stamp_ns) {
    throw InputError(recorded.name +
                     ": stamp: must differ from that of the frame before, or --rate-hz must say "
                     "how many frames a second there are (got " +
                     NumberText(recorded.frame.stamp_ns) + " ns)");
  }
  return recorded;
}

bool FrameSource::Load() {
  if (fault_ && !next_) std::rethrow_exception(fault_);
  if (!next_) return false;
  std::optional<RecordedFrame> after;
  try {
    after = Read();
  } catch (const InputError&) {
    // Of a recording that cannot be replayed nothing is sent, of a damaged one what is whole.
    if (!frame_) throw;
    fault_ = std::current_exception();
  }
  frame_ = std::exchange(next_, std::move(after));
  constexpr std::int64_t kLongest_ns = 100'000'000;
  begin_ns_ = times_.Of(frame_->frame.stamp_ns);
  const std::int64_t next_ns = next_ ? times_.Of(next_->frame.stamp_ns) : begin_ns_ + kLongest_ns;
  span_ns_ = std::min(next_ns - begin_ns_, kLongest_ns);
  return true;
}

const RecordedFrame& FrameSource::StampedFrame() {
  if (utc_begin_ns_) frame_->frame.stamp_ns = *utc_begin_ns_ + begin_ns_;
  return *frame_;
}

}  // namespace railcast
