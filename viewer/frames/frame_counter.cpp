#include "viewer/frames/frame_counter.h"

#include <stop_token>
#include <utility>

#include "core/base/error.h"
#include "railcast/io/recording.h"

namespace railcast {

FrameCounter::FrameCounter(std::filesystem::path source)
    : thread_([this, source = std::move(source)](const std::stop_token& stop) {
        Count(source, stop);
      }) {}

void FrameCounter::Count(const std::filesystem::path& source, const std::stop_token& stop) {
  try {
    const auto recording = OpenRecording(source);
    while (!stop.stop_requested() && recording->Next()) ++num_counted_;
  } catch (const InputError&) {
    // The error is reported when that frame is asked for.
  }
}

}  // namespace railcast
