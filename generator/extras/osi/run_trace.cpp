#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/extras/osi/trace_file.h"
#include "core/extras/ros/bag/bag.h"
#include "core/io/run/run_folder.h"
#include "core/io/run/trace_name.h"
#include "core/io/write_file.h"
#include "core/rail/motion/track_path.h"
#include "core/rail/traffic/trains.h"
#include "generator/extras/osi/sensor_view.h"
#include "generator/run/frame_maker.h"
#include "generator/run/run_extras.h"
#include "generator/run/run_plan.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

// The power that the receiver gets of the emitted one at its detection threshold: that of a
// Lambertian surface of a known reflectance at a known range, at normal incidence, of which the
// window lets in aperture^2 / (4 range^2).
double PowerAtThreshold_ratio(const ScenarioSpec& scenario) {
  constexpr double kReflectanceOfDataSheets = 0.1;
  constexpr double kMmPerM = 1000.0;
  const bool is_published = SwitchedEffects(scenario).threshold;
  const LidarSpec& lidar = scenario.lidar;
  const double reflectance =
      is_published ? lidar.plausibility.reference_threshold : kReflectanceOfDataSheets;
  const double range_m =
      is_published ? lidar.plausibility.reference_range_m : lidar.receiver.range_at_10_percent_m;
  const double half_angle_rad = lidar.cover.aperture_mm / kMmPerM / (2.0 * range_m);
  return reflectance * half_angle_rad * half_angle_rad;
}

// From railcast's vehicle frame, which begins below the front pivot, to OSI's, which begins at the
// rear one.
Transform RearFromVehicle(const VehicleSpec& vehicle) {
  return Transform(Eigen::Translation3d(PivotDistance_m(vehicle), 0.0, 0.0));
}

osi::LidarOfView LidarOf(const FrameMaker& maker,
                         const ScenarioSpec& scenario,
                         std::size_t sensor) {
  // The sensor, the thing, and the mirror on both ways.
  constexpr std::uint32_t kWithMirror = 3;
  osi::LidarOfView lidar;
  lidar.sensor_id = sensor;
  lidar.detector_id = maker.num_sensors() + sensor;
  lidar.rear_from_sensor =
      RearFromVehicle(scenario.vehicle) * VehicleFromSensor(scenario.lidar.mount);
  lidar.pattern = &maker.pattern(sensor);
  lidar.firings = osi::FiringsByRay(*lidar.pattern);
  lidar.wavelength_nm = scenario.lidar.beam.wavelength_nm;
  lidar.max_interactions = SwitchedEffects(scenario).mirror_paths ? kWithMirror : 1;
  lidar.power_at_threshold_ratio = PowerAtThreshold_ratio(scenario);
  return lidar;
}

// The vehicle that carries the sensor. Without ego boxes and train its box has no size. OSI's boxes
// of vehicles begin on the ground.
osi::ObjectOfView HostOf(const RailWorld& world,
                         const VehicleSpec& vehicle,
                         const RigidMotion& motion) {
  osi::ObjectOfView host{.id = 0, .name = "ego", .type = "ego", .label = "ego", .moves = true};
  Eigen::AlignedBox3d box_m(Vector3::Zero());
  const auto& objects = world.objects();
  const auto own = std::ranges::find(objects, host.name, &SceneObject::name);
  if (own != objects.end()) {
    host.id = own->instance;
    box_m = own->model->Bounds();
    box_m.min().z() = std::min(box_m.min().z(), 0.0);
  }
  host.size_m = box_m.sizes();
  host.world_from_box = motion.world_from_body * Eigen::Translation3d(box_m.center());
  host.velocity_mps = motion.VelocityOf_mps(box_m.center());
  host.acceleration_mps2 = motion.AccelerationOf_mps2(box_m.center());
  host.front_m = -box_m.center();
  host.rear_m = Vector3(-PivotDistance_m(vehicle), 0.0, 0.0) - box_m.center();
  return host;
}

// The other vehicles of the sensor's train, which the survey leaves out.
void AddRestOfTrain(const RailWorld& world,
                    const Frame& frame,
                    std::vector<osi::ObjectOfView>& objects) {
  for (std::size_t i = 0; i < world.objects().size(); ++i) {
    const SceneObject& object = world.objects()[i];
    if (!object.is_ego || object.name == objects.front().name) continue;
    const Eigen::AlignedBox3d box_m = object.model->Bounds();
    const RigidMotion box = Differentiated([&](double after_s) -> Transform {
      const std::int64_t time_ns = frame.stamp_ns + std::llround(after_s * kNsPerS);
      return world.WorldFromObject(i, time_ns) * Eigen::Translation3d(box_m.center());
    });
    objects.push_back({.id = object.instance,
                       .name = object.name,
                       .type = object.type,
                       .label = "ego",
                       .moves = true,
                       .size_m = box_m.sizes(),
                       .world_from_box = box.world_from_body,
                       .velocity_mps = box.velocity_mps,
                       .acceleration_mps2 = box.acceleration_mps2});
  }
}

void AddSurveyed(const RailWorld& world,
                 const std::vector<ObjectInFrame>& surveyed,
                 std::vector<osi::ObjectOfView>& objects) {
  std::unordered_set<std::string_view> moving;
  for (const SceneObject& object : world.objects()) {
    if (object.moves) moving.insert(object.name);
  }
  for (const ObjectInFrame& object : surveyed) {
    objects.push_back({.id = object.instance,
                       .name = object.name,
                       .type = object.type,
                       .label = object.label,
                       .moves = moving.contains(object.name),
                       .size_m = object.size_m,
                       .world_from_box = object.world_from_box,
                       .velocity_mps = object.velocity_world_mps});
  }
}

// Makes of a frame its serialized osi3.SensorView. Several threads may do so at once.
using SensorViewMaker = std::function<std::string(const MadeFrame& made)>;

SensorViewMaker MakeSensorViews(const FrameMaker& maker,
                                const ScenarioSpec& scenario,
                                std::size_t sensor) {
  return [&maker, lidar = LidarOf(maker, scenario, sensor),
          vehicle = scenario.vehicle](const MadeFrame& made) {
    const FrameMaker::State& state = maker.StateAt(made.frame.stamp_ns);
    std::vector<osi::ObjectOfView> objects = {HostOf(*state.world, vehicle, made.vehicle)};
    AddRestOfTrain(*state.world, made.frame, objects);
    AddSurveyed(*state.world, made.objects, objects);
    const osi::FrameOfView view{made.frame, objects, state.weather};
    if (lidar.pattern->repeats()) return osi::SensorViewOf(lidar, view);
    const ScanPattern of_frame = PatternOfFrame(*lidar.pattern, made.frame.index);
    osi::LidarOfView in_frame = lidar;
    in_frame.pattern = &of_frame;
    in_frame.firings = osi::FiringsByRay(of_frame);
    return osi::SensorViewOf(in_frame, view);
  };
}

fs::path UnfinishedTrace(const fs::path& file) {
  return file.string() + std::string(kUnfinishedSuffix);
}

// Little-endian, as all of this program's files.
std::string LengthBytes(const std::string& message) {
  const auto length = static_cast<std::uint32_t>(message.size());
  return {reinterpret_cast<const char*>(&length), sizeof length};
}

/// The OSI trace of a sequence. An .osi file has its name from its begin, an MCAP file is named as
/// those of bags are.
class OsiTrace final : public SequenceTrace {
 public:
  /// @param topic Of the MCAP file's only channel.
  OsiTrace(fs::path file, std::string topic, SensorViewMaker sensor_view)
      : file_(std::move(file)), topic_(std::move(topic)), sensor_view_(std::move(sensor_view)) {}

  void Find() override;
  [[nodiscard]] std::optional<std::string> NextHash() override {
    return found_ ? found_->NextHash() : std::nullopt;
  }
  std::size_t Open(std::size_t num_messages) override;
  [[nodiscard]] std::string Encode(const MadeFrame& made) const override {
    return sensor_view_(made);
  }
  void Append(std::int64_t time_ns, const std::string& message) override;
  void Close() override;

 private:
  fs::path file_;
  std::string topic_;
  SensorViewMaker sensor_view_;
  std::optional<osi::TraceReader> found_;
  std::optional<LineFile> single_channel_;
  std::unique_ptr<bag::BagWriter> mcap_;
  std::size_t channel_{};
};

void OsiTrace::Find() {
  found_.reset();
  try {
    for (const fs::path& file : {file_, UnfinishedTrace(file_)}) {
      if (!found_ && fs::exists(file)) found_.emplace(file);
    }
  } catch (const InputError&) {
    // What cannot be read counts as absent.
  }
}

std::size_t OsiTrace::Open(std::size_t num_messages) {
  found_.reset();
  if (file_.extension() == osi::kSingleChannel) {
    std::uint64_t end = 0;
    if (num_messages > 0) {
      osi::SingleChannelReader reader(file_);
      for (std::size_t i = 0; i < num_messages; ++i) (void)reader.Next();
      end = reader.position();
    }
    single_channel_.emplace(file_, end);
    return num_messages;
  }
  // A run may be interrupted after its last frame, before its manifest is written.
  if (fs::exists(file_)) fs::rename(file_, UnfinishedTrace(file_));
  if (num_messages == 0) fs::remove(UnfinishedTrace(file_));
  const auto trace = osi::McapTraceOf(osi::ProtobufVersion());
  constexpr auto kCompression = bag::McapCompression::kZstd;
  mcap_ = fs::exists(UnfinishedTrace(file_))
              ? bag::ContinueMcap(file_, kCompression, num_messages, trace)
              : bag::CreateMcap(file_, kCompression, trace);
  channel_ = mcap_->Add({.name = topic_,
                         .type = "osi3.SensorView",
                         .definition = osi::SensorViewDescriptors(),
                         .hash = {},
                         .is_latched = false,
                         .encoding = "protobuf"});
  return mcap_->num_commits();
}

void OsiTrace::Append(std::int64_t time_ns, const std::string& message) {
  if (single_channel_) {
    single_channel_->Append(LengthBytes(message) + message);
  } else {
    mcap_->Write({channel_, time_ns, std::as_bytes(std::span(message))});
    mcap_->Commit();
  }
}

void OsiTrace::Close() {
  if (single_channel_) return single_channel_->Sync();
  mcap_->Close();
}

void CheckTrace(const RunChoices& choices) {
  if (choices.fields == "all") return;
  throw InputError("--fields: OSI's are fixed, so it must be left out with --format " +
                   choices.format + " (got " + choices.fields + ")");
}

void PlanTrace(const FrameMaker& maker, std::size_t index, SensorPlan& sensor) {
  SequenceSpec& spec = sensor.spec;
  spec.trace =
      TraceName({osi::ProtobufVersion(), spec.num_frames, sensor.name, spec.files.format->trace});
  spec.make_trace = [file = spec.directory / spec.trace,
                     topic = (sensor.name.empty() ? "lidar" : sensor.name) + ".SensorView",
                     sensor_view = MakeSensorViews(maker, sensor.scenario, index)] {
    return std::make_unique<OsiTrace>(file, topic, sensor_view);
  };
}

}  // namespace

void AddOsi(RunExtras& extras) {
  extras.check_trace = CheckTrace;
  extras.plan_trace = PlanTrace;
}

}  // namespace railcast
