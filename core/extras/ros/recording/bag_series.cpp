#include "core/extras/ros/recording/bag_series.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "core/extras/ros/recording/bag_recording.h"
#include "core/extras/ros/recording/packet_messages.h"
#include "core/io/recording/recording_kinds.h"

namespace railcast {
namespace {

/// What a message says before its points.
struct MessageHead {
  std::string frame_id{};
  std::int64_t stamp_ns{};
  bool is_empty{};  ///< Without points.

  [[nodiscard]] bool is_of_any() const { return is_empty && frame_id.empty(); }
};

/// Reads no more than the head; nothing is known of messages without one.
MessageHead HeadOf(const bag::BagMessage& message, const bag::BagTopic& topic) {
  constexpr std::array<std::string_view, 3> kPackets = {
      ros::PandarScan::kName, ros::NebulaPackets::kName, ros::VelodyneScan::kName};
  const bool is_cloud = topic.type == ros::PointCloud2::kName;
  if (!is_cloud && !IsOfLivox(topic) && std::ranges::find(kPackets, topic.type) == kPackets.end()) {
    return {.stamp_ns = message.time_ns};
  }
  ros::cdr::Reader reader(topic.type, message.data);
  ros::Header header;
  reader.Take(header);
  std::uint32_t height = 1;
  std::uint32_t width = 1;
  if (is_cloud) {
    reader.Take(height);
    reader.Take(width);
  }
  return {PlainFrame(header.frame_id), header.stamp.sec * kNsPerS + header.stamp.nanosec,
          height == 0 || width == 0};
}

std::string NameOf(const std::string& frame_id, std::uint64_t channel) {
  return frame_id + kSeriesMark + NumberText(channel);
}

/// The messages of a frame_id in a channel.
struct SeriesPart {
  std::string frame_id;
  std::uint64_t channel{};
  std::uint64_t num{};
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
  std::vector<double> ahead_ns{};  ///< Stamps, of the times at which the bag got them.
  bool is_alone{};                 ///< Whether no other part has its frame_id.
};

using SeriesParts = std::vector<SeriesPart>;

SeriesParts PartsInTopic(bag::BagReader& bag, std::size_t topic, const std::string& place) {
  std::map<std::pair<std::string, std::uint64_t>, SeriesPart> parts;
  std::uint64_t index = 0;
  bag.Select({topic});
  while (const auto message = bag.Next()) {
    const MessageHead head = AtPlace(place + "message " + NumberText(index++) + ": ",
                                     [&] { return HeadOf(*message, bag.topics()[topic]); });
    if (head.is_of_any()) continue;
    SeriesPart& part = parts[{head.frame_id, message->channel}];
    ++part.num;
    part.first_ns = std::min(part.first_ns, head.stamp_ns);
    part.last_ns = std::max(part.last_ns, head.stamp_ns);
    part.ahead_ns.push_back(static_cast<double>(head.stamp_ns) -
                            static_cast<double>(message->time_ns));
  }
  SeriesParts list;
  for (auto& [name, part] : parts) {
    std::tie(part.frame_id, part.channel) = name;
    list.push_back(std::move(part));
  }
  return list;
}

/// Joins the parts of a frame_id that follow each other, as of a recording in several files.
SeriesParts Joined(SeriesParts parts) {
  std::ranges::stable_sort(parts, {}, [](const SeriesPart& part) {
    return std::pair(std::string_view(part.frame_id), part.first_ns);
  });
  SeriesParts joined;
  for (auto begin = parts.begin(); begin != parts.end();) {
    const auto end = std::find_if(begin, parts.end(), [&](const SeriesPart& part) {
      return part.frame_id != begin->frame_id;
    });
    const auto meets = [](const SeriesPart& a, const SeriesPart& b) {
      return b.first_ns <= a.last_ns;
    };
    const bool is_one = std::adjacent_find(begin, end, meets) == end;
    for (; begin != end; ++begin) {
      if (!is_one || joined.empty() || joined.back().frame_id != begin->frame_id) {
        joined.push_back(std::move(*begin));
        joined.back().is_alone = is_one;
        continue;
      }
      joined.back().num += begin->num;
      joined.back().last_ns = begin->last_ns;
      joined.back().ahead_ns.insert(joined.back().ahead_ns.end(), begin->ahead_ns.begin(),
                                    begin->ahead_ns.end());
    }
  }
  return joined;
}

/// As --frame-id takes it.
std::string ChoiceOf(const SeriesPart& part) {
  return part.is_alone && !part.frame_id.empty() ? part.frame_id
                                                 : NameOf(part.frame_id, part.channel);
}

/// The first of all, with the number of the others.
template <typename TextOf>
std::string ListOf(const SeriesParts& all, TextOf text_of) {
  constexpr std::size_t kMost = 20;
  std::string list = Join(std::span(all).first(std::min(all.size(), kMost)), ", ", text_of);
  if (all.size() > kMost) list += " and " + NumberText(all.size() - kMost) + " others";
  return list;
}

/// @throws InputError as ReadHeaders().
SeriesPart Chosen(SeriesParts all, const std::string& place, const std::string& series) {
  if (series.empty()) {
    if (all.size() == 1) return std::move(all.front());
    const auto text_of = [](const SeriesPart& part) {
      return ShownText(ChoiceOf(part)) + " (" + Amount(part.num, "messages") + ")";
    };
    throw InputError(place + "holds " + NumberText(all.size()) +
                     " series, by frame_id and channel: " + ListOf(all, text_of) +
                     "; --frame-id picks one");
  }
  const auto is_named = [&](const SeriesPart& part) {
    return series == ChoiceOf(part) || series == NameOf(part.frame_id, part.channel);
  };
  const auto found = std::ranges::find_if(all, is_named);
  if (found != all.end()) return std::move(*found);
  const auto text_of = [](const SeriesPart& part) { return ShownText(ChoiceOf(part)); };
  throw InputError(place + "--frame-id: must be one of " + ListOf(all, text_of) + " (got " +
                   ShownText(series) + ")");
}

}  // namespace

bool IsOfSeries(const bag::BagReader& bag,
                const bag::BagMessage& message,
                const std::string& series) {
  if (series.empty()) return true;
  const MessageHead head = HeadOf(message, bag.topics()[message.topic]);
  return head.is_of_any() || series == head.frame_id ||
         series == NameOf(head.frame_id, message.channel);
}

std::optional<bag::BagMessage> NextOfSeries(bag::BagReader& bag, const std::string& series) {
  while (auto message = bag.Next()) {
    if (IsOfSeries(bag, *message, series)) return message;
  }
  return std::nullopt;
}

CloudHeaders ReadHeaders(bag::BagReader& bag,
                         std::size_t topic,
                         const std::string& place,
                         const std::string& series) {
  CloudHeaders headers{.topic = bag.topics()[topic].name, .frame_id = {}};
  SeriesParts parts = Joined(PartsInTopic(bag, topic, place));
  if (parts.empty()) return headers;
  SeriesPart chosen = Chosen(std::move(parts), place + ShownText(headers.topic) + ": ", series);
  headers.frame_id = std::move(chosen.frame_id);
  headers.first_ns = chosen.first_ns;
  headers.last_ns = chosen.last_ns;
  headers.ahead_ns = AheadOf(std::move(chosen.ahead_ns));
  return headers;
}

void OverlapCheck::Take(const RecordedFrame& recorded) {
  const std::lock_guard lock(mutex_);
  const Frame& frame = recorded.frame;
  const auto [span, is_new] =
      spans_.try_emplace(frame.index, Span{frame.stamp_ns, frame.duration_ns, recorded.name});
  if (!is_new) return;
  const auto before = frame.index == 0 ? spans_.end() : spans_.find(frame.index - 1);
  const auto after = spans_.find(frame.index + 1);
  if (frame.index == 0) span->second.num_compared = 1;
  if (before != spans_.end()) Compare(before, span);
  if (after != spans_.end()) Compare(span, after);
  constexpr int kNeighbours = 2;
  for (const auto each : {before, span, after}) {
    if (each != spans_.end() && each->second.num_compared == kNeighbours) spans_.erase(each);
  }
  // Where only every tenth frame is read, no neighbour comes.
  constexpr std::size_t kMostWaiting = 4096;
  if (spans_.size() > kMostWaiting) spans_.erase(spans_.begin());
}

void OverlapCheck::Compare(Spans::iterator before, Spans::iterator after) {
  ++before->second.num_compared;
  ++after->second.num_compared;
  // The ends of turns are not sharp, and stamps of a computer's clock tremble.
  constexpr double kMost = 0.25;
  const Span& a = before->second;
  const Span& b = after->second;
  const auto duration_ns = static_cast<double>(std::min(a.duration_ns, b.duration_ns));
  const auto overlap_ns =
      static_cast<double>(std::min(a.begin_ns + a.duration_ns, b.begin_ns + b.duration_ns) -
                          std::max(a.begin_ns, b.begin_ns));
  if (duration_ns <= 0.0 || overlap_ns <= kMost * duration_ns) return;
  remarks_->Add(
      {.kind = RemarkKind::kSpansOverlap,
       .place = b.name,
       .detail = ShortText(1e-6 * overlap_ns) + " of " + ShortText(1e-6 * duration_ns) + " ms"},
      after->first + 1U);
}

}  // namespace railcast
