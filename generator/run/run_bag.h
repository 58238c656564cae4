#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/io/bag/bag.h"
#include "core/io/ros/frame_topics.h"
#include "generator/run/frame_maker.h"
#include "generator/run/run_directory.h"
#include "generator/run/run_plan.h"

namespace railcast {

/// The bag of a run whose format is one: the messages of all its sensors' frames, in the order in
/// which these begin. A commit of the bag is a frame, but for the first, which holds what is said
/// once. So an interrupted bag is whole up to its last frame, and a resumed one has the bytes of
/// one that was never interrupted.
class RunBag {
 public:
  /// Looks what there is of the bag; writes nothing.
  RunBag(const RunPlan& plan, ros::TopicsSpec topics, std::int64_t begin_ns);

  /// How many of the run's frames the bag holds; all of them if it is complete.
  [[nodiscard]] std::uint64_t num_frames() const { return num_frames_; }
  [[nodiscard]] bool is_complete() const { return is_complete_; }

  /// Begins the bag, or goes on with it after its first `num_frames` frames.
  /// @return num_frames(), which is less where the end of the last frame is missing.
  /// @pre It is not complete, and num_frames <= num_frames().
  std::uint64_t Open(std::uint64_t num_frames);

  /// Adds the messages of a frame, and the hash of its clouds, to what is written of it.
  /// Thread-safe.
  void Encode(std::size_t sensor, const MadeFrame& made, EncodedFrame& encoded) const;
  /// Writes and commits them.
  void Write(const EncodedFrame& encoded);

  /// Adds where the vehicle is at the end of the last frame, attaches the sensors' manifests, and
  /// completes the bag.
  /// @pre All frames and manifests are written.
  void Finish(const RunPlan& plan, std::int64_t end_ns, const Transform& world_from_vehicle);

 private:
  void Put(const std::vector<ros::TopicMessage>& messages);
  void Begin();

  std::filesystem::path path_;
  bool is_mcap_;
  std::string scenario_json_;
  std::filesystem::path labels_file_;
  ros::FrameTopics topics_;
  std::int64_t begin_ns_;
  bool is_complete_ = false;
  std::uint64_t num_frames_ = 0;
  std::unique_ptr<bag::BagWriter> writer_;
};

}  // namespace railcast
