#include "core/io/verify/bag_clouds.h"

#include <algorithm>
#include <memory>
#include <optional>

#include "core/base/text.h"
#include "core/io/bag/bag.h"
#include "core/io/content_hash.h"
#include "core/io/mcap/byte_file.h"
#include "core/io/mcap/record_scan.h"
#include "core/io/osi/trace_file.h"

namespace railcast {
namespace {

/// Messages of one time.
struct CloudsAtTime {
  std::int64_t time_ns{};
  std::string bytes;
};

/// Reads the clouds of one time after another.
class CloudsReader {
 public:
  CloudsReader(const std::filesystem::path& bag, const std::vector<std::string>& topics)
      : reader_(bag::OpenBag(bag)) {
    std::vector<std::size_t> wanted;
    for (const std::string& topic : topics) {
      const auto found = std::ranges::find(reader_->topics(), topic, &bag::BagTopic::name);
      if (found == reader_->topics().end()) {
        throw InputError(ShownPath(bag) + ": must have the topic " + ShownText(topic));
      }
      wanted.push_back(static_cast<std::size_t>(found - reader_->topics().begin()));
    }
    reader_->Select(wanted);
    message_ = reader_->Next();
  }

  std::optional<CloudsAtTime> Next() {
    if (!message_) return std::nullopt;
    CloudsAtTime clouds{message_->time_ns, {}};
    for (; message_ && message_->time_ns == clouds.time_ns; message_ = reader_->Next()) {
      clouds.bytes.append(reinterpret_cast<const char*>(message_->data.data()),
                          message_->data.size());
    }
    return clouds;
  }

 private:
  std::unique_ptr<bag::BagReader> reader_;
  std::optional<bag::BagMessage> message_;
};

}  // namespace

void CompareWithBag(const std::filesystem::path& bag,
                    const std::vector<std::string>& topics,
                    const std::vector<CloudsOfFrame>& frames,
                    ErrorList& faults) {
  CloudsReader reader(bag, topics);
  std::optional<CloudsAtTime> clouds = reader.Next();
  for (const CloudsOfFrame& frame : frames) {
    for (; clouds && clouds->time_ns < frame.stamp_ns; clouds = reader.Next()) {
      faults.Add(
          {ShownPath(bag), "has a cloud of no frame at " + SecondsText(clouds->time_ns), ""});
    }
    if (!clouds || clouds->time_ns != frame.stamp_ns) {
      faults.Add({frame.place, "must have its clouds in " + ShownPath(bag), "none"});
      continue;
    }
    const std::string hash = ContentHash(clouds->bytes);
    if (hash != frame.hash) {
      faults.Add({ShownPath(bag),
                  "must have clouds of the hash " + ShownText(frame.hash) + " at " +
                      SecondsText(frame.stamp_ns) + ", as " + frame.place + " says",
                  hash});
    }
    clouds = reader.Next();
  }
  if (clouds) {
    faults.Add({ShownPath(bag), "has a cloud of no frame at " + SecondsText(clouds->time_ns), ""});
  }
}

void CheckHasItsEnd(const std::filesystem::path& file, ErrorList& faults) {
  if (!std::filesystem::is_regular_file(file)) return;
  const mcap::ByteFile bytes(file, ShownPath(file));
  if (!mcap::BeginsAsMcap(bytes)) return;
  mcap::RecordScan scan(bytes);
  while (scan.Next()) {
  }
  if (!scan.is_complete()) {
    faults.Add({ShownPath(file), "must have the end of an MCAP file: it is unfinished or cut", ""});
  }
}

void CompareWithTrace(const std::filesystem::path& trace,
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

}  // namespace railcast
