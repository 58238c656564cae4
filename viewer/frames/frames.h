#pragma once

#include <cstddef>
#include <memory>

#include "core/io/recording/recording.h"
#include "core/scene/world.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {

/// Frames of one source, counted from 0 in order of time.
class Frames {
 public:
  virtual ~Frames() = default;

  [[nodiscard]] const RecordingInfo& info() const { return info_; }
  /// Says what the frames were made of where they do not say it themselves: labels, materials,
  /// world and its objects.
  /// @param scenario Of one sensor.
  /// @throws InputError with one line if its world cannot be built, or if the recording has a
  ///   scenario of its own that says otherwise.
  void UseScenario(const ScenarioSpec& scenario);
  /// Null if there is no such frame: not yet, not any more, or beyond the end.
  /// @throws InputError with one line if it cannot be read.
  [[nodiscard]] virtual std::shared_ptr<const ShownFrame> Get(std::size_t place) = 0;
  /// How many frames have been seen so far; of most recordings all there are.
  [[nodiscard]] virtual std::size_t num_known() const = 0;
  /// The oldest place that Get() can give.
  [[nodiscard]] virtual std::size_t first_known() const { return 0; }

 protected:
  [[nodiscard]] std::shared_ptr<const ShownFrame> Shown(RecordedFrame recorded) const;

  RecordingInfo info_;

 private:
  std::shared_ptr<const World> world_;  ///< Of UseScenario; null without.
};

}  // namespace railcast
