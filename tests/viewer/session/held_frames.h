#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "tests/viewer/pick/shown_cloud.h"
#include "viewer/frames/frames.h"

namespace railcast {

/// Frames held in memory. A null one stands for a frame that cannot be read.
class HeldFrames final : public Frames {
 public:
  explicit HeldFrames(std::vector<std::shared_ptr<const ShownFrame>> frames,
                      const std::string& source = "held")
      : frames_(std::move(frames)) {
    info_.source = source;
  }

  [[nodiscard]] std::shared_ptr<const ShownFrame> Get(std::size_t place) override {
    if (place >= frames_.size()) return nullptr;
    if (!frames_[place]) throw InputError("held: is damaged");
    return frames_[place];
  }
  [[nodiscard]] std::size_t num_known() const override { return frames_.size(); }

  void UseKind(const std::string& kind) { info_.kind = kind; }
  void UseLabels(const LabelTable& labels) { info_.labels = labels; }

 private:
  std::vector<std::shared_ptr<const ShownFrame>> frames_;
};

/// A frame of `num_points` points; `index` is its number and the x of every point.
inline RecordedFrame NumberedCloud(std::uint32_t index, std::size_t num_points = 2) {
  std::vector<Vector3> points_m(num_points, Vector3(index, 0, 1));
  if (num_points > 1) points_m[1].z() = 2.0 + index;
  RecordedFrame recorded = RecordedCloud(std::to_string(index).append(".pcd"), points_m);
  recorded.frame.index = index;
  recorded.frame.stamp_ns = 200'000'000LL * index;
  return recorded;
}

inline std::shared_ptr<const ShownFrame> Share(RecordedFrame recorded) {
  return std::make_shared<const ShownFrame>(Show(std::move(recorded)));
}

/// As NumberedCloud(), with label 12 for the first point and 1 for the other.
inline RecordedFrame LabelledCloud(std::uint32_t index) {
  RecordedFrame recorded = NumberedCloud(index);
  recorded.fields.emplace("label");
  recorded.frame.label = {12, 1};
  return recorded;
}

/// As NumberedCloud(), from a sensor that moves on by 2 m per frame.
inline RecordedFrame MovingCloud(std::uint32_t index) {
  RecordedFrame recorded = NumberedCloud(index);
  recorded.has_pose = true;
  recorded.frame.world_from_sensor =
      MakeTransform(Eigen::Matrix3d::Identity(), Vector3(2.0 * index, 0, 0));
  return recorded;
}

}  // namespace railcast
