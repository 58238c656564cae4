#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/track/found_track.h"
#include "railcast/transform.h"
#include "viewer/color/palette.h"
#include "viewer/composition/composition.h"
#include "viewer/frames/camera_picture.h"
#include "viewer/frames/shown_frame.h"
#include "viewer/overlays/overlays.h"

namespace railcast {

/// Which overlays are drawn over the points.
struct OverlayChoices {
  bool mesh = false;
  bool boxes = false;
  bool track = false;
  bool gauge = false;
  bool frustum = false;
  bool axes = false;
  bool rings = false;
};

/// How two recordings are shown together.
enum class Layout : std::uint8_t {
  kBeside,    ///< Side by side, sharing one camera.
  kDistance,  ///< In one view, coloured by the distance to the nearest point of the other.
  kChanges    ///< In one view, coloured by which of the two has the point.
};

inline constexpr std::array<std::string_view, 3> kLayoutNames = {"beside", "distance", "changes"};

/// Limits the time to draw and the memory that accumulated frames take.
inline constexpr std::size_t kMaxAccumulated = 128;

/// How the user wants to see frames.
struct Choices {
  std::string color_by{};                       ///< Empty: the default field of the first frame.
  std::optional<ColorMap> map{};                ///< Empty: coolwarm for differences, else viridis.
  std::optional<std::array<double, 2>> ends{};  ///< Ends of the scale; empty: fitted to the frame.
  /// Ends of the scale for Layout::kDistance.
  std::optional<std::array<double, 2>> distance_ends_m{};
  std::size_t num_accumulated = 1;  ///< Frames shown at once, in world coordinates.
  /// The camera's image; empty: colours where there are images.
  std::optional<PictureKind> picture{};
  bool empty_beams = false;  ///< The fan of firings without a return.
  OverlayChoices overlays{};
  std::set<std::uint32_t> labels{};  ///< Points of other labels are faint; empty: none are.
  Layout layout = Layout::kBeside;
};

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

  /// Says which of the choices cannot be drawn, and why: "gauge and surfaces need the
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

  /// The tracks that a frame itself shows; those of the last frame are kept, since to find them
  /// takes a tenth of a second.
  [[nodiscard]] const FoundTracks& TracksOf(const ShownFrame& shown) const;

  mutable FoundTracks tracks_;
  mutable std::shared_ptr<const RecordedFrame> tracks_of_;
  RecordingInfo info_;
  std::unique_ptr<World> world_;  ///< Null without a scenario.
};

/// Fills in the choices left open: the field to colour by and the ends of its scale.
/// @throws InputError if the frame lacks the field, if ends are given for a field without a scale,
///   or if labels are selected and the frame has none.
void FitChoices(const ShownFrame& shown, Choices& choices);

/// Returns the transform from the second frame's sensor axes to the first's, each at its stamp, by
/// way of the world. Empty if a frame has no pose: both then stay in their own axes, taken as the
/// same, and only the different offsets subtracted from their positions are corrected.
[[nodiscard]] std::optional<Transform> FirstFromSecond(const ShownFrame& first,
                                                       const ShownFrame& second);

/// Returns for every point the distance in metres to the nearest point of the other frame, with the
/// frames registered by FirstFromSecond(). NaN if the other frame has no points. Runs in parallel;
/// the result does not depend on the number of threads.
[[nodiscard]] std::vector<float> DistancesToNearest_m(const ShownFrame& of,
                                                      const ShownFrame& other);

/// Shows two frames in the first one's axes, each point coloured by its distance to the nearest
/// point of the other frame. The frames are registered in world coordinates if both have poses.
[[nodiscard]] Composition ComposeDistances(const std::shared_ptr<const ShownFrame>& a,
                                           const std::shared_ptr<const ShownFrame>& b,
                                           const Choices& choices);

/// What became of a point from one recording of a frame to another recording of it.
enum class Change : std::uint8_t {
  kSame,      ///< In both with the same intensity, or where one of them has no intensities.
  kWeaker,    ///< In both, with a lower intensity in the second.
  kStronger,  ///< In both, with a higher intensity in the second.
  kAdded,     ///< In the second only.
  kRemoved    ///< In the first only.
};

/// The points of two frames, compared.
struct ChangedPoints {
  std::vector<Change> of_second;       ///< One per point of the second; never kRemoved.
  std::vector<std::uint32_t> removed;  ///< The other points of the first, by rising number.
};

/// Compares the points of two recordings of one frame. Points are the same if their recorded
/// positions are equal to the last bit, whichever order and slots they have; of several at one
/// place, each has at most one counterpart.
[[nodiscard]] ChangedPoints CompareFrames(const ShownFrame& first, const ShownFrame& second);

/// Shows the second frame, coloured by what changed since the first, and with it the points that
/// only the first has. The first cloud of the composition is the second frame. Frames with poses
/// are registered in world coordinates.
[[nodiscard]] Composition ComposeChanges(const std::shared_ptr<const ShownFrame>& first,
                                         const std::shared_ptr<const ShownFrame>& second,
                                         const Choices& choices);

}  // namespace railcast
