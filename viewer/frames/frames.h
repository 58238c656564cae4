#pragma once

#include <cstddef>
#include <memory>
#include <string>
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

}  // namespace railcast
