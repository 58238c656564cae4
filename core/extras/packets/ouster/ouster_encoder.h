#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/packets/ouster/ouster_packet.h"
#include "core/io/datagrams.h"
#include "railcast/frame.h"
#include "railcast/io/endpoint.h"
#include "railcast/scenario.h"
#include "railcast/transform.h"

namespace railcast {

/// The motion of a sensor during a frame, as an ideal inertial sensor within it measures it.
///
/// It follows from the poses of the frame: a parabola through the three poses about a time gives
/// the acceleration, and the turn between two of them the rotation. Beyond the last firing, motion
/// goes on as at the end.
class PoseMotion {
 public:
  PoseMotion(const Frame& frame, const Transform& sensor_from_imu);

  /// What is measured at a simulation time; its times are not set.
  [[nodiscard]] OusterImu At(std::int64_t time_ns) const;

 private:
  struct Knot {
    std::int64_t time_ns{};
    Transform world_from_imu = Transform::Identity();
  };
  std::vector<Knot> knots_;
};

/// Makes an encoder that turns a sensor's frames into the packets of the Ouster sensor whose
/// metadata the scenario names, with a packet of motion (DatagramPort::kPosition) every 10 ms.
///
/// A packet holds columns of one turn; those outside of the window are marked as not measured. The
/// number of a frame is that of its turn. Times count from 1970. Ranges beyond what the profile can
/// state are no return. Signals are the received power in multiples of the detection threshold,
/// where a real sensor counts photons, and the light of the background is 0.
/// Motion is that between the poses of the frame, which are at most 20 ms apart, without errors.
/// @throws InputError "--protocol ouster: /lidar/...: rule (got value)" if the sensor is not made
/// of
///   metadata, or if it has another number of returns than their profile; or as
///   ParseOusterOfPackets() does, with the name of the file.
[[nodiscard]] std::unique_ptr<FrameEncoder> MakeOusterEncoder(const LidarSpec& lidar);

/// The metadata of the stream, with all sections that drivers expect.
/// @param text The sensor's own metadata; what they leave to later firmware is filled in.
/// @param receiver Where the lidar packets go; packets of motion go to the same host.
/// @param timestamp_mode Where the sensor has its time from; absent: as the text says.
/// @pre ParseOusterOfPackets(text) succeeds.
[[nodiscard]] Json MetadataOfStream(const std::string& text,
                                    const Endpoint& receiver,
                                    const std::optional<std::string>& timestamp_mode = {});

}  // namespace railcast
