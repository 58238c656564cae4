#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "railcast/effects.h"
#include "railcast/frame.h"
#include "railcast/lidar.h"
#include "railcast/material.h"
#include "railcast/ray_caster.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// Everything that a simulation depends on besides the world, the scan pattern and the frame index.
struct SimulatorSpec {
  DetectorSpec detector{};
  Transform vehicle_from_sensor = Transform::Identity();  ///< The nominal mount.
  /// Mount error: rays leave from the true pose of the sensor, whereas reported poses, and points
  /// in vehicle or world axes, are computed as if the sensor were at its nominal pose.
  Transform nominal_from_true = Transform::Identity();
  OutputSpec output{};
  std::string origin_place = "/output/origin_m";  ///< Name of output.origin_m in error messages.
  std::uint16_t snow_material{};  ///< Material of the snow on covered surfaces; 0 = no snow cover.
  bool has_full_detail = false;   ///< Whether far things are traced as finely as near ones.
  std::string isa{};              ///< Embree instruction set to force; empty = the best available.
};

/// Callback that reports progress while a window, the scene of the chunks around the vehicle, is
/// built: num_done of num_steps steps, most of which are chunks, are completed. The last call has
/// num_done == num_steps. Several threads may call it at once. An exception that it throws aborts
/// the build and propagates to every caller waiting for the window.
using WindowProgress = std::function<void(std::size_t num_done, std::size_t num_steps)>;

/// The history of one firing from hit to return, as `railcast-generate trace` shows it. The steps
/// describe its first echo.
struct FiringStory {
  std::uint32_t firing{};
  std::uint32_t time_ns{};   ///< Since the stamp.
  std::uint32_t slot{};      ///< Slot of the firing's first return.
  Vector3 direction_sensor;  ///< Unit vector in the sensor frame.
  Vector3 origin_world;      ///< Where the beam leaves, in the world frame, m.
  /// Label of the surface hit; 0 = none. The next three describe the same surface.
  std::uint32_t label{};
  std::uint32_t instance{};
  std::uint16_t material{};
  float reflectivity{};

  /// State of the firing after one effect. NaN = not known yet.
  struct Step {
    std::string effect;
    Outcome outcome{};
    float true_range_m{};
    float cos_incidence{};
    float intensity{};
    float power_ratio{};
    float range_m{};
    /// Number of echoes this effect added: drops, flakes, further surfaces, ...
    std::size_t num_added_echoes{};
  };
  std::vector<Step> steps;

  /// One echo of the firing, whether detected or too weak, or the record that nothing came back.
  /// NaN = none or not known.
  struct Echo {
    std::uint32_t label{};  ///< Label of the surface or of the clutter.
    float true_range_m{};
    float range_m{};
    float power_ratio{};
    float footprint_share{};
    Outcome outcome{};
    /// Slot of this echo in the frame; absent if it is not a return.
    std::optional<std::uint32_t> slot;
  };
  /// All echoes in the order in which they were found: surfaces by range, then clutter.
  std::vector<Echo> echoes;
};

/// A variant in which ScanFirings() simulates firings: the simulator's spec with other effects.
struct FiringVariant {
  EffectSet effects{};
  int footprint_rays = 64;  ///< BeamSpec::footprint_rays.
  /// Whether, as in the simulator's spec, a beam has a width only if it may meet a surface with one
  /// of DetectorSpec::footprint_labels; if false, every beam has one.
  bool has_footprint_of = true;
  /// Whether far things are traced as finely as near ones, whatever SimulatorSpec says.
  bool has_full_detail = false;
};

/// How much of an object the beams of a frame see.
///
/// Where beams have a width (effect `footprint`), 16 rays of equal weight sample each beam;
/// otherwise its central ray stands for it. The same rays, each at the time of its firing, are cast
/// at the object alone and at the whole scene. Whether an echo is detected makes no difference.
struct ObjectView {
  /// Firings with a ray that would meet the object within range if nothing else stood there.
  std::uint32_t firings_alone{};
  std::uint32_t firings_visible{};  ///< Firings with a ray that meets the object first.
  std::uint32_t rays_alone{};       ///< Rays that would meet the object if it stood alone.
  std::uint32_t rays_visible{};     ///< Rays that meet the object first.

  /// The share of rays_alone that something else blocks, 0 to 1; absent if rays_alone is 0.
  [[nodiscard]] std::optional<double> occlusion() const {
    if (rays_alone == 0) return std::nullopt;
    return 1.0 - static_cast<double>(rays_visible) / static_cast<double>(rays_alone);
  }
  friend bool operator==(const ObjectView&, const ObjectView&) = default;
};

class SceneStore;

/// A frame that Simulator::Begin() has begun. It holds the stationary geometry around the vehicle
/// and, once a function has needed them, the moving objects.
struct BegunFrame;

/// Makes the store of a world's geometry (chunks and models, ready to be traced), which is built
/// once for all sensors of a run. The store is thread-safe.
/// @param isa Embree instruction set to force; empty = the best available.
/// @throws InputError if this machine lacks the instruction set.
[[nodiscard]] std::shared_ptr<SceneStore> MakeSceneStore(std::shared_ptr<const World> world,
                                                         const MaterialLibrary& materials,
                                                         const std::string& isa = {});

/// A scene that a host program traces itself, with its own surfaces, which wind does not move.
struct HostScene {
  const RayCaster& caster;  ///< Traces rays given in the host's window frame.
  /// Window frame in metres, chosen by the host; its origin must be near the sensor for float32 to
  /// be precise enough.
  Transform window_from_world;
  const std::vector<Surface>& surfaces;  ///< Surface table for the caster's indices; 0 = nothing.
};

struct WireSet;

/// The scene of one frame at its stamp, for casting other rays than the sensor's (Camera).
struct SceneOfFrame {
  /// Traces rays given in the window frame. RayTile::shutter 0 is the stamp.
  const RayCaster& caster;
  const std::vector<Surface>& surfaces;  ///< Surface table for the caster's indices; 0 = nothing.
  const WireSet* wires{};  ///< The wires that the caster sees as tubes; null = unknown.
  std::int64_t stamp_ns{};
  Transform window_from_world;
  Transform window_from_vehicle;  ///< Pose of the vehicle at the stamp.
};

/// Simulates a sensor: turns a frame index into a Frame. Each tile of firings is aimed, traced,
/// detected and stored.
///
/// A frame depends on its index alone, never on earlier frames or on the number of threads.
/// MakeSimulator() builds the simulator of a scenario. Functions that make frames or scenes throw
/// InputError if memory or threads do not suffice.
///
///     const auto simulator = MakeSimulator(ReadScenario(file), /*num_threads=*/0);
///     Frame frame;
///     simulator->Scan(42, frame);
class Simulator {
 public:
  /// @throws InputError if a number in `spec` is invalid (CheckDetectorSpec), `snow_material` is
  ///   not an index into `materials`, or this machine lacks the instruction set.
  /// @param num_threads 0 = all cores.
  Simulator(std::shared_ptr<const World> world,
            ScanPattern pattern,
            const MaterialLibrary& materials,
            const SimulatorSpec& spec,
            int num_threads);
  /// Makes one of several sensors. Simulators with the same store share its geometry; each still
  /// produces the frames that it would produce alone.
  /// @param store Made with the same materials and with spec.isa.
  Simulator(std::shared_ptr<SceneStore> store,
            ScanPattern pattern,
            const MaterialLibrary& materials,
            const SimulatorSpec& spec,
            int num_threads);
  ~Simulator();

  /// Simulates a frame into `frame`, whose memory is reused if the shape is unchanged. Not
  /// thread-safe: one caller at a time.
  void Scan(std::uint32_t frame_index, Frame& frame);

  /// The overload for hosts that trace. Of the world, only the vehicle's motion is used.
  void Scan(std::uint32_t frame_index, const HostScene& host, Frame& frame);

  /// Begins a frame: waits for the stationary geometry around the vehicle, which is built if
  /// necessary. Frames are best begun in ascending order, because geometry behind the vehicle is
  /// dropped and would be built again. One caller at a time.
  [[nodiscard]] std::shared_ptr<BegunFrame> Begin(std::uint32_t frame_index);
  /// As Scan() with the index of the begun frame. Several threads may call this and the other
  /// functions that take a begun frame at once, each for another frame, while no thread calls
  /// Use(), UseWorld() or UseThreads().
  void Scan(BegunFrame& begun, Frame& frame);
  /// As Scan() followed by ViewObjects(), but faster: where beams are single rays, the views are
  /// counted from the rays that were cast for the frame.
  void Scan(BegunFrame& begun, Frame& frame, std::vector<ObjectView>& views);

  /// As Scan(), but traces only the packets with a firing whose beam may meet one of the given
  /// objects; all other firings are stored as if they met nothing. Echoes of these objects are as
  /// in Scan(), in a fraction of the time if the objects are few and far away. Where halos reach
  /// from beam to beam, all firings are traced.
  /// @param objects Indices into world().objects().
  void ScanNearObjects(BegunFrame& begun, std::span<const std::size_t> objects, Frame& frame);

  /// The firings of a frame whose beams may meet one of the given objects, with the simulator's own
  /// effects or those of any variant (UseVariants()): a superset of the firings that do meet one.
  /// @param objects As for ScanNearObjects().
  /// @return Indices of their cells, row * columns + column, ascending, as ScanFirings() takes
  /// them.
  [[nodiscard]] std::vector<std::uint32_t> FiringsNearObjects(
      BegunFrame& begun, std::span<const std::size_t> objects) const;

  /// Sets the variants in which ScanFirings() simulates firings. One in full detail has scenes of
  /// its own if the simulator has not: they share chunks, models and objects with the simulator's
  /// where these are as fine, and are built when firings are first simulated there.
  void UseVariants(std::vector<FiringVariant> variants);
  /// Simulates some firings of a begun frame in every variant, in the same scene (but for its
  /// detail, if the variant says so) and with the same random draws as the frame itself, so that
  /// differences from it are due to these alone. Halos, which reach from beam to beam, are left
  /// out. Thread-safe as Scan() of a begun frame.
  /// @param cells Indices row * columns + column of the firings, ascending; at least one.
  /// @param[out] frames One for each variant, with one row and a column for each cell.
  void ScanFirings(BegunFrame& begun,
                   std::span<const std::uint32_t> cells,
                   std::span<Frame> frames);

  /// How much the frame's beams see of each of world().objects(), in order.
  [[nodiscard]] std::vector<ObjectView> ViewObjects(std::uint32_t frame_index);
  [[nodiscard]] std::vector<ObjectView> ViewObjects(BegunFrame& begun);

  /// Calls `visit` with the scene of a frame, in the simulator's TBB arena: TBB algorithms in
  /// `visit` use the simulator's number of threads.
  void VisitScene(std::uint32_t frame_index, const std::function<void(const SceneOfFrame&)>& visit);
  void VisitScene(BegunFrame& begun, const std::function<void(const SceneOfFrame&)>& visit);

  /// Calls `work` in the simulator's TBB arena, as VisitScene() does with `visit`.
  void Execute(const std::function<void()>& work);

  /// Replays one firing with the same packet and random numbers as in Scan().
  /// @pre firing < pattern().num_firings()
  [[nodiscard]] FiringStory Explain(std::uint32_t frame_index, std::uint32_t firing);

  [[nodiscard]] const SimulatorSpec& spec() const;
  /// Replaces the detector's spec except its ranges, while keeping the scenes. This lets speed and
  /// accuracy studies compare effect sets on one scene within one process.
  /// @pre The rest of `spec` is unchanged.
  /// @throws InputError as the constructor does; nothing changes in that case.
  void Use(const SimulatorSpec& spec);
  /// Switches to a world that differs from the constructor's only in the vehicle's motion and in
  /// its objects. Built chunks and models are kept; so are windows, unless a stationary object of
  /// the constructor's world has been removed. Frames do not depend on the worlds used in between.
  void UseWorld(std::shared_ptr<const World> world);
  /// Sets the progress callback for windows that are begun from now on, including those built in
  /// the background. Scan() and any other function that needs a window rethrows what the callback
  /// throws.
  void UseProgress(WindowProgress progress);
  /// Sets the stamp of the last frame that will be begun, so that windows for later frames are not
  /// built ahead. A wrong stamp costs time but changes no frame.
  void UseLastStamp(std::int64_t stamp_ns);
  /// Keeps the `num` windows used last besides the current one, for runs that return to earlier
  /// places. Changes no frame; each window takes some ten megabytes of memory.
  void KeepWindows(std::size_t num);
  /// Sets the number of threads.
  /// @param num_threads 0 = all cores.
  void UseThreads(int num_threads);
  [[nodiscard]] std::size_t num_threads() const;

  /// Returns the raw trace of a frame, the baseline of all speed figures: its rays are aimed
  /// beforehand, and every call traces them in packets of 16 and stores the ranges only. Valid as
  /// long as the simulator exists.
  [[nodiscard]] std::function<void()> MakeRawTrace(std::uint32_t frame_index);

  /// The world currently in use.
  [[nodiscard]] const World& world() const;
  [[nodiscard]] const std::shared_ptr<const World>& shared_world() const;
  /// The pattern that the simulator was made with; PatternOfFrame() gives that of any frame.
  [[nodiscard]] const ScanPattern& pattern() const;
  /// The pose of the nominal sensor (SimulatorSpec), which frames report.
  [[nodiscard]] Transform WorldFromSensor(std::int64_t time_ns) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace railcast
