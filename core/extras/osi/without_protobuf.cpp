#include "core/base/error.h"
#include "core/extras/osi/sensor_view.h"

// Takes the place of sensor_view.cpp in programs that are built without protobuf.

namespace railcast::osi {
namespace {

std::string FailWithoutProtobuf() {
  throw InputError(
      "needs a railcast that was built with protobuf, Debian's packages libprotobuf-dev and "
      "protobuf-compiler (got one without)");
}

}  // namespace

std::string SensorViewOf(const LidarOfView& /*lidar*/, const FrameOfView& /*view*/) {
  return FailWithoutProtobuf();
}

std::string SensorViewDescriptors() {
  return FailWithoutProtobuf();
}

std::string ProtobufVersion() {
  return FailWithoutProtobuf();
}

}  // namespace railcast::osi
