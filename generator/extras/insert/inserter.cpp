#include "generator/extras/insert/inserter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/detect/base/beam_optics.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/io/recording/sequence_lines.h"
#include "core/io/run/object_survey.h"
#include "core/scan/firing.h"
#include "core/simulate/returns.h"
#include "generator/extras/insert/recorded_surface.h"
#include "generator/extras/insert/screen_surfaces.h"
#include "generator/extras/insert/screened_scan.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
// Stands in where a recording has no intensities.
constexpr float kUsualReflectance = 0.2F;

SimulatorSpec SimulatorSpecOf(const ScenarioSpec& scenario) {
  const LidarSpec& lidar = scenario.lidar;
  SimulatorSpec spec{.detector = DetectorSpecOf(scenario, lidar, EffectsOf(scenario)),
                     .vehicle_from_sensor = VehicleFromSensor(lidar.mount),
                     .nominal_from_true = NominalFromTrue(lidar.mount_error),
                     .has_full_detail = true};
  UseWeather(scenario, scenario.weather, spec);
  return spec;
}

/// The pattern in axes into which `from_pattern` turns.
ScanPattern Turned(ScanPattern pattern, const Eigen::Matrix3d& from_pattern) {
  const Eigen::Matrix3f rotation = from_pattern.cast<float>();
  const auto turn = [&](std::vector<float>& x, std::vector<float>& y, std::vector<float>& z) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Eigen::Vector3f turned = rotation * Eigen::Vector3f(x[i], y[i], z[i]);
      x[i] = turned.x();
      y[i] = turned.y();
      z[i] = turned.z();
    }
  };
  turn(pattern.direction_x, pattern.direction_y, pattern.direction_z);
  turn(pattern.origin_x_m, pattern.origin_y_m, pattern.origin_z_m);
  return pattern;
}

Vector3 RecordedPoint_m(const RecordedFrame& recorded, std::size_t slot) {
  const Frame& frame = recorded.frame;
  return recorded.origin_m + Vector3(static_cast<double>(frame.x[slot]),
                                     static_cast<double>(frame.y[slot]),
                                     static_cast<double>(frame.z[slot]));
}

bool HasReturn(const Frame& frame, std::size_t slot) {
  return !std::isnan(frame.x[slot]);
}

/// The recorded returns of a frame, and the slots in which they were.
struct RecordedReturns {
  std::vector<std::uint32_t> first{0};
  std::vector<Screen> screens;
  std::vector<std::uint32_t> slots;
  std::vector<float> power_kept{};  ///< Share of recorded power, by return; 1 if none is recorded.
};

// The intensity with which a return stands for the power that the receiver has met: less than that
// of the surface where this slants through the beam.
float IntensityAt(const RecordedFirings& firings,
                  const DetectorSpec& detector,
                  const IntensityScale& scale,
                  std::size_t firing,
                  std::size_t slot) {
  const Frame& frame = firings.recorded.frame;
  const auto stored = static_cast<double>(frame.intensity[slot]);
  const double intensity = (stored == 0.0 ? scale.of_zero : stored) / scale.per_reflectance;
  const float reflectance = intensity >= 0.0 ? static_cast<float>(intensity) : kUsualReflectance;
  if (!StretchLowersPower(detector)) return reflectance;
  return reflectance * PeakKeptAt(firings, detector.beam, firing, slot);
}

RecordedReturns ReturnsIn(const RecordedFirings& firings,
                          const DetectorSpec& detector,
                          const IntensityScale& scale) {
  const Frame& frame = firings.recorded.frame;
  const ScanPattern& pattern = firings.pattern;
  const bool has_powers = firings.recorded.Has("power_ratio");
  RecordedReturns returns;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const std::size_t cell = std::size_t{pattern.row[i]} * pattern.columns + pattern.column[i];
    for (std::size_t r = 0; r < frame.returns; ++r) {
      const std::size_t slot = firings.SlotOfCell(cell) + r;
      if (!HasReturn(frame, slot)) continue;
      const Vector3 from_origin_m =
          RecordedPoint_m(firings.recorded, slot) - BeamOrigin_m(pattern, i);
      const bool is_known = has_powers && frame.power_ratio[slot] > 0.0F;
      const float by_power =
          is_known ? frame.power_ratio[slot] * LeastIntensity(detector, frame.range_m[slot]) : 0.0F;
      returns.screens.push_back(
          {.range_m = static_cast<float>(from_origin_m.norm()),
           .intensity = by_power > 0.0F ? by_power : IntensityAt(firings, detector, scale, i, slot),
           .is_power_known = is_known,
           .share = BeamShareAt(firings, i, slot)});
      returns.slots.push_back(static_cast<std::uint32_t>(slot));
    }
    returns.first.push_back(static_cast<std::uint32_t>(returns.screens.size()));
  }
  return returns;
}

// Whether firings with several returns list the farthest first, as captures do. A frame that has
// none of them does not say.
bool AreFarthestFirst(const Frame& frame) {
  std::size_t num_farthest_first = 0;
  std::size_t num = 0;
  for (std::size_t first = 0; first + 1 < frame.num_slots(); first += frame.returns) {
    if (frame.returns < 2 || !HasReturn(frame, first) || !HasReturn(frame, first + 1)) continue;
    ++num;
    if (frame.range_m[first] > frame.range_m[first + 1]) ++num_farthest_first;
  }
  constexpr double kNearlyAll = 0.98;
  return num > 0 &&
         static_cast<double>(num_farthest_first) >= kNearlyAll * static_cast<double>(num);
}

void SortFarthestFirst(const std::vector<Screen>& screens, std::vector<ReturnNow>& returns) {
  std::ranges::stable_sort(returns, std::ranges::greater{}, [&](const ReturnNow& now) {
    return now.is_added ? now.range_m : screens[now.screen].range_m;
  });
}

bool HasSamePower(const Frame& before, const Frame& now, std::size_t slot) {
  return std::isnan(now.power_ratio[slot]) || now.power_ratio[slot] == before.power_ratio[slot];
}

void CopySlot(const RecordedFrame& from,
              std::size_t from_slot,
              std::size_t slot,
              RecordedFrame& to) {
  std::vector<const void*> sources;
  ForEachField(from.frame, [&](auto, auto, const auto& values) { sources.push_back(&values); });
  std::size_t next = 0;
  ForEachField(to.frame, [&](auto, auto, auto& values) {
    using Values = std::decay_t<decltype(values)>;
    values[slot] = (*static_cast<const Values*>(sources[next++]))[from_slot];
  });
  for (std::size_t i = 0; i < to.foreign.size(); ++i) {
    to.foreign[i].values[slot] = from.foreign[i].values[from_slot];
  }
}

// Gives added returns as many photons as recorded ones of their intensity and range have in the
// median: as many as the intensity over the square of the range.
void FillPhotons(const RecordedFrame& before, InsertedFrame& inserted) {
  const Frame& recorded = before.frame;
  Frame& frame = inserted.recorded.frame;
  auto& foreign = inserted.recorded.foreign;
  const auto photons = std::ranges::find(foreign, "signal", &ForeignField::name);
  if (photons == foreign.end()) return;
  const std::vector<float>& known =
      before.foreign[static_cast<std::size_t>(photons - foreign.begin())].values;
  const float of_byte_0 = IntensityOfByte(0);  // How dark these are is not known.
  std::vector<float> at_1_m;                   // Photons at 1 m of intensity 1.
  for (std::size_t slot = 0; slot < recorded.num_slots(); ++slot) {
    const float range_m = recorded.range_m[slot];
    const float each = known[slot] * range_m * range_m / recorded.intensity[slot];
    const bool is_known = HasReturn(recorded, slot) && recorded.intensity[slot] > of_byte_0;
    if (is_known && std::isfinite(each)) at_1_m.push_back(each);
  }
  if (at_1_m.empty()) return;
  const auto middle = at_1_m.begin() + static_cast<std::ptrdiff_t>(at_1_m.size() / 2);
  std::ranges::nth_element(at_1_m, middle);
  for (const SlotEdit& edit : inserted.edits) {
    float& value = photons->values[edit.slot];
    if (!edit.is_added || std::isfinite(value)) continue;
    value = *middle * frame.intensity[edit.slot] /
            (frame.range_m[edit.slot] * frame.range_m[edit.slot]);
  }
}

}  // namespace

struct Inserter::Parts {
  SimulatorSpec spec;
  std::shared_ptr<const World> world;
  IntensityScale scale;
  std::optional<Eigen::Matrix3d> sensor_from_spin;
  std::vector<std::int64_t> frame_times_ns;
  ScreenedScan scan;
  ObjectSurvey survey;
  std::optional<CertifySpec> certify{};
  std::optional<ScreenedCertifier> certifier{};

  void UseCertificates(const ScenarioSpec& scenario, double cost_share) {
    if (world->objects().empty()) {
      throw InputError(
          "--certify: must be off for a plan without objects, since nothing else is certified");
    }
    certifier.emplace(scenario, cost_share, spec.detector, *world);
    scan.UseVariants(certifier->certifier().variants());
    certify.emplace(CertifySpec{.cost_share = cost_share, .rungs = certifier->certifier().rungs()});
    for (const SceneObject& object : world->objects()) {
      certify->objects.emplace(object.instance, object.name);
    }
  }

  void PutReturns(const RecordedFirings& firings,
                  const RecordedReturns& returns,
                  const ChangedFiring& changed,
                  InsertedFrame& inserted) const {
    const RecordedFrame& before = firings.recorded;
    RecordedFrame& recorded = inserted.recorded;
    Frame& frame = recorded.frame;
    const ScanPattern& pattern = firings.pattern;
    const std::uint32_t i = changed.firing;
    const std::size_t first =
        firings.SlotOfCell(std::size_t{pattern.row[i]} * pattern.columns + pattern.column[i]);
    for (std::size_t r = 0; r < frame.returns; ++r) {
      const std::size_t slot = first + r;
      SlotEdit edit{.slot = static_cast<std::uint32_t>(slot), .from_slot = {}};
      edit.had_point = HasReturn(before.frame, slot);
      edit.has_point = r < changed.returns.size();
      ClearSlot(slot, frame);
      for (ForeignField& field : recorded.foreign) field.values[slot] = kNaN;
      if (edit.has_point) {
        const ReturnNow& now = changed.returns[r];
        edit.is_added = now.is_added;
        if (now.is_added) {
          edit.is_merged = now.screen != kNoScreen;
          PutAdded(firings, returns, now, slot, recorded);
          frame.time_ns[slot] = pattern.time_ns[i];
          frame.ring[slot] = pattern.row[i];
          frame.column[slot] = pattern.column[i];
          frame.mixed_share[slot] = changed.mixed_share;
        } else {
          edit.from_slot = returns.slots[now.screen];
          edit.is_weaker = now.intensity_ratio != 1.0F;
          CopySlot(before, *edit.from_slot, slot, recorded);
          frame.intensity[slot] *= now.intensity_ratio;
          frame.power_ratio[slot] *= returns.power_kept[now.screen];
        }
      } else if (r == 0) {
        frame.outcome[slot] = changed.outcome;
      }
      frame.return_index[slot] = static_cast<std::uint8_t>(r);
      frame.return_count[slot] = static_cast<std::uint8_t>(changed.returns.size());
      const auto lost = std::ranges::find_if(
          changed.lost, [&](const LostReturn& each) { return returns.slots[each.screen] == slot; });
      if (lost != changed.lost.end()) {
        edit.lost_to = lost->outcome;
        edit.hidden_by = lost->instance;
      }
      const bool is_as_before = edit.has_point == edit.had_point &&
                                (!edit.has_point || (edit.from_slot == slot && !edit.is_weaker &&
                                                     HasSamePower(before.frame, frame, slot)));
      if (!is_as_before) inserted.edits.push_back(edit);
    }
  }

  void PutAdded(const RecordedFirings& firings,
                const RecordedReturns& returns,
                const ReturnNow& now,
                std::size_t slot,
                RecordedFrame& recorded) const {
    Frame& frame = recorded.frame;
    const bool is_of_recorded = now.screen != kNoScreen;
    if (is_of_recorded) CopySlot(firings.recorded, returns.slots[now.screen], slot, recorded);
    Vector3 point_m = now.point_m.cast<double>();
    if (sensor_from_spin) point_m = *sensor_from_spin * point_m;
    point_m -= recorded.origin_m;
    frame.x[slot] = static_cast<float>(point_m.x());
    frame.y[slot] = static_cast<float>(point_m.y());
    frame.z[slot] = static_cast<float>(point_m.z());
    frame.range_m[slot] = now.range_m;
    frame.true_range_m[slot] = now.true_range_m;
    frame.intensity[slot] =
        is_of_recorded
            ? frame.intensity[slot] * now.intensity_ratio
            : static_cast<float>(static_cast<double>(now.intensity) * scale.per_reflectance);
    frame.power_ratio[slot] = now.power_ratio;
    frame.incidence_rad[slot] = now.incidence_rad;
    frame.footprint_share[slot] = now.footprint_share;
    frame.outcome[slot] = now.outcome;
    if (is_of_recorded) return;
    if (frame.has_velocity) {
      frame.radial_velocity_mps[slot] = now.velocity.measured_mps;
      frame.true_radial_velocity_mps[slot] = now.velocity.true_mps;
    }
    frame.label[slot] = now.label;
    frame.instance[slot] = now.instance;
    frame.material[slot] = now.material;
  }

  void PutFirings(const RecordedFirings& firings,
                  const RecordedReturns& returns,
                  std::vector<ChangedFiring>& changed,
                  InsertedFrame& inserted) const {
    const Frame& before = firings.recorded.frame;
    Frame& frame = inserted.recorded.frame;
    const bool are_farthest_first = AreFarthestFirst(before);
    auto next = changed.begin();
    for (std::uint32_t i = 0; i + 1 < returns.first.size(); ++i) {
      if (next != changed.end() && next->firing == i) {
        if (are_farthest_first) SortFarthestFirst(returns.screens, next->returns);
        PutReturns(firings, returns, *next++, inserted);
        continue;
      }
      for (std::uint32_t k = returns.first[i]; k < returns.first[i + 1]; ++k) {
        const std::uint32_t slot = returns.slots[k];
        frame.power_ratio[slot] *= returns.power_kept[k];
        if (HasSamePower(before, frame, slot)) continue;
        inserted.edits.push_back(
            {.slot = slot, .from_slot = slot, .had_point = true, .has_point = true});
      }
    }
  }

  [[nodiscard]] std::vector<RecordedObject> ObjectsIn(const Frame& inserted,
                                                      std::int64_t time_ns,
                                                      const std::vector<ObjectView>& views) {
    Frame frame = inserted;
    frame.stamp_ns = time_ns;
    frame.world_from_sensor = world->WorldFromVehicle(time_ns) * spec.vehicle_from_sensor;
    frame.world_from_sensor_end =
        world->WorldFromVehicle(time_ns + frame.duration_ns) * spec.vehicle_from_sensor;
    const Transform sensor_from_world = frame.world_from_sensor.inverse();
    std::vector<RecordedObject> objects;
    for (const ObjectInFrame& object : survey.Describe(frame, views)) {
      objects.push_back(RecordedOf(object, sensor_from_world));
    }
    return objects;
  }
};

Inserter::Inserter(const InsertPlan& plan, int num_threads, std::optional<double> certify) {
  const SimulatorSpec spec = SimulatorSpecOf(plan.scenario);
  // All objects are told of, however far they are.
  constexpr double kAnywhere_m = std::numeric_limits<double>::infinity();
  SimulatorSpec of_scan = spec;
  if (plan.sensor_from_spin) {
    of_scan.vehicle_from_sensor =
        spec.vehicle_from_sensor * MakeTransform(*plan.sensor_from_spin, Vector3::Zero());
  }
  parts_.reset(
      new Parts{.spec = spec,
                .world = plan.world,
                .scale = plan.intensity_scale,
                .sensor_from_spin = plan.sensor_from_spin,
                .frame_times_ns = plan.frame_times_ns,
                .scan{plan.world, plan.scenario.materials, of_scan, num_threads},
                .survey{*plan.world, LabelTable(plan.scenario.labels), kAnywhere_m, OutputSpec{}}});
  if (certify) parts_->UseCertificates(plan.scenario, *certify);
}

Inserter::~Inserter() = default;

bool Inserter::CanCertify(const InsertPlan& plan) {
  return !plan.world->objects().empty() && !EffectsOf(plan.scenario).dense_footprint;
}

const std::optional<CertifySpec>& Inserter::certify() const {
  return parts_->certify;
}

InsertedFrame Inserter::Insert(const RecordedFirings& firings, std::uint32_t frame_index) {
  Parts& parts = *parts_;
  Check(frame_index < parts.frame_times_ns.size(), "the plan has read all frames");
  const std::int64_t time_ns = parts.frame_times_ns[frame_index];
  InsertedFrame inserted;
  inserted.recorded = firings.recorded;
  RecordedReturns returns = ReturnsIn(firings, parts.spec.detector, parts.scale);
  const ScanPattern turned = parts.sensor_from_spin
                                 ? Turned(firings.pattern, parts.sensor_from_spin->transpose())
                                 : ScanPattern{};
  const RecordedScan recorded = {.index = frame_index,
                                 .stamp_ns = time_ns,
                                 .pattern = parts.sensor_from_spin ? turned : firings.pattern,
                                 .first = returns.first,
                                 .returns = returns.screens};
  ScreenedScan::Certify certify;
  if (parts.certifier) {
    certify = [&](const ScreenedFrame& made, std::span<const std::uint32_t> near,
                  const ScreenedScan::MakeAnew& make) {
      inserted.certificate = parts.certifier->Certify(recorded, made, near, make);
    };
  }
  ScreenedFrame screened = parts.scan.Scan(recorded, firings.recorded.frame.returns, certify);
  returns.power_kept = std::move(screened.power_kept);
  if (!firings.recorded.Has("power_ratio")) std::ranges::fill(returns.power_kept, 1.0F);
  parts.PutFirings(firings, returns, screened.firings, inserted);
  std::ranges::sort(inserted.edits, {}, &SlotEdit::slot);
  FillPhotons(firings.recorded, inserted);
  inserted.objects = parts.ObjectsIn(inserted.recorded.frame, time_ns, screened.views);
  return inserted;
}

}  // namespace railcast
