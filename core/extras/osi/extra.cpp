#include <cstddef>
#include <filesystem>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/osi/trace_file.h"
#include "core/extras/ros/recording/bag_of_run.h"
#include "core/io/recording/recording_extras.h"
#include "core/io/verify/frame_clouds.h"

namespace railcast {
namespace {

void VerifyTrace(const std::filesystem::path& trace,
                 const std::vector<CloudsOfFrame>& frames,
                 bool is_finished,
                 ErrorList& faults) {
  const auto [messages, fault] = osi::ReadTrace(trace);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i >= messages.size()) {
      faults.Add({frames[i].place, "must have its message in " + ShownPath(trace), "none"});
    } else if (messages[i].hash != frames[i].hash) {
      faults.Add(
          {ShownPath(trace) + ": message " + NumberText(i + 1),
           "must have the hash " + ShownText(frames[i].hash) + ", as " + frames[i].place + " says",
           messages[i].hash});
    }
  }
  if (!is_finished) return;
  CheckHasItsEnd(trace, faults);
  if (!fault.empty()) faults.AddLine(fault);
  if (messages.size() > frames.size()) {
    faults.Add({ShownPath(trace),
                "must have a message for each of " + NumberText(frames.size()) + " frames",
                NumberText(messages.size())});
  }
}

}  // namespace

void AddOsi(RecordingExtras& extras) {
  extras.verify_trace = VerifyTrace;
}

}  // namespace railcast
