#include "viewer/frames/recorded_frames.h"

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "core/base/number_text.h"
#include "viewer/frames/recorded_labels.h"

namespace railcast {
namespace {

constexpr std::size_t kMaxTurns = 64;      // Of a capture, half a megabyte each.
constexpr std::size_t kMaxReaders = 4096;  // Of files, some lines of text each.
// What frames may hold that are kept: some 300 MB.
constexpr std::size_t kMaxKeptSlots = 1U << 22U;

}  // namespace

RecordedFrames::RecordedFrames(const std::filesystem::path& source)
    : recording_(OpenRecording(source)) {
  info_ = recording_->info();
  info_.labels = LabelsOf(info_);
  num_known_ = info_.num_frames.value_or(0);
}

void RecordedFrames::Reopen() {
  recording_ = OpenRecording(info_.source);
  readers_.clear();
  first_reader_ = 0;
}

bool RecordedFrames::Advance() {
  auto reader = recording_->Next();
  if (!reader) {
    is_end_known_ = true;
    num_known_ = first_reader_ + readers_.size();
    return false;
  }
  readers_.push_back(std::move(*reader));
  if (readers_.size() > (info_.num_frames ? kMaxReaders : kMaxTurns)) {
    readers_.pop_front();
    ++first_reader_;
  }
  num_known_ = std::max(num_known_, first_reader_ + readers_.size());
  return true;
}

std::shared_ptr<const ShownFrame> RecordedFrames::Get(std::size_t place) {
  const auto kept = std::ranges::find(kept_, place, [](const auto& pair) { return pair.first; });
  if (kept != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, kept);
    return kept_.front().second;
  }
  if (is_end_known_ && place >= num_known_) return nullptr;
  if (place < first_reader_) Reopen();
  while (first_reader_ + readers_.size() <= place) {
    if (!Advance()) return nullptr;
  }
  auto shown = Shown(readers_[place - first_reader_]());
  kept_.emplace_front(place, shown);
  num_kept_slots_ += shown->frame().num_slots();
  while (num_kept_slots_ > kMaxKeptSlots && kept_.size() > 1) {
    num_kept_slots_ -= kept_.back().second->frame().num_slots();
    kept_.pop_back();
  }
  return shown;
}

std::size_t RecordedFrames::PlaceOf(std::uint32_t frame_index) {
  const auto fail = [&](const std::string& what) -> std::size_t {
    throw InputError(info_.source.string() + ": has no frame " + NumberText(frame_index) +
                     " (it has " + what + ")");
  };
  const auto first = Get(0);
  if (!first) return fail("none");
  const std::uint32_t first_index = first->frame().index;
  if (frame_index >= first_index) {
    // Numbers rise, by more than 1 where a stream lost frames: it cannot be at a later place.
    std::size_t place = frame_index - first_index;
    if (!Get(place)) {
      SeekEnd();
      place = num_known_ - 1;
    }
    while (Get(place)->frame().index > frame_index) --place;
    if (Get(place)->frame().index == frame_index) return place;
  }
  SeekEnd();
  return fail(NumberText(first_index) + " to " + NumberText(Get(num_known_ - 1)->frame().index));
}

void RecordedFrames::SeekEnd() {
  while (!is_end_known_) Advance();
}

}  // namespace railcast
