#include "core/io/stream/stream_encoder.h"

#include <gtest/gtest.h>

#include "core/io/recording/live_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/stream/stream_example.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/frame_bytes.h"
#include "tests/support/made_datagrams.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

Datagrams EncodeOne(const Frame& frame, const StreamSpec& spec = {}) {
  StreamEncoder encoder(StreamPattern(frame.rows, frame.columns), spec);
  Datagrams datagrams;
  encoder.Encode(frame, datagrams);
  return datagrams;
}

TEST(StreamEncoder, SendsTheReturnedPointsInTheOrderOfTheirFirings) {
  const Frame frame = StreamFrame(3);
  const ReceivedFrame received = ReceiveWhole(frame);
  const ScanPattern pattern = StreamPattern();
  const StreamHeader& header = received.header;
  std::size_t next = 0;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const std::size_t slot = std::size_t{pattern.row[i]} * pattern.columns + pattern.column[i];
    if (!HasPoint(frame.outcome[slot])) continue;
    ASSERT_LT(next, received.num_points());
    EXPECT_EQ(received.At<float>(*header.Find("x"), next), frame.x[slot]);
    EXPECT_EQ(received.At<float>(*header.Find("y"), next), frame.y[slot]);
    EXPECT_EQ(received.At<float>(*header.Find("z"), next), frame.z[slot]);
    EXPECT_EQ(received.At<float>(*header.Find("intensity"), next), frame.intensity[slot]);
    EXPECT_EQ(received.At<std::uint16_t>(*header.Find("ring"), next), frame.ring[slot]);
    EXPECT_EQ(received.At<std::uint32_t>(*header.Find("time_ns"), next), pattern.time_ns[i]);
    EXPECT_EQ(received.At<std::uint32_t>(*header.Find("label"), next), frame.label[slot]);
    EXPECT_EQ(received.At<std::uint32_t>(*header.Find("instance"), next), frame.instance[slot]);
    ++next;
  }
  EXPECT_EQ(next, received.num_points());
  EXPECT_EQ(header.fields.size(), 8U);
  EXPECT_EQ(header.point_size, 30);
}

TEST(StreamEncoder, SendsTheDirectionsOfItsFrameForASensorThatDoesNotRepeat) {
  const RisleySpec risley{
      .channels = {ChannelSpec{}},
      .cycle_us = 100.0,
      .columns = 1000,
      .prisms = {{.wedge_deg = 18.0, .refractive_index = 1.51, .turns_hz = -77.7},
                 {.wedge_deg = 18.0, .refractive_index = 1.51, .turns_hz = 121.6}}};
  const ScanPattern pattern = BuildScanPattern({.rate_hz = 10.0, .pattern = risley});
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {{MakeSphere(20.0, 24, 48), 2, 1}};
  StreamEncoder encoder(pattern, {});
  for (const std::uint32_t index : {0U, 7U}) {
    FrameAssembler assembler;
    Datagrams datagrams;
    encoder.Encode(ScanOnce(world, pattern, {}, index), datagrams);
    const std::vector<ReceivedFrame> received = Feed(assembler, PayloadTexts(datagrams));
    ASSERT_EQ(received.size(), 1U);
    ASSERT_EQ(received[0].num_points(), 1000U);
    const StreamHeader& header = received[0].header;
    const ScanPattern of_frame = PatternOfFrame(pattern, index);
    for (std::size_t i = 0; i < 1000; ++i) {
      const Vector3 point(static_cast<double>(received[0].At<float>(*header.Find("x"), i)),
                          static_cast<double>(received[0].At<float>(*header.Find("y"), i)),
                          static_cast<double>(received[0].At<float>(*header.Find("z"), i)));
      ASSERT_LT((point.normalized() - DirectionOf(of_frame, i)).norm(), 1e-6);
    }
  }
}

TEST(StreamEncoder, TakesTheOrderOfFiringsFromTheirTimesWhereThePatternIsNotKnown) {
  StreamEncoder encoder{StreamSpec{}};
  for (const std::uint32_t columns : {kStreamColumns, 7U}) {
    const Frame frame = StreamFrame(3, kStreamRows, columns);
    Datagrams datagrams;
    encoder.Encode(frame, datagrams);
    const Datagrams expected = EncodeOne(frame);
    EXPECT_TRUE(datagrams.bytes == expected.bytes);
    ASSERT_EQ(datagrams.items.size(), expected.items.size());
    EXPECT_EQ(datagrams.items.back().due_ns, expected.items.back().due_ns);
  }
}

TEST(StreamEncoder, SaysWhatTheFrameIs) {
  StreamSpec spec;
  spec.sensor = 513;
  spec.run = 70'000;
  Frame frame = StreamFrame(66'000);
  frame.world_from_sensor_end.translation() += Vector3(4.0, 0.5, -0.25);
  const StreamHeader header = ReceiveWhole(frame, spec).header;
  EXPECT_EQ(header.sensor, 513);
  EXPECT_EQ(header.run, 70'000U);
  EXPECT_EQ(header.frame, 66'000U);
  EXPECT_EQ(header.stamp_ns, frame.stamp_ns);
  EXPECT_EQ(header.duration_ns, frame.duration_ns);
  EXPECT_EQ(header.rows, kStreamRows);
  EXPECT_EQ(header.columns, kStreamColumns);
  EXPECT_EQ(header.returns, 1);
  EXPECT_FALSE(header.has_all_slots);
  // Converting a matrix to a quaternion and back rounds numbers of up to 1 several times; positions
  // stay exact.
  EXPECT_TRUE(header.world_from_sensor.linear().isApprox(frame.world_from_sensor.linear(), 1e-15));
  EXPECT_EQ(header.world_from_sensor.translation(), frame.world_from_sensor.translation());
  EXPECT_EQ(header.world_from_sensor_end.translation(), frame.world_from_sensor_end.translation());
}

TEST(StreamEncoder, SaysWhoseAxesItsPointsAreIn) {
  const auto header_of = [](OutputFrame frame, Handedness handedness) {
    StreamSpec spec;
    spec.output.frame = frame;
    spec.output.handedness = handedness;
    return ReceiveWhole(StreamFrame(1), spec).header;
  };
  EXPECT_EQ(header_of(OutputFrame::kSensor, Handedness::kRight).axes, StreamAxes::kSensor);
  EXPECT_EQ(header_of(OutputFrame::kVehicle, Handedness::kRight).axes, StreamAxes::kVehicle);
  EXPECT_EQ(header_of(OutputFrame::kWorld, Handedness::kLeft).axes, StreamAxes::kWorld);
  EXPECT_TRUE(header_of(OutputFrame::kWorld, Handedness::kLeft).is_left_handed);
  EXPECT_FALSE(header_of(OutputFrame::kWorld, Handedness::kRight).is_left_handed);
}

TEST(StreamEncoder, FillsDatagramsOfOneSizeUpTo1400Bytes) {
  const Datagrams datagrams = EncodeOne(StreamFrame(0));
  ASSERT_GT(datagrams.items.size(), 3U);
  const std::size_t size = datagrams.items.front().size;
  EXPECT_LE(size, 1400U);
  EXPECT_GT(size + 30, 1400U) << "another point would fit";
  std::size_t offset = 0;
  for (const Datagrams::Item& item : datagrams.items) {
    const bool is_last = &item == &datagrams.items.back();
    EXPECT_TRUE(is_last ? item.size <= size : item.size == size);
    EXPECT_EQ(item.offset, offset);
    EXPECT_EQ(item.port, DatagramPort::kData);
    offset += item.size;
  }
  EXPECT_EQ(offset, datagrams.bytes.size());
}

TEST(StreamEncoder, LetsADatagramLeaveWhenItsLastPointHasBeenFired) {
  const Frame frame = StreamFrame(2);
  const Datagrams datagrams = EncodeOne(frame);
  const ReceivedFrame received = ReceiveWhole(frame);
  const StreamField& time = *received.header.Find("time_ns");
  std::size_t end = 0;
  for (const Datagrams::Item& item : datagrams.items) {
    std::uint16_t num_points = 0;
    std::memcpy(&num_points, datagrams.BytesOf(item).data() + 14, sizeof num_points);
    end += num_points;
    EXPECT_EQ(item.due_ns, frame.stamp_ns + received.At<std::uint32_t>(time, end - 1));
  }
  EXPECT_EQ(end, received.num_points());
}

TEST(StreamEncoder, SendsOneDatagramForAFrameWithoutAPoint) {
  Frame frame = StreamFrame(5);
  for (Outcome& outcome : frame.outcome) outcome = Outcome::kNoSurface;
  const Datagrams datagrams = EncodeOne(frame);
  ASSERT_EQ(datagrams.items.size(), 1U);
  EXPECT_EQ(datagrams.items.front().due_ns, frame.stamp_ns + frame.duration_ns);
  const ReceivedFrame received = ReceiveWhole(frame);
  EXPECT_TRUE(received.is_complete());
  EXPECT_EQ(received.num_points(), 0U);
}

TEST(StreamEncoder, SendsEveryFieldOfEverySlotWhereAsked) {
  Frame frame = StreamFrame(4);
  StreamSpec spec;
  spec.fields = FieldSelection();
  spec.has_all_slots = true;
  const ReceivedFrame received = ReceiveWhole(frame, spec);
  EXPECT_TRUE(received.header.has_all_slots);
  EXPECT_EQ(received.num_points(), frame.num_slots());
  const Frame again = MakeLiveFrame(received, "stream").frame;
  EXPECT_EQ(again.index, frame.index);
  EXPECT_EQ(again.stamp_ns, frame.stamp_ns);
  EXPECT_EQ(again.duration_ns, frame.duration_ns);
  EXPECT_EQ(FrameBytes(again), FrameBytes(frame));
}

TEST(StreamEncoder, SendsTheEchoesOfAFiringOneAfterTheOther) {
  constexpr std::uint32_t kRows = 4;
  constexpr std::uint32_t kColumns = 30;
  Frame frame;
  frame.Resize(kRows, kColumns, 2);
  for (std::uint32_t slot = 0; slot < frame.num_slots(); ++slot) {
    const std::uint32_t cell = slot / 2;
    frame.return_index[slot] = static_cast<std::uint8_t>(slot % 2);
    frame.range_m[slot] = static_cast<float>(slot);
    frame.time_ns[slot] = kFiringSpacing_ns * (cell % kColumns * kRows + cell / kColumns);
    const bool is_second = slot % 2 == 1;
    frame.outcome[slot] = is_second && cell % 3 != 0 ? Outcome::kNoFurtherEcho : Outcome::kReturned;
  }
  StreamSpec spec;
  spec.fields = FieldSelection("range_m,return_index");
  const ReceivedFrame received = ReceiveWhole(frame, spec);
  const ScanPattern pattern = StreamPattern(kRows, kColumns);
  std::size_t next = 0;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const std::uint32_t cell = pattern.row[i] * kColumns + pattern.column[i];
    for (std::uint32_t echo = 0; echo < (cell % 3 == 0 ? 2U : 1U); ++echo, ++next) {
      ASSERT_LT(next, received.num_points());
      EXPECT_EQ(received.At<float>(received.header.fields[0], next),
                static_cast<float>(2 * cell + echo));
      EXPECT_EQ(received.At<std::uint8_t>(received.header.fields[1], next), echo);
    }
  }
  EXPECT_EQ(next, received.num_points());
}

TEST(StreamEncoder, AppendsToWhatHasNotBeenSent) {
  StreamEncoder encoder(StreamPattern(), {});
  Datagrams both;
  encoder.Encode(StreamFrame(0), both);
  encoder.Encode(StreamFrame(1), both);
  std::vector<std::string> apart = DatagramsOf(StreamFrame(0));
  for (const std::string& datagram : DatagramsOf(StreamFrame(1))) apart.push_back(datagram);
  EXPECT_EQ(PayloadTexts(both), apart);
}

TEST(StreamEncoder, RefusesFramesThatCannotBeCounted) {
  // With all 19 fields, a datagram has a header of 358 bytes, 16 points of 63 bytes, and the CRC;
  // 16 x 65535 are 1048560 points.
  Frame frame;
  constexpr std::uint32_t kRows = 1100;
  constexpr std::uint32_t kColumns = 1100;
  frame.Resize(kRows, kColumns, 1);
  StreamSpec spec;
  spec.fields = FieldSelection();
  EXPECT_EQ(MessageOf([&] { static_cast<void>(EncodeOne(frame, spec)); }),
            "stream: a frame must fit into 65535 datagrams (got 1210000 slots of 63 bytes); send "
            "fewer fields");
}

}  // namespace
}  // namespace railcast
