#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;

inline ros::Time TimeAt(std::int64_t time_ns) {
  return {static_cast<std::int32_t>(time_ns / kSecond_ns),
          static_cast<std::uint32_t>(time_ns % kSecond_ns)};
}

/// A cloud of float32 x, y, z and ring at offsets that are not aligned, in bytes of either order.
inline ros::PointCloud2 CloudOf(const std::vector<std::array<float, 3>>& points,
                                std::int64_t stamp_ns,
                                bool is_bigendian = false) {
  constexpr std::uint32_t kStep = 17;
  ros::PointCloud2 cloud{
      .header = {TimeAt(stamp_ns), "lidar"},
      .height = 1,
      .width = static_cast<std::uint32_t>(points.size()),
      .fields = {{"x", 1, 7, 1}, {"y", 5, 7, 1}, {"z", 9, 7, 1}, {"ring", 15, 4, 1}},
      .is_bigendian = is_bigendian,
      .point_step = kStep,
      .row_step = static_cast<std::uint32_t>(kStep * points.size()),
      .data = std::vector<std::uint8_t>(kStep * points.size()),
      .is_dense = false};
  const auto put = [&](std::size_t place, auto value) {
    std::array<std::uint8_t, sizeof value> bytes{};
    std::memcpy(bytes.data(), &value, sizeof value);
    if (is_bigendian) std::ranges::reverse(bytes);
    std::ranges::copy(bytes, cloud.data.begin() + static_cast<std::ptrdiff_t>(place));
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) put(kStep * i + 1 + 4 * axis, points[i][axis]);
    put(kStep * i + 15, static_cast<std::uint16_t>(i));
  }
  return cloud;
}

inline const std::vector<std::array<float, 3>> kBagPoints = {
    {1.5F, 2.0F, 3.0F},
    {0.0F, 0.0F, 0.0F},
    {-4.0F, 5.0F, 0.25F},
    {std::numeric_limits<float>::quiet_NaN(), 1.0F, 1.0F}};

enum class BagKind { kMcap, kRosbag2 };

/// A bag that grows message by message.
class MadeBag {
 public:
  explicit MadeBag(BagKind kind = BagKind::kMcap)
      : file_(folder_.path() / (kind == BagKind::kMcap ? "run.mcap" : "run")),
        writer_(kind == BagKind::kMcap ? bag::CreateMcap(file_) : bag::CreateRosbag2(file_)) {}

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

  template <typename Message>
  void Add(const std::string& topic,
           std::int64_t time_ns,
           const Message& message,
           std::string_view type = Message::kName) {
    const std::size_t index =
        writer_->Add({.name = topic,
                      .type = std::string(type),
                      .definition = {},
                      .hash = {},
                      .is_latched = topic == "/tf_static" || topic.starts_with("/latched/")});
    writer_->Write({index, time_ns, ros::ToCdr(message)});
  }
  void Link(const std::string& topic,
            const std::string& parent,
            const std::string& child,
            std::int64_t time_ns,
            const ros::RosTransform& transform) {
    Add(topic, time_ns, ros::TfMessage{{{{TimeAt(time_ns), parent}, child, transform}}});
  }
  void Commit() { writer_->Commit(); }
  std::filesystem::path Closed() {
    writer_->Close();
    return file();
  }

 private:
  TemporaryDirectory folder_;
  std::filesystem::path file_;
  std::unique_ptr<bag::BagWriter> writer_;
};

}  // namespace railcast
