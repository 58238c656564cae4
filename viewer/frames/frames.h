#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "railcast/frame.h"
#include "railcast/io/recording.h"
#include "railcast/scene.h"
#include "viewer/frames/camera_picture.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {

/// Returns the objects of a world at a frame's stamp, for frames that do not list them: names,
/// labels, boxes and velocities, means over the scan; their counts of firings are 0. The sensor's
/// own vehicle is left out.
/// @pre The frame's pose is known and in the world's coordinates.
[[nodiscard]] std::vector<RecordedObject> ObjectsAt(const World& world,
                                                    const LabelTable& labels,
                                                    const Frame& frame);

/// The frames of one source, counted from 0 in order of time.
class Frames {
 public:
  virtual ~Frames() = default;

  [[nodiscard]] const RecordingInfo& info() const { return info_; }
  /// Supplies what the frames do not say themselves: labels, materials, the world and its objects.
  /// @param scenario A scenario of one sensor.
  /// @throws InputError with one line if its world cannot be built, or if the recording has a
  ///   scenario of its own that differs.
  void UseScenario(const ScenarioSpec& scenario);
  /// Returns the frame at a place; null if it has not come yet, is no longer kept, or lies beyond
  /// the end.
  /// @throws InputError with one line if it cannot be read.
  [[nodiscard]] virtual std::shared_ptr<const ShownFrame> Get(std::size_t place) = 0;
  /// Returns the camera's picture of a frame; null if there is none.
  /// @throws InputError with one line if it cannot be read.
  [[nodiscard]] virtual std::shared_ptr<const CameraPicture> Picture(std::size_t /*place*/,
                                                                     PictureKind /*kind*/) {
    return nullptr;
  }
  /// Says what a picture needs, for frames that have none.
  [[nodiscard]] virtual std::string PictureNeeds() const {
    return "images need a sequence whose scenario has a camera";
  }
  /// Returns how many frames are known so far; for most recordings, all of them.
  [[nodiscard]] virtual std::size_t num_known() const = 0;
  /// Returns the oldest place that Get() can give.
  [[nodiscard]] virtual std::size_t first_known() const { return 0; }

 protected:
  [[nodiscard]] std::shared_ptr<const ShownFrame> Shown(RecordedFrame recorded) const;

  RecordingInfo info_;

 private:
  std::shared_ptr<const World> world_;  ///< World of UseScenario(); null without one.
};

/// Returns the meaning of a recording's label numbers: from its own table, or from a labels.json
/// near its files. That may be in the directory or beside the file, or beside the frames/ that the
/// source is or lies in; for KITTI clouds, up to beside sequences/00/velodyne/. Empty if there is
/// none.
/// @throws InputError with one line if the labels.json is damaged.
[[nodiscard]] LabelTable LabelsOf(const RecordingInfo& info);

/// Counts the frames of a recording of unknown length on a thread of its own: reads it once, to its
/// end or to the first damage, without making frames.
class FrameCounter {
 public:
  explicit FrameCounter(std::filesystem::path source);
  /// Stops counting.
  ~FrameCounter() = default;
  FrameCounter(const FrameCounter&) = delete;
  FrameCounter& operator=(const FrameCounter&) = delete;

  /// Returns the number of frames counted so far. Thread-safe.
  [[nodiscard]] std::size_t num_counted() const { return num_counted_; }

 private:
  void Count(const std::filesystem::path& source, const std::stop_token& stop);

  std::atomic<std::size_t> num_counted_{};
  /// The last member, so that the thread ends before what it uses is destroyed.
  std::jthread thread_;
};

/// The frames of a recording, in any order.
class RecordedFrames final : public Frames {
 public:
  /// @param source As OpenRecording() takes it. A single file of a sequence has the labels of the
  ///   sequence.
  /// @throws InputError with one line if it cannot be opened.
  explicit RecordedFrames(const std::filesystem::path& source);

  /// The frames used last are kept.
  [[nodiscard]] std::shared_ptr<const ShownFrame> Get(std::size_t place) override;

  [[nodiscard]] std::shared_ptr<const CameraPicture> Picture(std::size_t place,
                                                             PictureKind kind) override {
    return pictures_.At(place, kind);
  }

  /// Returns the place of the frame with that number in its run (Frame::index), because a sequence
  /// need not begin with 0.
  /// @throws InputError with one line if there is none.
  [[nodiscard]] std::size_t PlaceOf(std::uint32_t frame_index);

  /// For a capture, whose frames are counted in the background, this rises up to their number.
  [[nodiscard]] std::size_t num_known() const override;
  /// Reads on to the end.
  void SeekEnd();

 private:
  void Reopen();
  /// Reads on by one frame and keeps its reader; returns false at the end.
  bool Advance();

  std::unique_ptr<Recording> recording_;
  /// Readers of frames [first_reader_, first_reader_ + readers_.size()), the last that were passed.
  /// To go back farther, the recording is read again from its beginning.
  std::deque<Recording::FrameReader> readers_;
  std::size_t first_reader_{};
  std::size_t num_passed_{};  ///< Number of frames passed so far; for most recordings, all.
  bool is_end_known_ = false;
  FrameShelf kept_{FrameShelf::Limits{}};
  RecordedPictures pictures_;
  /// Only if the recording does not say how many frames it has.
  std::optional<FrameCounter> counter_;
};

}  // namespace railcast
