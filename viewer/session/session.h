#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "viewer/frames/frames.h"
#include "viewer/scene/choices.h"
#include "viewer/scene/compose.h"
#include "viewer/scene/scene.h"

namespace railcast {

/// One source, or two that are compared: which frame is shown and how.
class Session {
 public:
  /// @param frames One or two. They outlive the session.
  /// @throws InputError if a scenario's world cannot be built.
  Session(const std::vector<Frames*>& frames, Choices choices);

  /// Shows the frame at that place of the first source. Of the second it is the one of the same
  /// number if both are sequences of ours, else the one at the same place.
  /// @returns False, and everything stays, if there is none.
  /// @throws InputError if it cannot be read or, the first time, cannot be coloured as chosen.
  bool Seek(std::size_t place);
  [[nodiscard]] std::size_t place() const { return place_; }
  /// The last that all sources have, as far as they were read; 0 if one has none.
  [[nodiscard]] std::size_t LastPlace() const;
  /// The first that all sources have, or still have.
  [[nodiscard]] std::size_t FirstPlace() const;
  [[nodiscard]] bool has_frame() const { return !shown_.empty(); }

  /// What is chosen; to be followed by Compose().
  [[nodiscard]] Choices& choices() { return choices_; }
  /// Colours by the next, or the one before, of the fields that the frame has.
  void ColorByNext(bool forward);
  /// Fits the scale to the frame at hand.
  void FitScale();
  /// Shows that label with those selected already, or takes it from them.
  void ToggleLabel(std::uint32_t label);

  /// What of the choices cannot be drawn of the frames at hand, and why; empty if all can.
  [[nodiscard]] std::string Missing() const;

  /// A scene for each view: of two sources one each, or a single one of their distances. A frame
  /// that lacks the field chosen has its fallback's colours, and its status says so.
  [[nodiscard]] std::vector<Scene> Compose();
  [[nodiscard]] std::size_t num_views() const;

  [[nodiscard]] const Frames& source(std::size_t index) const { return *sources_[index].frames; }
  [[nodiscard]] std::size_t num_sources() const { return sources_.size(); }
  /// The frame shown of a source. @pre has_frame()
  [[nodiscard]] const std::shared_ptr<const ShownFrame>& shown(std::size_t index) const {
    return shown_[index];
  }
  /// From a frame to the next, by their stamps; 0.1 s where these do not rise.
  [[nodiscard]] double Period_s() const;

 private:
  struct Source {
    Frames* frames;
    Composer composer;
    std::ptrdiff_t offset{};  ///< Of a frame's place from that of the first source's.
    Choices fallback{};       ///< How frames are coloured that lack the field chosen.

    [[nodiscard]] std::shared_ptr<const ShownFrame> Get(std::size_t place) const;
  };
  void PairSources();
  void FitToAll(const std::vector<std::shared_ptr<const ShownFrame>>& shown);
  [[nodiscard]] Choices ChoicesFor(Source& source, const ShownFrame& shown, std::string& fault);
  [[nodiscard]] ShownFrames FramesWith(const Source& source,
                                       const std::shared_ptr<const ShownFrame>& shown) const;
  [[nodiscard]] Scene ComposeOne(std::size_t index);
  [[nodiscard]] Scene ComposeBoth();
  [[nodiscard]] std::string StatusOf(std::size_t index, const Scene& scene) const;

  std::vector<Source> sources_;
  Choices choices_;
  std::size_t place_{};
  std::vector<std::shared_ptr<const ShownFrame>> shown_;  ///< By source; empty: none yet.
};

}  // namespace railcast
