#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/io/recording/live_frame.h"
#include "core/io/stream/frame_assembler.h"
#include "core/io/stream/stream_clouds.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/input_datagrams.h"

namespace railcast {
namespace {

std::uint64_t Sum(const std::vector<IndexRange>& ranges) {
  std::uint64_t sum = 0;
  std::uint64_t end = 0;
  for (const IndexRange& range : ranges) {
    Check(range.first >= end && range.count > 0, "ranges rise and are not empty");
    end = std::uint64_t{range.first} + range.count;
    sum += range.count;
  }
  return sum;
}

void CheckLiveFrame(const ReceivedFrame& received) {
  try {
    const RecordedFrame live = MakeLiveFrame(received, "fuzz");
    const Frame& frame = live.frame;
    Check(live.is_grid || frame.rows == 1, "what is no grid has one row");
    Check(!live.is_grid || frame.num_slots() >= received.num_points(), "every point has a slot");
    ForEachField(frame, [&](std::string_view, std::string_view, const auto& values) {
      Check(values.size() == frame.num_slots(), "every slot has every field");
    });
    for (const ForeignField& field : live.foreign) {
      Check(field.values.size() == frame.num_slots(), "every slot has every foreign field");
    }
    for (const Outcome outcome : frame.outcome) {
      Check(static_cast<std::size_t>(outcome) < kOutcomeNames.size(), "an outcome is one");
    }
  } catch (const InputError& error) {
    Check(std::string_view(error.what()).starts_with("fuzz: "), "a fault names its frame");
  }
}

void CheckFrame(const ReceivedFrame& frame) {
  const StreamHeader& header = frame.header;
  Check(frame.points.size() == frame.num_points() * header.point_size, "points are whole");
  Check(frame.num_points() + Sum(frame.lost_points) == header.num_points,
        "every point is here or lost");
  Check(Sum(frame.lost_packets) < frame.num_packets, "a frame has at least a packet");
  std::size_t offset = 0;
  for (const StreamField& field : header.fields) {
    Check(field.offset == offset, "fields are without gap");
    offset += SizeOf(field.type);
  }
  Check(offset == header.point_size, "fields fill a point");
  const Cloud cloud = MakeCloud(frame);
  Check(cloud.data.size() == std::size_t{cloud.width} * cloud.point_step, "a cloud is whole");
  CheckLiveFrame(frame);
}

void Assemble(std::span<const char> bytes) {
  FrameAssembler assembler;
  std::vector<ReceivedFrame> frames;
  const std::uint64_t num_datagrams = ForEachDatagram(
      bytes, [&](const std::string& datagram) { assembler.Take(datagram, frames); });
  assembler.Flush(frames);
  std::size_t num_kept = 0;
  std::uint64_t num_lost = 0;
  for (const ReceivedFrame& frame : frames) {
    CheckFrame(frame);
    num_kept += frame.points.size();
    num_lost += Sum(frame.lost_packets);
  }
  const StreamCounts& counts = assembler.counts();
  Check(num_kept <= bytes.size(), "memory is for what arrived");
  Check(counts.received_packets + counts.stray_packets + counts.other_sender_packets +
                counts.num_refused() ==
            num_datagrams,
        "every datagram is counted once");
  Check(counts.complete_frames + counts.incomplete_frames == frames.size(), "frames are counted");
  Check(counts.lost_packets == num_lost, "losses are counted");
}

}  // namespace
}  // namespace railcast

/// datagrams as ForEachDatagram() separates them.
RAILCAST_FUZZ_TARGET(stream) {
  railcast::Assemble(std::span(reinterpret_cast<const char*>(data), size));
  return 0;
}
