#include <cstddef>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/osi/trace_file.h"
#include "core/extras/ros/recording/bag_of_run.h"
#include "core/io/recording/recording_extras.h"

namespace railcast {
namespace {

void VerifyTrace(const std::filesystem::path& trace,
                 const NextClouds& next_frame,
                 bool is_finished,
                 ErrorList& faults) {
  osi::TraceReader messages(trace);
  std::size_t num_frames = 0;
  for (; const auto frame = next_frame(); ++num_frames) {
    const auto hash = messages.NextHash();
    if (!hash) {
      faults.Add({frame->place, "must have its message in " + ShownPath(trace), "none"});
    } else if (*hash != frame->hash) {
      faults.Add({ShownPath(trace) + ": message " + NumberText(num_frames + 1),
                  "must have the hash " + ShownText(frame->hash) + ", as " + frame->place + " says",
                  *hash});
    }
  }
  if (!is_finished) return;
  std::size_t num_messages = num_frames;
  while (messages.NextHash()) ++num_messages;
  CheckHasItsEnd(trace, faults);
  if (!messages.fault().empty()) faults.AddLine(messages.fault());
  if (num_messages > num_frames) {
    faults.Add({ShownPath(trace),
                "must have a message for each of " + NumberText(num_frames) + " frames",
                NumberText(num_messages)});
  }
}

}  // namespace

void AddOsi(RecordingExtras& extras) {
  extras.verify_trace = VerifyTrace;
}

}  // namespace railcast
