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
  Transform vehicle_from_sensor = Transform::Identity();  ///< As reported: its nominal mount.
  /// Error of the mount: rays leave from the true sensor, and poses and points in the axes of the
  /// vehicle or the world are reported as if it were the nominal one.
  Transform nominal_from_true = Transform::Identity();
  OutputSpec output{};
  std::string origin_place = "/output/origin_m";  ///< Name of output.origin_m in error messages.
  std::uint16_t snow_material{};  ///< Material of the snow on covered surfaces; 0 = no snow cover.
  bool has_full_detail = false;   ///< Whether nothing has a coarser form far away.
  std::string isa{};              ///< Embree instruction set to force; empty = the best available.
};

/// Callback that reports progress while a window is built: the number of completed steps, most of
/// which are chunks, of the total. The last call has num_done == num_steps. Several threads may
/// call it at once. An exception that it throws aborts the build and propagates to every caller
/// waiting for the window.
using WindowProgress = std::function<void(std::size_t num_done, std::size_t num_steps)>;

/// The history of one firing from hit to return, as `railcast-generate trace` shows it. The steps
/// describe its first echo.
struct FiringStory {
  std::uint32_t firing{};
  std::uint32_t time_ns{};  ///< Since the stamp.
  std::uint32_t slot{};     ///< Slot of the firing's first return.
  Vector3 direction_sensor;
  Vector3 origin_world;
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

/// Another way of making firings: the simulator's spec with other effects.
struct FiringVariant {
  EffectSet effects{};
  int footprint_rays = 64;  ///< BeamSpec::footprint_rays.
  /// Whether only those beams have a width that have one by the simulator's spec
  /// (DetectorSpec::footprint_labels); otherwise all have.
  bool has_footprint_of = true;
};

/// How much of an object the beams of a frame see.
///
/// Where beams have a width (effect `footprint`), each is sampled by 16 rays of equal share;
/// otherwise it is its central ray. The same rays, each at the time of its firing, are cast at the
/// object alone and at the whole scene. Whether an echo is detected makes no difference.
struct ObjectView {
  /// Firings of which a ray would meet the object within range if nothing else stood there.
  std::uint32_t firings_alone{};
  std::uint32_t firings_visible{};  ///< Those of which a ray meets it first.
  std::uint32_t rays_alone{};       ///< Rays that would meet it if nothing else stood there.
  std::uint32_t rays_visible{};     ///< Those that meet it first.

  /// The share of the object that something else hides, 0 to 1; absent where no ray would meet it
  /// even alone.
  [[nodiscard]] std::optional<double> occlusion() const {
    if (rays_alone == 0) return std::nullopt;
    return 1.0 - static_cast<double>(rays_visible) / static_cast<double>(rays_alone);
  }
  friend bool operator==(const ObjectView&, const ObjectView&) = default;
};

class SceneStore;

/// A frame that Simulator::Begin() has begun. It holds the stationary geometry that it needs, and
/// its moving objects from their first use on.
struct BegunFrame;

/// Makes the store of a world's geometry (chunks and models, ready to be traced), which is built
/// once for all sensors of a run. The store is thread-safe.
/// @param isa Embree instruction set to force; empty = the best available.
[[nodiscard]] std::shared_ptr<SceneStore> MakeSceneStore(std::shared_ptr<const World> world,
                                                         const MaterialLibrary& materials,
                                                         const std::string& isa = {});

/// A scene that a host program traces itself, with its own geometry and surface table. The wind of
/// the weather moves nothing of it.
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
/// MakeSimulator() builds the simulator of a scenario.
///
///     const auto simulator = MakeSimulator(ReadScenario(file), /*num_threads=*/0);
///     Frame frame;
///     simulator->Scan(42, frame);
class Simulator {
 public:
  /// @throws InputError if a number in `spec` is invalid (CheckDetectorSpec), `snow_material` is
  ///   not an index into `materials`, or this machine lacks the instruction set.
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

  /// As above, but the host traces the scene. Of the world, only the motion of the vehicle is used.
  void Scan(std::uint32_t frame_index, const HostScene& host, Frame& frame);

  /// Begins a frame: waits for the stationary geometry around the vehicle, which is built if
  /// necessary. Frames are best begun in their order, since what lies behind the vehicle is
  /// forgotten. One caller at a time.
  [[nodiscard]] std::shared_ptr<BegunFrame> Begin(std::uint32_t frame_index);
  /// As Scan() of its index. Several threads may call this and the other functions that take a
  /// begun frame at once, for different frames, as long as nothing is changed by Use(), UseWorld()
  /// or UseThreads().
  void Scan(BegunFrame& begun, Frame& frame);
  /// As Scan() and then ViewObjects(), in less time: where beams are single rays, the objects are
  /// looked for with those that the frame has cast.
  void Scan(BegunFrame& begun, Frame& frame, std::vector<ObjectView>& views);

  /// As Scan(), but only firings whose beams may meet one of some objects are traced, and those of
  /// their packets; all others are as if they met nothing. What the frame has on these objects is
  /// the same, in a fraction of the time where they are few and far; where halos reach from beam to
  /// beam, all firings are traced.
  /// @param objects Indices into world().objects().
  void ScanNearObjects(BegunFrame& begun, std::span<const std::size_t> objects, Frame& frame);

  /// Which beams of a frame may meet one of some objects, with the simulator's own effects or with
  /// those of a variant: all that do are among them, and some that do not.
  /// @param objects As for ScanNearObjects().
  /// @return Their cells, row * columns + column, rising: as ScanFirings() takes them.
  [[nodiscard]] std::vector<std::uint32_t> FiringsNearObjects(
      BegunFrame& begun, std::span<const std::size_t> objects) const;

  /// Tells the ways in which ScanFirings() makes firings.
  void UseVariants(std::vector<FiringVariant> variants);
  /// Makes some firings of a begun frame in every variant, in the scene that the frame itself is
  /// traced in and with the same random draws: what differs from the frame comes from the effects.
  /// Halos, which reach from beam to beam, are left out. Thread-safe as Scan().
  /// @param cells Numbers row * columns + column of the firings, rising; at least one.
  /// @param frames For each variant: one row, with a column for each cell.
  void ScanFirings(BegunFrame& begun,
                   std::span<const std::uint32_t> cells,
                   std::span<Frame> frames);

  /// How much the frame's beams see of each of world().objects(), in order.
  [[nodiscard]] std::vector<ObjectView> ViewObjects(std::uint32_t frame_index);
  [[nodiscard]] std::vector<ObjectView> ViewObjects(BegunFrame& begun);

  /// Calls `visit` with the scene of a frame, on the run's threads: TBB's algorithms within it use
  /// as many as the simulator.
  void VisitScene(std::uint32_t frame_index, const std::function<void(const SceneOfFrame&)>& visit);
  void VisitScene(BegunFrame& begun, const std::function<void(const SceneOfFrame&)>& visit);

  /// Calls `work` on the run's threads: TBB's algorithms within it use as many as the simulator.
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
  /// Tells the stamp of the last frame that will be begun: windows that only later ones would need
  /// are not built ahead. Frames are the same, be it right or wrong.
  void UseLastStamp(std::int64_t stamp_ns);
  /// Keeps the geometry around so many earlier places of the vehicle, for runs that pass them
  /// again. Frames are the same; memory grows by some ten megabytes for each.
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
  /// The pattern that the simulator was made with, which gives that of any frame
  /// (PatternOfFrame()).
  [[nodiscard]] const ScanPattern& pattern() const;
  [[nodiscard]] Transform WorldFromSensor(std::int64_t time_ns) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace railcast
