#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/messages/frame_topics.h"
#include "core/io/run/run_folder.h"
#include "core/io/verify/bag_lines.h"
#include "generator/run/frame_maker.h"
#include "generator/run/run_directory.h"
#include "generator/run/run_plan.h"

namespace railcast {

/// The bag of a run whose format is one: the messages of all its sensors' frames, in the order in
/// which these begin. A commit of the bag is a frame, but for the first, which holds what is said
/// once. So an interrupted bag is whole up to its last frame, and a resumed one has the bytes of
/// one that was never interrupted. Beside it stands what each commit holds (BagLines).
class RunBag {
 public:
  /// Looks what there is of the bag; writes nothing.
  /// @pre The run's directory is locked (FolderLock).
  RunBag(const RunPlan& plan, ros::TopicsSpec topics, std::int64_t begin_ns);

  /// How many of the run's frames the bag holds; all of them if it is complete.
  [[nodiscard]] std::uint64_t num_frames() const { return num_frames_; }
  [[nodiscard]] bool is_complete() const { return is_complete_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Whether a complete bag is as it was written. One that lacks the hashes of its files, as after
  /// a power cut just before they were written, is not.
  [[nodiscard]] bool IsUnchanged() const;
  /// Has a complete bag made anew: it and what is said of it are removed.
  void Discard();

  /// Begins the bag, or goes on with it after its first `num_frames` frames. One that holds others
  /// than were written is begun anew.
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
  void FindFrames(const std::filesystem::path& bag);
  [[nodiscard]] bool HasOthers() const;
  void RefuseStrangers() const;
  void Put(const std::vector<ros::TopicMessage>& messages);

  std::filesystem::path path_;
  bool is_mcap_;
  /// Names and texts of the files that are attached first.
  std::vector<std::pair<std::string, std::string>> attachments_;
  ros::FrameTopics topics_;
  std::vector<bag::BagTopic> bag_topics_;
  std::vector<std::uint64_t> topic_hashes_;
  std::int64_t begin_ns_;
  bool is_complete_ = false;
  std::uint64_t num_frames_ = 0;
  BagLines found_;      ///< Of an interrupted bag.
  WholeCommits whole_;  ///< What there is of these.
  std::vector<bag::BagAttachment> attached_;
  std::optional<LineFile> lines_;
  std::unique_ptr<bag::BagWriter> writer_;
};

}  // namespace railcast
