#include <filesystem>
#include <memory>
#include <string>

#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/recording/bag_of_run.h"
#include "core/extras/ros/recording/bag_recording.h"
#include "core/io/recording/recording_extras.h"

namespace railcast {
namespace {

std::unique_ptr<Recording> OpenWholeBag(const std::filesystem::path& bag) {
  return bag::IsBag(bag) ? OpenBagRecording(bag, {bag}) : nullptr;
}

std::unique_ptr<Recording> OpenTopicOfBag(const std::filesystem::path& source) {
  const auto found = FindBag(source);
  return found ? OpenBagRecording(source, *found) : nullptr;
}

}  // namespace

void AddRos(RecordingExtras& extras) {
  extras.kinds.push_back(
      {.help = [] { return std::string("bag of ROS 2 (.mcap, .db3 or rosbag2's directory)"); },
       .option = "--topic",
       .extensions = {".mcap", ".db3"},
       .is_of = bag::IsBag,
       .open = OpenWholeBag,
       .open_part = OpenTopicOfBag});
  extras.clouds_of_bag = CloudsOfBag;
  extras.verify_bag = VerifyBag;
}

}  // namespace railcast
