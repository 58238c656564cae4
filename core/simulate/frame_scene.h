#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/detect/beam/texture.h"
#include "core/simulate/frame_motion.h"
#include "core/simulate/frame_poses.h"
#include "core/simulate/scene_store.h"
#include "core/simulate/window.h"
#include "core/trace/beam_tree.h"
#include "core/trace/trace_scene.h"
#include "railcast/ray_caster.h"
#include "railcast/scene.h"

namespace railcast {

class FiringTiles;

/// An object that rays of a packet hit.
struct ObjectHits {
  std::size_t object{};   ///< Index into World::objects().
  std::uint32_t lanes{};  ///< Bit i: the packet's ray i hits it.
};

/// Objects of a frame in a scene of their own.
struct LoneObjects {
  std::shared_ptr<const TraceScene> scene;
  /// Indices into World::objects() of the first placements of the scene, each of which is a figure
  /// or a piece of its object. Further placements are something else.
  std::vector<std::size_t> objects;

  /// Appends the objects that rays of the packet beginning at `first` hit within range, whatever
  /// stands before them. Thread-safe.
  void AddHits(const RayTile& rays, std::size_t first, std::vector<ObjectHits>& hits) const;
};

/// The scene of one frame and the poses from which its rays are cast.
struct FrameScene final : public RayCaster {
  std::uint32_t index{};
  std::int64_t stamp_ns{};
  std::shared_ptr<const Window> window;  ///< Stationary geometry.
  /// Objects that move or were added later, and what the wind moves; null if none is within reach.
  std::shared_ptr<const TraceScene> moving;
  /// The objects among them, by index into World::objects(), of the first placements of `moving`,
  /// which are figures and pieces.
  std::vector<std::size_t> moving_objects;
  /// What of both needs beams with a width, if that is not all.
  std::vector<BeamScenes> wide;
  FramePoses poses;  ///< Poses of the sensor in the window frame.
  /// Surfaces of the window, of objects that windows do not know, and of what sways if it has its
  /// own; empty if there are none of these.
  std::vector<Surface> more_surfaces;
  std::optional<FrameMotion> motion;    ///< If velocities are measured.
  TexturedThings textured;              ///< If textures are asked for: all objects with one.
  std::optional<WireSet> swayed_wires;  ///< If there is wind.

  /// The wires that the casters also see as tubes.
  [[nodiscard]] const WireSet& wires() const {
    return swayed_wires ? *swayed_wires : window->wires;
  }
  [[nodiscard]] const std::vector<Surface>& surfaces() const {
    return more_surfaces.empty() ? window->surfaces : more_surfaces;
  }

  void Cast(RayTile& rays) const override;
  void CastBeam(BeamRays& beam) const override;
  [[nodiscard]] bool NeedsWidth(const BeamRays& beam) const override;
  void CastRanges(RayTile& rays) const;
};

/// A frame whose window is there.
struct BegunFrame {
  std::uint32_t index{};
  std::int64_t stamp_ns{};
  std::shared_ptr<const Window> window;
  std::unique_ptr<const FrameScene> scene{};     ///< Null until FrameScenes::SceneOf().
  std::shared_ptr<const FiringTiles> tiles{};    ///< Its firings; null until their first use.
  std::shared_ptr<const ScanPattern> pattern{};  ///< Null before its use, and where it repeats.
};

/// Properties that all frames of a run share.
struct FrameSceneSpec {
  double range_max_m{};
  Transform vehicle_from_sensor = Transform::Identity();
  DetailRule detail{};
  std::uint32_t duration_ns{};  ///< From a frame's first firing to its last.
};

/// Makes the scene of any frame. It depends only on the frame index and on the world in use.
///
/// Stationary objects of the store's world are part of the windows. Moving objects, and objects
/// that a later world adds, go into a small scene made for each frame, so that they do not require
/// new windows. In wind, so do trees and wires.
class FrameScenes {
 public:
  /// The store's world is in use at first.
  FrameScenes(std::shared_ptr<SceneStore> store, const FrameSceneSpec& spec);

  /// @param world Differs from the store's world only in the vehicle's motion and in the objects.
  ///   Objects with the same model and instance id are taken to be the same.
  void UseWorld(std::shared_ptr<const World> world);

  /// Sets the callback for windows that are begun from now on.
  void UseProgress(WindowProgress progress) { windows_.UseProgress(std::move(progress)); }
  /// WindowSource::UseKept().
  void KeepWindows(std::size_t num) { windows_.UseKept(num); }

  /// Sets the stamp of the last frame, after which no window is built ahead.
  void UseLastStamp(std::int64_t stamp_ns) { last_stamp_ns_ = stamp_ns; }

  /// Sets the wind from now on; at first, there is none.
  void UseWind(const Wind& wind);

  /// Sets how long frames last from now on, where they differ.
  void UseDuration(std::uint32_t duration_ns) { spec_.duration_ns = duration_ns; }

  /// Sets whether scenes have their `motion` from now on; at first, they have not.
  void UseMotion(bool has_motion) { has_motion_ = has_motion; }

  /// Sets whether scenes have their `textured` from now on; at first, they have not.
  void UseTexture(bool has_texture) { has_texture_ = has_texture; }

  /// Has windows prepared for casting beams.
  /// @param labels DetectorSpec::footprint_labels from now on.
  void UseBeams(const std::vector<std::uint32_t>& labels = {}) {
    store_->UseBeams(labels);
    footprint_labels_ = labels;
  }

  /// Has scenes made for casting rays from now on, although windows may be prepared for beams.
  void UseRaysAlone() { footprint_labels_.clear(); }

  /// Whether nothing is coarser far away.
  [[nodiscard]] bool has_full_detail() const { return spec_.detail.ray_spacing_rad == 0.0; }
  /// Makes the same scenes, in full detail, for frames that are begun in almost any order.
  [[nodiscard]] std::unique_ptr<FrameScenes> InFullDetail() const;

  /// Begins a frame. Waits for its window if necessary, and starts preparing the next. Thread-safe,
  /// but windows are kept for one caller at a time.
  [[nodiscard]] BegunFrame Begin(std::uint32_t index, std::int64_t stamp_ns);
  /// Returns the scene of a frame, which is made on the first call. Scenes of different frames may
  /// be made at once.
  const FrameScene& SceneOf(BegunFrame& begun) const;

  /// The sensor's poses during a frame, relative to any window frame.
  [[nodiscard]] FramePoses PosesIn(const Transform& window_from_world, std::int64_t stamp_ns) const;

  /// The objects that are within range of the frame's sensor, without anything else.
  [[nodiscard]] std::vector<LoneObjects> ObjectsAlone(const FrameScene& frame) const;

  [[nodiscard]] const World& world() const { return *world_; }
  [[nodiscard]] const std::shared_ptr<const World>& shared_world() const { return world_; }
  [[nodiscard]] Transform WorldFromSensor(std::int64_t time_ns) const {
    return world_->WorldFromVehicle(time_ns) * spec_.vehicle_from_sensor;
  }

 private:
  /// One placement for each piece of the object.
  [[nodiscard]] std::vector<TracePlacement> Place(std::size_t object,
                                                  std::int64_t stamp_ns,
                                                  const Window& window) const;
  /// A place in the window at the begin and the end of a frame.
  struct Ends {
    Vector3 begin_m;
    Vector3 end_m;
  };
  /// A frame in which objects are placed.
  struct Moment {
    std::int64_t stamp_ns{};
    const Window& window;
    Ends sensor;
  };
  /// Returns whether a beam of the frame may hit an object.
  /// @param ends Of the object or of its first piece.
  [[nodiscard]] bool IsInReach(std::size_t object, const Ends& ends, const Moment& moment) const;
  /// What moves in a frame or was added later, as far as it is in reach.
  struct MovingThings {
    std::vector<TracePlacement> placements;
    TraceFigures figures;
    std::vector<std::size_t> objects;  ///< For each figure, then for each placement.
  };
  /// An object in reach: a figure, its pieces, or nothing.
  struct PlacedObject {
    std::optional<TraceFigure> figure;
    std::vector<TracePlacement> pieces;
  };
  [[nodiscard]] PlacedObject PlaceInReach(std::size_t object, const Moment& moment) const;
  /// @param object Bends, so that it may be a figure.
  [[nodiscard]] PlacedObject PlaceFigure(std::size_t object, const Moment& moment) const;
  [[nodiscard]] Vector3 SensorInWindow(std::int64_t stamp_ns, const Window& window) const {
    return (window.window_from_world * WorldFromSensor(stamp_ns)).translation();
  }
  [[nodiscard]] MovingThings MovingObjects(std::int64_t stamp_ns, const Window& window) const;
  /// The places of an object's pieces, which are not those of `window` alone, in its frame.
  [[nodiscard]] std::vector<Eigen::Affine3d> PiecesAt(std::size_t object,
                                                      std::int64_t time_ns,
                                                      const Window& window) const;
  /// Number of equal parts of a frame in which an object moves linearly, at this step of its poses.
  [[nodiscard]] std::int64_t NumPoseIntervals(std::int64_t pose_step_ns) const;
  /// The same at the object's own step; 0 if it does not move.
  [[nodiscard]] std::int64_t NumOwnIntervals(std::size_t object) const;
  [[nodiscard]] FrameMotion MotionOf(const FrameScene& scene, const Window& window) const;
  [[nodiscard]] TexturedThings TexturedOf(const FrameScene& scene, const Window& window) const;
  [[nodiscard]] SwayedThings Swayed(std::int64_t stamp_ns, const Window& window) const;
  /// Index of the first surface that sways, behind all others; nothing if scenes have no `motion`.
  [[nodiscard]] std::optional<std::uint32_t> FirstOwnSurface(const Window& window) const {
    if (!has_motion_) return std::nullopt;
    return static_cast<std::uint32_t>(window.surfaces.size() + more_surfaces_.size());
  }
  void AddSwayed(FrameScene& scene,
                 const Window& window,
                 std::vector<TracePlacement>& placements) const;
  [[nodiscard]] std::unique_ptr<const FrameScene> MakeScene(const BegunFrame& begun) const;
  void PrepareNextWindow(std::int64_t stamp_ns, int home_chunk);

  /// An object of the world in use.
  struct Object {
    SceneStore::StoredObject stored;
    /// Surface index of the object's first part: the same in every window or, for an object that
    /// windows do not know, counted from the end of the window's surfaces.
    std::uint32_t first_surface{};
    bool is_known_to_windows{};
    bool is_in_windows{};
    /// Bounds of the model of an object that may be a figure.
    std::optional<Eigen::AlignedBox3d> figure_bounds_m{};
  };
  [[nodiscard]] std::uint32_t FirstSurface(const Object& object, const Window& window) const {
    const auto num_windows = static_cast<std::uint32_t>(window.surfaces.size());
    return object.first_surface + (object.is_known_to_windows ? 0 : num_windows);
  }

  std::shared_ptr<SceneStore> store_;
  FrameSceneSpec spec_;
  WindowSource windows_;
  Wind wind_;
  bool has_motion_ = false;
  bool has_texture_ = false;
  std::vector<std::uint32_t> footprint_labels_;
  std::shared_ptr<const World> world_;
  std::vector<Object> objects_;  // In the order of world_->objects().
  /// Index in world_->objects() of each object in the windows, by its index in the store's world.
  std::map<std::size_t, std::size_t> standing_;
  std::int64_t last_stamp_ns_ = std::numeric_limits<std::int64_t>::max();
  std::vector<Surface> more_surfaces_;  // Surfaces of the objects that windows do not know.
};

}  // namespace railcast
