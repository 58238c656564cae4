#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/overlays/surroundings.h"
#include "viewer/scene/choices.h"
#include "viewer/scene/scene.h"

namespace railcast {

using ShownFrames = std::vector<std::shared_ptr<const ShownFrame>>;

/// Makes scenes of one source's frames.
class Composer {
 public:
  /// @param info Its scenario, if it has one, gives the world for overlays.
  /// @throws InputError if the scenario's world cannot be built.
  explicit Composer(RecordingInfo info);
  ~Composer();
  Composer(Composer&&) noexcept;

  [[nodiscard]] const RecordingInfo& info() const { return info_; }

  /// What of the choices cannot be drawn, and why: "the scenario is not known: no track, ...";
  /// empty if all can.
  [[nodiscard]] std::string Missing(const ShownFrame& shown, const Choices& choices) const;

  /// @param frames The one to be shown and then those accumulated with it, the latest first: drawn
  ///   where they were in the world. Those without a pose are left out, all of them if the one to
  ///   be shown has none.
  /// @param choices With a field and a scale: see FitChoices.
  /// @throws InputError if the frame lacks the field.
  [[nodiscard]] Scene Compose(const ShownFrames& frames, const Choices& choices);

 private:
  struct World;
  void AddEmptyBeams(const RecordedFrame& recorded, Scene& scene) const;
  void AddOverlays(const ShownFrame& shown, const OverlayChoices& choices, Scene& scene);

  RecordingInfo info_;
  std::unique_ptr<World> world_;  ///< Null without a scenario.
};

/// Fills in what is left open: the field to colour by, and the ends of its scale.
/// @throws InputError if the frame lacks the field, a scale has ends and the field none, or labels
/// are
///   selected that it does not have.
void FitChoices(const ShownFrame& shown, Choices& choices);

}  // namespace railcast
