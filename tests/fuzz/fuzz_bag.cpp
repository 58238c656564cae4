#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string_view>

#include "core/base/error.h"
#include "core/extras/osi/trace_file.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "core/extras/ros/recording/cloud_message.h"
#include "core/extras/ros/recording/packet_messages.h"
#include "core/io/recording/cloud_frame.h"
#include "railcast/io/recording.h"
#include "tests/fuzz/fault_lines.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/input_files.h"

namespace railcast {
namespace {

void ReadMessages(const std::filesystem::path& path) {
  const auto bag = bag::OpenBag(path);
  std::int64_t time_ns = std::numeric_limits<std::int64_t>::min();
  while (const auto message = bag->Next()) {
    Check(message->topic < bag->topics().size(), "a message has a topic");
    Check(message->time_ns >= time_ns, "messages come in order of time");
    time_ns = message->time_ns;
  }
  static_cast<void>(bag->ReadAttachments());
}

void ReadFrames(const std::filesystem::path& path) {
  const auto recording = OpenRecording(path);
  while (const auto read = recording->Next()) {
    const RecordedFrame recorded = (*read)();
    Check(recorded.frame.world_from_sensor.matrix().allFinite(), "a pose is finite");
    Check(recorded.frame.x.size() == recorded.frame.num_slots(), "every slot has a position");
  }
}

void ReadCloud(std::span<const std::byte> bytes) {
  const Cloud cloud = MakeCloud(ros::FromCdr<ros::PointCloud2>(bytes));
  for (const CloudField& field : cloud.fields) {
    std::size_t num = 0;
    VisitField(cloud, field, [&](std::size_t, auto) { ++num; });
    Check(num == cloud.num_points(), "every point has every field");
  }
  static_cast<void>(MakeCloudFrame(cloud, "fuzz"));
}

void ReadOsiTrace(const std::filesystem::path& path) {
  osi::TraceReader trace(path);
  while (trace.NextHash()) {
  }
  if (!trace.fault().empty()) return CheckFaultLines(trace.fault());
  osi::SingleChannelReader reader(path);
  std::uint64_t end = 0;
  while (reader.Next()) {
    Check(reader.position() >= end + sizeof(std::uint32_t), "messages stand behind each other");
    end = reader.position();
  }
  Check(end == std::filesystem::file_size(path), "all of it is read");
}

void ReadInput(char kind, std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  switch (kind) {
    case 'm':
      return ReadMessages(InputFiles::Write("input.mcap", text));
    case 'd':
      return ReadMessages(InputFiles::Write("input.db3", text));
    case 'M':
      return ReadFrames(InputFiles::Write("input.mcap", text));
    case 'D':
      return ReadFrames(InputFiles::Write("input.db3", text));
    case 'o':
      return ReadOsiTrace(InputFiles::Write("input.osi", text));
    case 'c':
      return ReadCloud(bytes);
    case 'p':
      return static_cast<void>(ros::FromCdr<ros::PandarScan>(bytes));
    case 'n':
      return static_cast<void>(ros::FromCdr<ros::NebulaPackets>(bytes));
    default:
      return;
  }
}

}  // namespace
}  // namespace railcast

/// Entry point for libFuzzer. The first byte selects what the rest is: m or d, an MCAP file or a
/// database of rosbag2, of which M and D read the frames; o, an OSI trace; or a message:
/// c PointCloud2, p PandarScan, n NebulaPackets.
RAILCAST_FUZZ_TARGET(bag) {
  if (size == 0) return 0;
  const railcast::InputFiles nothing_of_the_last("");
  try {
    railcast::ReadInput(static_cast<char>(data[0]),
                        {reinterpret_cast<const char*>(data) + 1, size - 1});
  } catch (const railcast::InputError& error) {
    railcast::CheckFaultLines(error.what());
  }
  return 0;
}
