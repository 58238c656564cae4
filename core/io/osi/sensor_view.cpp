#include "core/io/osi/sensor_view.h"

#include <google/protobuf/arena.h>
#include <google/protobuf/descriptor.pb.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <unordered_set>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/osi/ground_truth.h"

namespace railcast::osi {
namespace {

constexpr double kNmPerM = 1e9;
/// As OSI says that there is no object.
constexpr std::uint64_t kNoObject = std::numeric_limits<std::uint64_t>::max();

void SetMount(const Transform& rear_from_sensor, osi3::MountingPosition& message) {
  Set(rear_from_sensor.translation(), *message.mutable_position());
  Set(rear_from_sensor.linear(), *message.mutable_orientation());
}

// OSI's fields of view lie to both sides of the x axis alike.
void SetFieldOfView(const ScanPattern& pattern, osi3::LidarSensorViewConfiguration& message) {
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const double x = pattern.direction_x[i];
    const double y = pattern.direction_y[i];
    const double z = pattern.direction_z[i];
    azimuth_rad = std::max(azimuth_rad, std::abs(std::atan2(y, x)));
    elevation_rad = std::max(elevation_rad, std::abs(std::atan2(z, std::hypot(x, y))));
  }
  message.set_field_of_view_horizontal(2.0 * azimuth_rad);
  message.set_field_of_view_vertical(2.0 * elevation_rad);
}

// Calls `visit(firing, slot)` for each ray.
template <typename Visit>
void ForEachRay(const LidarOfView& lidar, const Frame& frame, const Visit& visit) {
  for (const std::uint32_t firing : lidar.firings) {
    const std::size_t first = lidar.pattern->row[firing] * std::size_t{frame.width()} +
                              lidar.pattern->column[firing] * std::size_t{frame.returns};
    for (std::uint32_t i = 0; i < frame.returns; ++i) visit(firing, first + i);
  }
}

void SetRays(const LidarOfView& lidar,
             const Frame& frame,
             osi3::LidarSensorViewConfiguration& message) {
  const ScanPattern& pattern = *lidar.pattern;
  const auto num_rays = static_cast<int>(frame.num_slots());
  message.mutable_directions()->Reserve(num_rays);
  message.mutable_timings()->Reserve(num_rays);
  ForEachRay(lidar, frame, [&](std::uint32_t firing, std::size_t) {
    Set(Vector3(pattern.direction_x[firing], pattern.direction_y[firing],
                pattern.direction_z[firing]),
        *message.add_directions());
    message.add_timings(static_cast<std::uint32_t>(pattern.time_ns[firing] / kNsPerUs));
  });
}

void SetConfiguration(const LidarOfView& lidar,
                      const Frame& frame,
                      osi3::LidarSensorViewConfiguration& message) {
  message.mutable_sensor_id()->set_value(lidar.detector_id);
  SetMount(lidar.rear_from_sensor, *message.mutable_mounting_position());
  SetFieldOfView(*lidar.pattern, message);
  message.set_number_of_rays_horizontal(frame.width());
  message.set_number_of_rays_vertical(frame.rows);
  message.set_max_number_of_interactions(lidar.max_interactions);
  message.set_emitter_frequency(kSpeedOfLight_mps * kNmPerM / lidar.wavelength_nm);
  message.set_num_of_pixels(static_cast<std::uint32_t>(frame.num_slots()));
  SetRays(lidar, frame, message);
}

void SetReflection(const LidarOfView& lidar,
                   const Frame& frame,
                   std::size_t slot,
                   osi3::LidarSensorView::Reflection& message) {
  constexpr double kDbPerDecade = 10.0;
  message.set_time_of_flight(2.0 * static_cast<double>(frame.range_m[slot]) / kSpeedOfLight_mps);
  if (frame.has_velocity && !std::isnan(frame.radial_velocity_mps[slot])) {
    message.set_doppler_shift(-2.0 * static_cast<double>(frame.radial_velocity_mps[slot]) *
                              kNmPerM / lidar.wavelength_nm);
  }
  // Also false where no power is computed.
  if (frame.power_ratio[slot] > 0.0F) {
    message.set_signal_strength(
        kDbPerDecade *
        std::log10(static_cast<double>(frame.power_ratio[slot]) * lidar.power_at_threshold_ratio));
  }
}

void SetReflections(const LidarOfView& lidar,
                    const FrameOfView& view,
                    osi3::LidarSensorView& message) {
  std::unordered_set<std::uint64_t> known;
  for (const ObjectOfView& object : view.objects) known.insert(object.id);
  const Frame& frame = view.frame;
  message.mutable_reflection()->Reserve(static_cast<int>(frame.num_slots()));
  ForEachRay(lidar, frame, [&](std::uint32_t, std::size_t slot) {
    osi3::LidarSensorView::Reflection& reflection = *message.add_reflection();
    if (!HasPoint(frame.outcome[slot])) return;
    SetReflection(lidar, frame, slot, reflection);
    // The mirror image of an object is no reflection of it.
    const bool is_of_object = frame.outcome[slot] == Outcome::kReturned &&
                              frame.instance[slot] != 0 && known.contains(frame.instance[slot]);
    reflection.mutable_object_id()->set_value(is_of_object ? frame.instance[slot] : kNoObject);
  });
}

}  // namespace

std::string SensorViewOf(const LidarOfView& lidar, const FrameOfView& view) {
  Check(lidar.firings.size() * view.frame.returns == view.frame.num_slots(),
        "the frame is one of the lidar's");
  google::protobuf::Arena arena;
  auto& message = *google::protobuf::Arena::CreateMessage<osi3::SensorView>(&arena);
  SetVersion(*message.mutable_version());
  SetTime(view.frame.stamp_ns, *message.mutable_timestamp());
  message.mutable_sensor_id()->set_value(lidar.sensor_id);
  SetMount(lidar.rear_from_sensor, *message.mutable_mounting_position());
  SetGroundTruth(view, *message.mutable_global_ground_truth());
  message.mutable_host_vehicle_id()->set_value(view.objects.front().id);
  osi3::LidarSensorView& lidar_view = *message.add_lidar_sensor_view();
  SetConfiguration(lidar, view.frame, *lidar_view.mutable_view_configuration());
  SetReflections(lidar, view, lidar_view);
  const std::size_t size = message.ByteSizeLong();
  if (size > std::size_t{std::numeric_limits<std::int32_t>::max()}) {
    throw InputError("must be < 2^31 bytes as a message of OSI" + Got(size));
  }
  // The message has no maps, whose order alone may differ.
  return message.SerializeAsString();
}

std::string SensorViewDescriptors() {
  google::protobuf::FileDescriptorSet descriptors;
  osi3::SensorView::descriptor()->file()->CopyTo(descriptors.add_file());
  return descriptors.SerializeAsString();
}

std::string ProtobufVersion() {
  constexpr int kStep = 1000;
  return std::to_string(GOOGLE_PROTOBUF_VERSION / kStep / kStep) + "." +
         std::to_string(GOOGLE_PROTOBUF_VERSION / kStep % kStep) + "." +
         std::to_string(GOOGLE_PROTOBUF_VERSION % kStep);
}

}  // namespace railcast::osi
