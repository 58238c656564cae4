#include "core/io/verify/frame_clouds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <numeric>
#include <optional>

#include "core/base/text.h"
#include "core/extras/osi/trace_file.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/mcap/byte_file.h"
#include "core/extras/ros/mcap/record_scan.h"
#include "core/io/content_hash.h"
#include "core/scenario/json_text.h"

namespace railcast {
namespace {

// Which of the stored slots have a point; nothing if the cloud does not say.
std::optional<std::vector<bool>> StoredPoints(const Cloud& cloud, const FrameFormat& format) {
  std::vector<bool> has_point(cloud.num_points(), !format.has_all_slots);
  if (!format.has_all_slots) return has_point;
  const CloudField* const x = cloud.Find("x");
  if (x == nullptr) return std::nullopt;
  VisitField(cloud, *x, [&](std::size_t i, auto value) {
    has_point[i] = std::isfinite(static_cast<double>(value));
  });
  return has_point;
}

// The columns of a data set's layout have ids of that data set.
std::map<std::string, std::uint64_t> PointsPerLabel(const Cloud& cloud,
                                                    const CloudField& column,
                                                    const std::vector<bool>& has_point,
                                                    const LabelTable& labels) {
  std::map<std::uint32_t, std::uint64_t> num_by_id;
  VisitField(cloud, column, [&](std::size_t i, auto value) {
    if (has_point[i]) ++num_by_id[static_cast<std::uint32_t>(value)];
  });
  std::map<std::string, std::uint64_t> counts;
  for (const auto& [id, num] : num_by_id) {
    const Label* const label = labels.Find(id);
    counts[label == nullptr ? "label " + NumberText(id) : label->name] = num;
  }
  return counts;
}

// A firing's outcome is that of its first slot.
std::optional<OutcomeCounts> FiringsPerOutcome(const Cloud& cloud,
                                               const CloudField& column,
                                               std::uint64_t num_firings) {
  if (num_firings == 0 || cloud.num_points() % num_firings != 0) return std::nullopt;
  const std::size_t returns = cloud.num_points() / num_firings;
  OutcomeCounts counts;
  bool is_known = true;
  VisitField(cloud, column, [&](std::size_t i, auto value) {
    if (i % returns != 0) return;
    const auto outcome = static_cast<std::size_t>(value);
    is_known = is_known && outcome < counts.size();
    if (is_known) ++counts[outcome];
  });
  if (!is_known) return std::nullopt;
  return counts;
}

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

void CompareCounts(const FrameCounts& counted,
                   const FrameCounts& got,
                   const CountsPlace& place,
                   ErrorList& faults) {
  const auto compare = [&](const std::string& pointer, std::uint64_t must_be, std::uint64_t is) {
    if (must_be == is) return;
    faults.Add({place.place + ": " + pointer,
                "must be " + NumberText(must_be) + ", " + place.compared, NumberText(is)});
  };
  compare("/points", counted.points, got.points);
  for (std::size_t i = 0; i < got.outcomes.size(); ++i) {
    compare("/outcomes/" + std::string(kOutcomeNames[i]), counted.outcomes[i], got.outcomes[i]);
  }
  const auto pointer_of = [](const std::string& label) {
    return "/points_per_label" + PointerStep(label);
  };
  for (const auto& [label, num] : counted.points_per_label) {
    const auto found = got.points_per_label.find(label);
    compare(pointer_of(label), num, found == got.points_per_label.end() ? 0 : found->second);
  }
  for (const auto& [label, num] : got.points_per_label) {
    if (counted.points_per_label.contains(label)) continue;
    faults.Add({place.place + ": " + pointer_of(label), place.is_absent, ""});
  }
}

void CompareWithCloud(const CountedCloud& counted,
                      const FrameCounts& line,
                      const std::string& place,
                      ErrorList& faults) {
  const auto& [cloud, format, labels, file] = counted;
  const auto has_point = StoredPoints(cloud, format);
  if (!has_point) return;
  FrameCounts expected = line;
  expected.points = static_cast<std::uint64_t>(std::ranges::count(*has_point, true));
  const CloudField* const label = cloud.Find("label");
  if (label != nullptr && !format.dataset) {
    expected.points_per_label = PointsPerLabel(cloud, *label, *has_point, labels);
  }
  const CloudField* const outcome = cloud.Find("outcome");
  if (outcome != nullptr && format.has_all_slots) {
    const std::uint64_t num_firings =
        std::accumulate(line.outcomes.begin(), line.outcomes.end(), std::uint64_t{0});
    const auto outcomes = FiringsPerOutcome(cloud, *outcome, num_firings);
    if (outcomes) {
      expected.outcomes = *outcomes;
    } else {
      faults.Add({place + ": /outcomes", "must be those of the firings in " + ShownPath(file), ""});
    }
  }
  CompareCounts(expected, line,
                {place, "as counted in " + ShownPath(file), "is not in " + ShownPath(file)},
                faults);
}

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
