#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/composition/choices.h"
#include "viewer/composition/composition.h"
#include "viewer/overlays/overlays.h"

namespace railcast {

using ShownFrames = std::vector<std::shared_ptr<const ShownFrame>>;

/// Makes compositions of the frames of one source.
class Composer {
 public:
  /// @param info If it has a scenario, that gives the world for overlays.
  /// @throws InputError if the scenario's world cannot be built.
  explicit Composer(RecordingInfo info);
  ~Composer();
  Composer(Composer&&) noexcept;

  [[nodiscard]] const RecordingInfo& info() const { return info_; }

  /// Says which of the choices cannot be drawn, and why: "track, gauge and surfaces need the
  /// scenario, which is not known"; empty if all can.
  [[nodiscard]] std::string Missing(const ShownFrame& shown, const Choices& choices) const;

  /// @param frames The frame to be shown first, then those accumulated with it, the latest first.
  ///   They are drawn where they were in the world. Frames without a pose are left out; if the
  ///   frame to be shown has none, all others are.
  /// @param choices With the field and the scale filled in by FitChoices().
  /// @throws InputError if the frame lacks the field.
  [[nodiscard]] Composition Compose(const ShownFrames& frames, const Choices& choices);

 private:
  struct World;
  void AddEmptyBeams(const RecordedFrame& recorded, Composition& composition) const;
  void AddOverlays(const ShownFrame& shown,
                   const OverlayChoices& choices,
                   Composition& composition);

  RecordingInfo info_;
  std::unique_ptr<World> world_;  ///< Null without a scenario.
};

/// Fills in the choices left open: the field to colour by and the ends of its scale.
/// @throws InputError if the frame lacks the field, if ends are given for a field without a scale,
///   or if labels are selected and the frame has none.
void FitChoices(const ShownFrame& shown, Choices& choices);

}  // namespace railcast
