#include "core/extras/ros/recording/bag_of_run.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/base/text.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/bag/bag_lines.h"
#include "core/extras/ros/mcap/byte_file.h"
#include "core/extras/ros/mcap/record_scan.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/point_layout.h"
#include "core/extras/ros/recording/cloud_message.h"
#include "core/io/content_hash.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/run_record.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

Cloud ParseCloud(std::span<const std::byte> bytes) {
  return MakeCloud(ros::FromCdr<ros::PointCloud2>(bytes));
}

/// Reads one cloud after another.
class CloudsReader {
 public:
  /// @throws InputError "bag: rule" if its clouds cannot be put into the slots of the scan.
  explicit CloudsReader(const SequenceSummary& summary)
      : file_((summary.directory / summary.run.bag.value().path).lexically_normal()) {
    if (!exists(file_)) file_ += kUnfinishedSuffix;
    if (ros::ParseCloudSpec(summary.run.fields, true, true).layout != ros::PointLayout::kRailcast) {
      throw InputError(ShownPath(summary.directory) + ": must have railcast's fields (got " +
                       summary.run.fields + "); open " + ShownPath(file_) + " instead");
    }
    reader_ = bag::OpenBag(file_);
    const auto& topics = reader_->topics();
    const auto found =
        std::ranges::find(topics, summary.run.bag->topics.front(), &bag::BagTopic::name);
    if (found == topics.end()) {
      throw InputError(ShownPath(file_) + ": must have the topic " +
                       ShownText(summary.run.bag->topics.front()));
    }
    reader_->Select({static_cast<std::size_t>(found - topics.begin())});
  }

  /// @throws InputError "bag: rule" if there is no further cloud.
  [[nodiscard]] CloudInBag Next() {
    const auto message = reader_->Next();
    if (!message) throw InputError(ShownPath(file_) + ": must have a cloud for each frame");
    return {ShownPath(file_), {message->data.begin(), message->data.end()}, ParseCloud};
  }

 private:
  std::filesystem::path file_;
  std::unique_ptr<bag::BagReader> reader_;
};

/// Messages of one time.
struct CloudsAtTime {
  std::int64_t time_ns{};
  std::string bytes;
};

/// Reads the clouds of one time after another.
class CloudTimesReader {
 public:
  CloudTimesReader(const std::filesystem::path& bag, const std::vector<std::string>& topics)
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

/// Compares the clouds in a bag with those of frames.
void CompareWithBag(const std::filesystem::path& bag,
                    const std::vector<std::string>& topics,
                    const NextClouds& next_frame,
                    ErrorList& faults) {
  CloudTimesReader reader(bag, topics);
  std::optional<CloudsAtTime> clouds = reader.Next();
  while (const auto next = next_frame()) {
    const CloudsOfFrame& frame = *next;
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

}  // namespace

std::function<CloudInBag()> CloudsOfBag(const SequenceSummary& summary) {
  return [reader = std::make_shared<CloudsReader>(summary)] { return reader->Next(); };
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

void VerifyBag(const std::filesystem::path& bag,
               const BagRecord& record,
               const NextClouds& next_frame,
               bool is_finished,
               ErrorList& faults) {
  // Bags of 0.2 have no such file.
  if (!record.lines.empty()) {
    (void)Attempt("", faults, [&] { return CompareWithBagLines(bag, is_finished, faults), true; });
  }
  CompareWithBag(bag, record.topics, next_frame, faults);
  if (is_finished) CheckHasItsEnd(bag, faults);
}

}  // namespace railcast
