#include "core/io/stream/frame_assembler.h"

#include <algorithm>
#include <numeric>

#include "railcast/io/stream.h"

namespace railcast {
namespace {

constexpr std::size_t kMaxOpenFrames = 2;
constexpr std::size_t kMaxGivenFrames = 8;
constexpr std::uint32_t kMaxStrays = 16;

}  // namespace

const StreamField* StreamHeader::Find(std::string_view name) const {
  const auto found = std::ranges::find(fields, name, &StreamField::name);
  return found == fields.end() ? nullptr : &*found;
}

std::uint32_t ReceivedFrame::num_lost_packets() const {
  std::uint32_t count = 0;
  for (const IndexRange& range : lost_packets) count += range.count;
  return count;
}

std::uint64_t StreamCounts::num_refused() const {
  return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
}

void FrameAssembler::Take(std::span<const char> bytes,
                          std::vector<ReceivedFrame>& frames,
                          const DatagramOrigin& origin) {
  StreamFault fault{};
  const auto datagram = CheckStreamDatagram(bytes, fault);
  if (sender_.IsAnother(origin)) {
    ++counts_.other_sender_packets;
    counts_.other_sender = origin.from;
    if (datagram && IsOtherSensor(*datagram)) counts_.other_sensor = datagram->head.sensor;
    return;
  }
  if (!datagram) {
    ++counts_.refused[static_cast<std::size_t>(fault)];
    return;
  }
  if (wanted_.sensor && datagram->head.sensor != *wanted_.sensor) {
    counts_.other_sensor = datagram->head.sensor;
    ++counts_.stray_packets;
    return;
  }
  const bool is_next_sender = sender_.Follow(origin);
  Place place = is_next_sender ? Place::kElsewhere : PlaceOf(*datagram);
  if (place == Place::kElsewhere) {
    const bool is_other_sensor = IsOtherSensor(*datagram);
    if (!is_next_sender && !BeginsAnew(*datagram)) {
      if (is_other_sensor) counts_.other_sensor = datagram->head.sensor;
      ++counts_.stray_packets;
      return;
    }
    Flush(frames);
    if (is_other_sensor) counts_.other_sensor = sensor_;
    if (has_run_) ++counts_.restarts;
    has_run_ = true;
    run_ = datagram->head.run;
    sensor_ = datagram->head.sensor;
    given_.clear();
    furthest_ = {};
    place = Place::kHere;
  }
  num_strays_ = 0;
  if (place == Place::kPast) {
    CountPast(*datagram);
  } else {
    Store(*datagram, origin.utc_ns, frames);
  }
}

void FrameAssembler::Flush(std::vector<ReceivedFrame>& frames) {
  while (!open_.empty()) GiveFirst(frames);
}

bool FrameAssembler::IsOtherSensor(const StreamDatagram& datagram) const {
  if (wanted_.sensor) return datagram.head.sensor != *wanted_.sensor;
  return has_run_ && datagram.head.sensor != sensor_;
}

bool FrameAssembler::BeginsAnew(const StreamDatagram& datagram) {
  const bool is_later_run = IsLaterRun(datagram.head.run, run_);
  return !has_run_ || (datagram.head.sensor == sensor_ && is_later_run) ||
         ++num_strays_ == kMaxStrays;
}

FrameAssembler::Place FrameAssembler::PlaceOf(const StreamDatagram& datagram) const {
  if (!has_run_ || datagram.head.run != run_ || datagram.head.sensor != sensor_)
    return Place::kElsewhere;
  if (given_.empty() || datagram.head.frame > given_.back().number) return Place::kHere;
  const std::uint32_t behind = given_.back().number - datagram.head.frame;
  return behind > kMaxGivenFrames ? Place::kElsewhere : Place::kPast;
}

void FrameAssembler::CountPast(const StreamDatagram& datagram) {
  ++counts_.received_packets;
  const auto given = std::ranges::find(given_, datagram.head.frame, &GivenFrame::number);
  const bool is_copy = given != given_.end() && datagram.head.packet < given->had_packet.size() &&
                       given->had_packet[datagram.head.packet];
  ++(is_copy ? counts_.duplicate_packets : counts_.late_packets);
}

void FrameAssembler::Store(const StreamDatagram& datagram,
                           std::int64_t utc_ns,
                           std::vector<ReceivedFrame>& frames) {
  const auto [at, is_new] = open_.try_emplace(datagram.head.frame);
  OpenFrame& open = at->second;
  if (is_new) {
    open.header.assign(datagram.header.begin(), datagram.header.end());
    open.points_each = datagram.points_each;
    open.has_packet.resize(datagram.head.num_packets);
    open.first_utc_ns = utc_ns;
  } else if (!DescribeOneFrame(open.header, datagram.header) ||
             open.points_each != datagram.points_each) {
    ++counts_.refused[static_cast<std::size_t>(StreamFault::kDisagrees)];
    return;
  }
  ++counts_.received_packets;
  if (open.has_packet[datagram.head.packet]) {
    ++counts_.duplicate_packets;
    return;
  }
  const std::pair place(datagram.head.frame, datagram.head.packet);
  if (place < furthest_) ++counts_.reordered_packets;
  furthest_ = std::max(furthest_, place);
  open.has_packet[datagram.head.packet] = true;
  open.last_utc_ns = utc_ns;
  open.arrivals.push_back({datagram.head.packet, open.points.size(), datagram.points.size()});
  open.points.insert(open.points.end(), datagram.points.begin(), datagram.points.end());
  if (open.arrivals.size() == open.has_packet.size()) {
    while (!open_.empty() && open_.begin()->first <= datagram.head.frame) GiveFirst(frames);
  }
  while (open_.size() > kMaxOpenFrames) GiveFirst(frames);
}

void FrameAssembler::GiveFirst(std::vector<ReceivedFrame>& frames) {
  const auto first = open_.begin();
  if (!given_.empty()) counts_.missing_frames += first->first - given_.back().number - 1;
  const ReceivedFrame& frame = frames.emplace_back(Assemble(first->second));
  ++(frame.is_complete() ? counts_.complete_frames : counts_.incomplete_frames);
  counts_.lost_packets += frame.num_lost_packets();
  given_.push_back({first->first, std::move(first->second.has_packet)});
  if (given_.size() > kMaxGivenFrames) given_.pop_front();
  open_.erase(first);
}

ReceivedFrame FrameAssembler::Assemble(OpenFrame& open) {
  ReceivedFrame frame;
  frame.header = ReadStreamHeader(open.header);
  frame.num_packets = static_cast<std::uint32_t>(open.has_packet.size());
  frame.first_arrival_ns = open.first_utc_ns;
  frame.last_arrival_ns = open.last_utc_ns;
  frame.points = JoinArrivals(open.arrivals, open.points);
  std::uint32_t next = 0;
  const auto lose = [&](std::uint32_t end) {
    if (next == end) return;
    frame.lost_packets.push_back({next, end - next});
    const std::uint32_t first_point = next * open.points_each;
    const std::uint32_t end_point = std::min(end * open.points_each, frame.header.num_points);
    frame.lost_points.push_back({first_point, end_point - first_point});
  };
  for (const Arrival& arrival : open.arrivals) {
    lose(arrival.packet);
    next = arrival.packet + 1;
  }
  lose(frame.num_packets);
  return frame;
}

}  // namespace railcast
