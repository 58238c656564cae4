#include "railcast/c_api.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/c/guard.h"
#include "core/c/host.h"
#include "core/scenario/json_rules.h"
#include "core/scenario/track_limits.h"
#include "railcast/error.h"
#include "railcast/fidelity.h"
#include "railcast/frame.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

/// What a host traces its scene with.
struct HostSceneOfSim {
  railcast_cast_rays cast_rays{};
  void* user{};
  std::vector<railcast::Surface> surfaces;
};

struct railcast_sim {  // NOLINT(readability-identifier-naming): a name in the manner of C
  railcast::ScenarioSpec scenario;
  std::unique_ptr<railcast::Simulator> simulator;
  std::optional<HostSceneOfSim> host;
  railcast::Frame frame;
  bool has_frame = false;
  std::atomic<bool> is_stepping = false;
};

namespace railcast {
namespace {

/// Marks a simulation as in use by the calling thread.
class Use {
 public:
  explicit Use(railcast_sim& sim) : sim_(sim) {
    if (sim.is_stepping.exchange(true)) {
      throw ArgumentError("sim: must not be in use by another call");
    }
  }
  ~Use() { sim_.is_stepping = false; }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  railcast_sim& sim_;
};

std::unique_ptr<railcast_sim> MakeSim(const railcast_config& config) {
  const std::string text = &NotNull(config.json_text, "config.json_text");
  const std::filesystem::path file = config.file == nullptr ? "scenario" : config.file;
  if (config.num_threads < 0 || config.num_threads > RAILCAST_MAX_THREADS) {
    throw ArgumentError("config.num_threads: must be >= 0 and <= " +
                        std::to_string(RAILCAST_MAX_THREADS) + Got(config.num_threads));
  }
  const auto sensor =
      config.sensor == nullptr ? std::nullopt : std::optional<std::string>(config.sensor);
  auto sim = std::make_unique<railcast_sim>();
  sim->scenario = PickSensor(ReadScenarioText(text, file), sensor);
  return sim;
}

void MakeSimulatorOf(railcast_sim& sim, int num_threads) {
  sim.simulator = MakeSimulator(sim.scenario, num_threads);
}

const Frame& FrameOf(const railcast_sim& sim) {
  if (sim.is_stepping) throw ArgumentError("sim: must not be in use by another call");
  if (!sim.has_frame) throw ArgumentError("sim: must have a frame, from a step that succeeded");
  return sim.frame;
}

void CheckFrame(const ScanPattern& pattern, std::uint32_t frame_index) {
  if (frame_index <= pattern.LastFrame()) return;
  throw ArgumentError("frame_index: must be at most " + std::to_string(pattern.LastFrame()) +
                      Got(frame_index));
}

// Does a step: `scan` makes the frame.
template <typename Scan>
void Step(railcast_sim& sim, std::uint32_t frame_index, bool is_of_host, const Scan& scan) {
  const Use use(sim);
  if (sim.host.has_value() != is_of_host) {
    throw ArgumentError(is_of_host ? "sim: must be made by railcast_create_with_scene()"
                                   : "sim: must be made by railcast_create()");
  }
  sim.has_frame = false;
  CheckFrame(sim.simulator->pattern(), frame_index);
  scan();
  sim.has_frame = true;
}

template <typename T>
constexpr railcast_type TypeOf() {
  if constexpr (std::is_same_v<T, float>) return RAILCAST_FLOAT32;
  if constexpr (std::is_same_v<T, std::uint32_t>) return RAILCAST_UINT32;
  if constexpr (std::is_same_v<T, std::uint16_t>) return RAILCAST_UINT16;
  return RAILCAST_UINT8;
}

railcast_field FieldOf(const Frame& frame, std::string_view wanted) {
  railcast_field field{};
  std::vector<std::string> names;
  ForEachField(frame, [&](std::string_view name, std::string_view, const auto& values) {
    using Value = typename std::decay_t<decltype(values)>::value_type;
    static_assert(sizeof(Value) == 1 || !std::is_enum_v<Value>);
    if (name == wanted) field = {values.data(), values.size(), TypeOf<Value>()};
    names.emplace_back(name);
  });
  if (field.type == 0) {
    throw ArgumentError("name: " + Unknown("field", wanted, names) + " (got " + Quoted(wanted) +
                        ")");
  }
  return field;
}

}  // namespace
}  // namespace railcast

using railcast::ArgumentError;
using railcast::Guarded;
using railcast::NotNull;

int railcast_c_api_version(void) {
  return RAILCAST_C_API_VERSION;
}

const char* railcast_version(void) {
  return RAILCAST_VERSION;
}

const char* railcast_last_error(void) {
  return railcast::LastError();
}

railcast_status railcast_create(const railcast_config* config, railcast_sim** sim) {
  return Guarded([&] {
    NotNull(sim, "sim") = nullptr;
    auto made = railcast::MakeSim(NotNull(config, "config"));
    railcast::MakeSimulatorOf(*made, config->num_threads);
    if (made->scenario.fidelity == railcast::Fidelity::kAuto) {
      railcast::UseChosenFidelity(*made->simulator, made->scenario, [](double) {});
    }
    *sim = made.release();
  });
}

void railcast_destroy(railcast_sim* sim) {
  delete sim;
}

railcast_status railcast_create_with_scene(const railcast_config* config,
                                           const railcast_scene* scene,
                                           railcast_sim** sim) {
  return Guarded([&] {
    NotNull(sim, "sim") = nullptr;
    auto made = railcast::MakeSim(NotNull(config, "config"));
    if (NotNull(scene, "scene").cast_rays == nullptr) {
      throw ArgumentError("scene.cast_rays: must not be null");
    }
    if (made->scenario.fidelity == railcast::Fidelity::kAuto) {
      throw railcast::InputError({{made->scenario.sources.Place("/fidelity"),
                                   "must be a rung where the host brings the scene, since auto "
                                   "measures the scenario's own",
                                   "\"auto\""}});
    }
    made->host = {scene->cast_rays, scene->user,
                  railcast::SurfacesOf(scene->surfaces, scene->num_surfaces,
                                       {railcast::LabelTable(made->scenario.labels),
                                        railcast::MaterialLibrary(made->scenario.materials)})};
    railcast::MakeSimulatorOf(*made, config->num_threads);
    *sim = made.release();
  });
}

railcast_status railcast_set_surfaces(railcast_sim* sim,
                                      const railcast_surface* surfaces,
                                      size_t num_surfaces) {
  return Guarded([&] {
    const railcast::Use use(NotNull(sim, "sim"));
    if (!sim->host) throw ArgumentError("sim: must be made by railcast_create_with_scene()");
    sim->host->surfaces =
        railcast::SurfacesOf(surfaces, num_surfaces,
                             {railcast::LabelTable(sim->scenario.labels),
                              railcast::MaterialLibrary(sim->scenario.materials)});
  });
}

railcast_status railcast_get_scan(const railcast_sim* sim, railcast_scan* scan) {
  return Guarded([&] {
    const railcast::ScanPattern& pattern = NotNull(sim, "sim").simulator->pattern();
    NotNull(scan, "scan") = {.rate_hz = pattern.rate_hz,
                             .duration_ns = pattern.time_ns.back(),
                             .num_firings = static_cast<std::uint32_t>(pattern.num_firings())};
  });
}

railcast_status railcast_step(railcast_sim* sim, uint32_t frame_index) {
  return Guarded([&] {
    railcast::Step(NotNull(sim, "sim"), frame_index, /*is_of_host=*/false, [&] {
      railcast::Simulator& simulator = *sim->simulator;
      // MakeSimulator() made it with the scenario's own world.
      const auto& world = static_cast<const railcast::RailWorld&>(simulator.world());
      CheckStaysOnTracks(sim->scenario, world, simulator.pattern(), frame_index, frame_index);
      simulator.Scan(frame_index, sim->frame);
    });
  });
}

railcast_status railcast_step_host(railcast_sim* sim,
                                   uint32_t frame_index,
                                   const railcast_motion* motion) {
  return Guarded([&] {
    railcast::Step(NotNull(sim, "sim"), frame_index, /*is_of_host=*/true, [&] {
      railcast::Simulator& simulator = *sim->simulator;
      const railcast::ScanPattern& pattern = simulator.pattern();
      const auto world = std::make_shared<const railcast::HostMotion>(
          NotNull(motion, "motion"),
          railcast::FrameTime{pattern.StampNs(frame_index), pattern.time_ns.back()},
          simulator.spec().vehicle_from_sensor);
      simulator.UseWorld(world);
      const railcast::HostCaster caster(sim->host->cast_rays, sim->host->user, sim->host->surfaces);
      simulator.Scan(frame_index, {caster, world->window_from_world(), sim->host->surfaces},
                     sim->frame);
    });
  });
}

railcast_status railcast_get_frame(const railcast_sim* sim, railcast_frame* frame) {
  return Guarded([&] {
    const railcast::Frame& made = railcast::FrameOf(NotNull(sim, "sim"));
    NotNull(frame, "frame") = {
        .stamp_ns = made.stamp_ns,
        .index = made.index,
        .duration_ns = made.duration_ns,
        .rows = made.rows,
        .columns = made.columns,
        .returns = made.returns,
        .num_slots = made.num_slots(),
        .world_from_sensor = railcast::PoseOf(made.world_from_sensor),
        .world_from_sensor_end = railcast::PoseOf(made.world_from_sensor_end)};
  });
}

railcast_status railcast_get_field(const railcast_sim* sim,
                                   const char* name,
                                   railcast_field* field) {
  return Guarded([&] {
    const railcast::Frame& frame = railcast::FrameOf(NotNull(sim, "sim"));
    NotNull(field, "field") = railcast::FieldOf(frame, &NotNull(name, "name"));
  });
}

const char* railcast_outcome_name(unsigned outcome) {
  const auto& names = railcast::kOutcomeNames;
  return outcome < names.size() ? names[outcome].data() : nullptr;
}
