#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "viewer/composition/composer.h"
#include "viewer/composition/composition.h"
#include "viewer/frames/frames.h"

namespace railcast {

/// One source, or two to compare: which frame is shown and how.
class Session {
 public:
  /// @param frames One or two sources. They must outlive the session.
  /// @throws InputError if a scenario's world cannot be built.
  Session(const std::vector<Frames*>& frames, Choices choices);

  /// Shows the frame at that place of the first source. The second source shows the frame with the
  /// same index if both are sequences, captures of one sensor, bags or directories of clouds, else
  /// the one at the same place.
  /// @returns False if there is none; the session is then unchanged.
  /// @throws InputError if the frame cannot be read or, the first time, cannot be coloured as
  ///   chosen.
  bool Seek(std::size_t place);
  [[nodiscard]] std::size_t place() const { return place_; }
  /// Returns the last place that all sources have, as far as they are known; 0 if one has none.
  [[nodiscard]] std::size_t LastPlace() const;
  /// Returns the first place that all sources have, or still have.
  [[nodiscard]] std::size_t FirstPlace() const;
  [[nodiscard]] bool has_frame() const { return !shown_.empty(); }

  /// The choices; call Compose() after changing them.
  [[nodiscard]] Choices& choices() { return choices_; }
  /// Colours by the next, or the previous, of the fields that the frame has.
  void ColorByNext(bool forward);
  /// Fits the scale to the current frame.
  void FitScale();
  /// Shows the camera's next kind of image, the last being none.
  void ShowNextPicture();
  /// Adds a label to those selected, or removes it.
  void ToggleLabel(std::uint32_t label);

  /// Says which of the choices cannot be drawn for the current frames, and why; empty if all can.
  [[nodiscard]] std::string Missing() const;

  /// Makes a composition for each view: one per source, or a single one of two that are laid over
  /// each other. A frame that lacks the chosen field gets the fallback's colours, and its status
  /// says so.
  [[nodiscard]] std::vector<Composition> Compose();
  [[nodiscard]] std::size_t num_views() const;

  [[nodiscard]] const Frames& source(std::size_t index) const { return *sources_[index].frames; }
  [[nodiscard]] std::size_t num_sources() const { return sources_.size(); }
  /// The current frame of a source.
  /// @pre has_frame()
  [[nodiscard]] const std::shared_ptr<const ShownFrame>& shown(std::size_t index) const {
    return shown_[index];
  }
  /// Returns the time from one frame to the next, by their stamps; 0.1 s where these do not rise.
  [[nodiscard]] double Period_s() const;

 private:
  struct Source {
    Frames* frames;
    Composer composer;
    std::ptrdiff_t offset{};  ///< Place of a frame minus its place in the first source.
    Choices fallback{};       ///< Colours for frames that lack the chosen field.

    [[nodiscard]] std::shared_ptr<const ShownFrame> Get(std::size_t place) const;
    /// As Frames::Picture(), for a place of the first source.
    [[nodiscard]] std::shared_ptr<const CameraPicture> Picture(std::size_t place,
                                                               PictureKind kind) const;
  };
  void PairSources();
  void FitToAll(const std::vector<std::shared_ptr<const ShownFrame>>& shown);
  [[nodiscard]] Choices ChoicesFor(Source& source, const ShownFrame& shown, std::string& fault);
  [[nodiscard]] ShownFrames FramesWith(const Source& source,
                                       const std::shared_ptr<const ShownFrame>& shown) const;
  [[nodiscard]] Composition ComposeOne(std::size_t index);
  [[nodiscard]] Composition ComposePoints();
  [[nodiscard]] Composition ComposeBoth();
  [[nodiscard]] bool HasPicture() const;
  void AddPicture(const Source& source, Composition& composition) const;
  [[nodiscard]] std::string StatusOf(std::size_t index, const Composition& composition) const;

  std::vector<Source> sources_;
  Choices choices_;
  std::size_t place_{};
  /// One per source; empty before the first frame.
  std::vector<std::shared_ptr<const ShownFrame>> shown_;
};

}  // namespace railcast
