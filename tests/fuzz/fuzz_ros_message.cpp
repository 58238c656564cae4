#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/discovery_messages.h"
#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/scene_messages.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "core/extras/ros/recording/packet_messages.h"
#include "tests/fuzz/fuzz_target.h"

namespace railcast::ros {
namespace {

// What is accepted becomes the same bytes however often it is read and written. NaN differ from
// themselves, so that bytes are compared.
template <typename Message>
void ReadAndWrite(std::span<const std::byte> bytes) {
  try {
    const std::vector<std::byte> once = ToCdr(FromCdr<Message>(bytes));
    Check(once == ToCdr(FromCdr<Message>(once)), "a message is read as it was written");
  } catch (const InputError& error) {
    const std::string_view fault = error.what();
    Check(fault.starts_with(Message::kName), "a fault names the type");
    Check(fault.find('\n') == std::string_view::npos, "a fault is one line");
  }
}

void Decode(char kind, std::span<const std::byte> bytes) {
  if (kind == 'p') ReadAndWrite<PointCloud2>(bytes);
  if (kind == 't') ReadAndWrite<TfMessage>(bytes);
  if (kind == 'o') ReadAndWrite<Odometry>(bytes);
  if (kind == 'c') ReadAndWrite<CameraInfo>(bytes);
  if (kind == 'b') ReadAndWrite<TwistStamped>(bytes);
  if (kind == 's') ReadAndWrite<SceneUpdate>(bytes);
  if (kind == 'l') ReadAndWrite<LivoxCloud>(bytes);
  if (kind == 'd') ReadAndWrite<ParticipantEntitiesInfo<>>(bytes);
}

}  // namespace
}  // namespace railcast::ros

/// a letter for the type of message and its CDR.
RAILCAST_FUZZ_TARGET(ros_message) {
  if (size == 0) return 0;
  railcast::ros::Decode(static_cast<char>(data[0]), std::as_bytes(std::span(data + 1, size - 1)));
  return 0;
}
