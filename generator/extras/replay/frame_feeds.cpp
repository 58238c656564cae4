#include "generator/extras/replay/frame_feeds.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/frame_topics.h"
#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/scene_topics.h"
#include "core/io/recording/firing_truth.h"
#include "core/io/stream/stream_encoder.h"
#include "core/scenario/sensors.h"
#include "core/simulate/returns.h"
#include "generator/live/live_extras.h"

namespace railcast {
namespace {

/// Says of each slot whether it has a point, where the recording says no more.
void FillOutcomes(RecordedFrame& recorded) {
  if (HasAllOutcomes(recorded)) return;
  Frame& frame = recorded.frame;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (std::isnan(frame.x[i])) {
      frame.outcome[i] = Outcome::kNoSurface;
    } else if (!recorded.Has("outcome")) {
      frame.outcome[i] = Outcome::kReturned;
    }
  }
}

std::string NamesThere(const RecordedFrame& frame, const FieldSelection& selection) {
  std::string names;
  for (const std::string& name : selection.names()) {
    if (frame.Has(name)) names += (names.empty() ? "" : ",") + name;
  }
  return names;
}

std::string ProtocolPlace(Protocol protocol) {
  return "--protocol " + std::string(NameOf(protocol)) + ": ";
}

/// Checks that a frame of a sequence has what packets say of every firing.
void CheckHasFirings(const RecordedFrame& recorded, const LidarSpec& lidar, Protocol protocol) {
  const auto fail = [&](const std::string& rule) {
    throw InputError(ProtocolPlace(protocol) + "needs every firing of a frame with " + rule);
  };
  for (const char* field :
       {"range_m", "intensity", "power_ratio", "time_ns", "outcome", "true_range_m"}) {
    const bool is_part = field == std::string_view("outcome") && !HasAllOutcomes(recorded);
    if (recorded.is_grid && recorded.Has(field) && !is_part) continue;
    fail(
        "range_m, intensity, power_ratio, time_ns, outcome and true_range_m, as `sequence "
        "--format pcd --fields all` writes them (got none of " +
        std::string(field) + ")");
  }
  const std::uint32_t num_returns = NumReturns(lidar.receiver.return_mode);
  const std::uint32_t got = recorded.frame.returns;
  if (got != 1 && got != num_returns) {
    fail("the " + NumberText(num_returns) + " returns of its scenario" + Got(got));
  }
}

/// Makes the encoder of a sensor's packets for a sequence that has what these say.
std::unique_ptr<FrameEncoder> PacketEncoderFor(const FrameSource& source, Protocol protocol) {
  const RecordingInfo& info = source.info();
  if (!info.scenario) {
    throw InputError(ProtocolPlace(protocol) +
                     "is for sequences of railcast, whose scenarios say how the sensor fires; must "
                     "be railcast or ros2 here (got " +
                     info.kind + ")");
  }
  CheckHasFirings(source.first(), info.scenario->lidar, protocol);
  return LiveExtras::Get().packets.value().make_encoder(protocol, info.scenario->lidar);
}

std::unique_ptr<FrameEncoder> EncoderFor(const FrameSource& source,
                                         Protocol protocol,
                                         const std::optional<FieldSelection>& fields,
                                         std::uint32_t run) {
  if (protocol != Protocol::kRailcast) return PacketEncoderFor(source, protocol);
  return std::make_unique<StreamEncoder>(
      StreamSpec{.fields = FieldsOf(source.first(), fields), .run = run});
}

}  // namespace

FrameSource::FrameSource(std::unique_ptr<Recording> recording, const FrameReplaySpec& spec)
    : recording_(std::move(recording)), spec_(spec), times_(spec.pace) {
  for (std::uint64_t i = 0; i < spec.frames.start && recording_->Next(); ++i) continue;
  next_ = Read();
  if (!next_) throw NoSuchFrame(ShownPath(info().source), spec.frames.start);
  if (!next_->Has("x")) {
    throw InputError(ShownPath(info().source) + ": must have points (got a sequence without)");
  }
}

std::string FrameSource::name() const {
  const auto& scenario = info().scenario;
  return scenario && !scenario->lidar.name.empty() ? scenario->lidar.name : "lidar";
}

std::optional<RecordedFrame> FrameSource::Read() {
  if (num_read_ == spec_.frames.count) return std::nullopt;
  const auto read = recording_->Next();
  if (!read) return std::nullopt;
  RecordedFrame recorded = (*read)();
  FillOutcomes(recorded);
  if (spec_.rate_hz) {
    recorded.frame.stamp_ns = std::llround(1e9 * static_cast<double>(num_read_) / *spec_.rate_hz);
  }
  ++num_read_;
  if (next_ && recorded.frame.stamp_ns == next_->frame.stamp_ns) {
    throw InputError(recorded.name +
                     ": stamp: must differ from that of the frame before, or --rate-hz must say "
                     "how many frames a second there are (got " +
                     NumberText(recorded.frame.stamp_ns) + " ns)");
  }
  return recorded;
}

bool FrameSource::Load() {
  if (fault_ && !next_) std::rethrow_exception(fault_);
  if (!next_) return false;
  std::optional<RecordedFrame> after;
  try {
    after = Read();
  } catch (const InputError&) {
    // Nothing is sent of a recording that cannot be replayed; of a damaged one, what is whole.
    if (!frame_) throw;
    fault_ = std::current_exception();
  }
  frame_ = std::exchange(next_, std::move(after));
  constexpr std::int64_t kLongest_ns = 100'000'000;
  begin_ns_ = times_.Of(frame_->frame.stamp_ns);
  const std::int64_t next_ns = next_ ? times_.Of(next_->frame.stamp_ns) : begin_ns_ + kLongest_ns;
  span_ns_ = std::min(next_ns - begin_ns_, kLongest_ns);
  return true;
}

const RecordedFrame& FrameSource::StampedFrame() {
  if (utc_begin_ns_) frame_->frame.stamp_ns = *utc_begin_ns_ + begin_ns_;
  return *frame_;
}

FieldSelection FieldsOf(const RecordedFrame& frame, const std::optional<FieldSelection>& wanted) {
  if (!wanted) return FieldSelection(NamesThere(frame, StreamSpec{}.fields));
  if (*wanted == FieldSelection()) return FieldSelection(NamesThere(frame, *wanted));
  for (const std::string& name : wanted->names()) {
    if (frame.Has(name)) continue;
    throw InputError("--fields: must be among those of the recording, " +
                     NamesThere(frame, FieldSelection()) + " (got " + name + ")");
  }
  return *wanted;
}

UdpFrameFeed::UdpFrameFeed(FrameSource source,
                           Protocol protocol,
                           const std::vector<Endpoint>& to,
                           const std::optional<FieldSelection>& fields,
                           std::uint32_t run)
    : FrameFeed(std::move(source)),
      protocol_(protocol),
      to_(to),
      first_stamp_ns_(source_.first().frame.stamp_ns),
      encoder_(EncoderFor(source_, protocol, fields, run)),
      sender_(
          AtPlace("--to: ", [&] { return UdpSender(to, PositionPort(protocol).value_or(0)); })) {}

std::string UdpFrameFeed::Description() const {
  std::string text = name() + ": " + std::string(NameOf(protocol_)) + " to";
  for (const Endpoint& to : to_) text.append(" ").append(EndpointText(to));
  return text;
}

void UdpFrameFeed::SetClock(std::int64_t begin_ns) {
  if (protocol_ == Protocol::kRailcast) {
    FrameFeed::SetClock(begin_ns);
  } else {
    // Packets count from the stamps of their frames.
    encoder_->SetClockAhead(begin_ns - kSimulationEpoch_s * kNsPerS - first_stamp_ns_);
  }
}

void UdpFrameFeed::Take(Datagrams& datagrams) {
  const RecordedFrame& recorded = source_.StampedFrame();
  if (protocol_ != Protocol::kRailcast) {
    CheckHasFirings(recorded, source_.info().scenario->lidar, protocol_);
  }
  encoder_->Encode(recorded.frame, datagrams);
  const auto num = static_cast<std::int64_t>(datagrams.items.size());
  for (std::int64_t i = 0; i < num; ++i) {
    Datagrams::Item& item = datagrams.items[static_cast<std::size_t>(i)];
    // Without times, so that the buffers of receivers have room.
    item.due_ns = recorded.Has("time_ns") ? source_.DueNs(item.due_ns - recorded.frame.stamp_ns)
                                          : source_.begin_ns() + source_.span_ns() * i / num;
  }
}

TopicFrameFeed::TopicFrameFeed(FrameSource source, ros::CloudSpec clouds)
    : FrameFeed(std::move(source)),
      clouds_(std::move(clouds)),
      num_clouds_(ros::NumClouds(clouds_.layout, source_.first().frame.returns)),
      frame_id_(ros::RosName(name())) {}

void TopicFrameFeed::Join(std::unique_ptr<dds::Participant> participant, const std::string& place) {
  const auto topic = [](std::string name, const ros::MessageType& type) {
    return dds::TopicSpec{.name = std::move(name), .type = type.dds_name, .hash = type.hash};
  };
  std::vector<dds::TopicSpec> topics = {topic("/clock", ros::TypeOf<ros::Clock>()),
                                        topic("/tf", ros::TypeOf<ros::TfMessage>())};
  for (std::uint32_t i = 0; i < num_clouds_; ++i) {
    topics.push_back(topic(ros::PointsTopic(name(), i), ros::TypeOf<ros::PointCloud2>()));
  }
  writers_ = std::make_unique<RosWriters>(std::move(participant), topics);
  writers_->participant().Announce();
  place_ = place;
}

std::string TopicFrameFeed::Description() const {
  return name() + ": ros2 in " + place_;
}

void TopicFrameFeed::Take(Datagrams& datagrams) {
  const RecordedFrame& recorded = source_.StampedFrame();
  const Frame& frame = recorded.frame;
  const std::int64_t due_ns = source_.DueNs(frame.duration_ns);
  std::size_t topic = 0;
  const ros::Time stamp = ros::TimeOf(frame.stamp_ns);
  AppendMessage(topic++, ros::ToCdr(ros::Clock{stamp}), due_ns, datagrams);
  const ros::TransformStamped pose{{stamp, "map"},
                                   frame_id_,
                                   {ros::VectorOf(frame.world_from_sensor.translation()),
                                    ros::QuaternionOf(frame.world_from_sensor)}};
  if (recorded.has_pose) {
    AppendMessage(topic, ros::ToCdr(ros::TfMessage{{pose}}), due_ns, datagrams);
  }
  ++topic;
  const std::uint32_t num_clouds = ros::NumClouds(clouds_.layout, frame.returns);
  for (std::uint32_t i = 0; i < std::min(num_clouds, num_clouds_); ++i) {
    AppendMessage(topic + i, ros::ToCdr(ros::MakeCloud(frame, clouds_, frame_id_, {}, i)), due_ns,
                  datagrams);
  }
}

}  // namespace railcast
