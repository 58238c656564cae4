#include "viewer/frames/recorded_frames.h"

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "viewer/frames/recorded_labels.h"

namespace railcast {
namespace {

constexpr std::size_t kMaxTurns = 24;      // For captures; a turn of a Pandar64 takes 5 MB.
constexpr std::size_t kMaxReaders = 4096;  // For files; a reader holds a few lines of text.

}  // namespace

RecordedFrames::RecordedFrames(const std::filesystem::path& source)
    : recording_(OpenRecording(source)), pictures_(source) {
  info_ = recording_->info();
  info_.labels = LabelsOf(info_);
  num_passed_ = info_.num_frames.value_or(0);
  if (!info_.num_frames) counter_.emplace(source);
}

std::size_t RecordedFrames::num_known() const {
  return counter_ ? std::max(num_passed_, counter_->num_counted()) : num_passed_;
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
    num_passed_ = first_reader_ + readers_.size();
    return false;
  }
  readers_.push_back(std::move(*reader));
  if (readers_.size() > (info_.num_frames ? kMaxReaders : kMaxTurns)) {
    readers_.pop_front();
    ++first_reader_;
  }
  num_passed_ = std::max(num_passed_, first_reader_ + readers_.size());
  return true;
}

std::shared_ptr<const ShownFrame> RecordedFrames::Get(std::size_t place) {
  if (auto kept = kept_.Use(place)) return kept;
  if (is_end_known_ && place >= num_passed_) return nullptr;
  if (place < first_reader_) Reopen();
  while (first_reader_ + readers_.size() <= place) {
    if (!Advance()) return nullptr;
  }
  auto shown = Shown(readers_[place - first_reader_]());
  kept_.Put(place, shown);
  return shown;
}

std::size_t RecordedFrames::PlaceOf(std::uint32_t frame_index) {
  const auto fail = [&](const std::string& what) -> std::size_t {
    throw InputError(ShownPath(info_.source) + ": has no frame " + NumberText(frame_index) +
                     " (it has " + what + ")");
  };
  const auto index_at = [&](std::size_t place) { return Get(place)->frame().index; };
  if (!Get(0)) return fail("none");
  const std::uint32_t first_index = index_at(0);
  if (frame_index >= first_index) {
    // Indices rise, by more than 1 where a stream lost frames, so that the frame cannot be at a
    // later place.
    std::size_t place = frame_index - first_index;
    if (!Get(place)) {
      SeekEnd();
      place = num_passed_ - 1;
    }
    if (index_at(place) > frame_index) {
      std::size_t begin = 0;
      while (begin < place) {
        const std::size_t middle = begin + (place - begin) / 2;
        if (index_at(middle) < frame_index) {
          begin = middle + 1;
        } else {
          place = middle;
        }
      }
    }
    if (index_at(place) == frame_index) return place;
  }
  SeekEnd();
  return fail(NumberText(first_index) + " to " + NumberText(index_at(num_passed_ - 1)));
}

void RecordedFrames::SeekEnd() {
  while (!is_end_known_) Advance();
}

}  // namespace railcast
