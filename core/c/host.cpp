#include "core/c/host.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/c/guard.h"
#include "core/scenario/json_rules.h"

namespace railcast {
namespace {

// Engines keep rotations in float32, whose quaternions are of unit length to 1e-6.
constexpr double kUnitTolerance = 1e-3;
// float32 resolves 0.5 mm below this value, but only 1 mm or less above.
constexpr double kMillimetreReach_m = 8192.0;

Vector3 FiniteVector(const double (&values)[3], const std::string& name) {
  for (int i = 0; i < 3; ++i) {
    if (std::isfinite(values[i])) continue;
    throw ArgumentError(name + "[" + std::to_string(i) + "]: must be finite" + Got(values[i]));
  }
  return Eigen::Map<const Vector3>(values);
}

HostMotion::Pose PartsOf(const railcast_pose& pose, const std::string& place) {
  const Eigen::Quaterniond rotation(Eigen::Map<const Eigen::Vector4d>(pose.quaternion_xyzw));
  if (!(std::abs(rotation.norm() - 1.0) <= kUnitTolerance)) {
    throw ArgumentError(place + ".quaternion_xyzw: must be of unit length" + Got(rotation.norm()));
  }
  return {FiniteVector(pose.position_m, place + ".position_m"), rotation.normalized()};
}

static_assert(kTileSize == RAILCAST_MAX_RAYS);

railcast_rays RaysOf(RayTile& tile) {
  return {.num_rays = tile.num_rays,
          .origin_x = tile.origin_x,
          .origin_y = tile.origin_y,
          .origin_z = tile.origin_z,
          .direction_x = tile.direction_x,
          .direction_y = tile.direction_y,
          .direction_z = tile.direction_z,
          .shutter = tile.shutter,
          .range_m = tile.range_m,
          .surface = tile.surface,
          .normal_x = tile.normal_x,
          .normal_y = tile.normal_y,
          .normal_z = tile.normal_z};
}

// Lengths of normals of which float32 holds the squares with all their digits.
constexpr double kLeastNormal = 1e-15;
constexpr double kLongestNormal = 1e15;

// In double, in which squares of float32 neither vanish nor overflow.
double SquaredLength(const RayTile& tile, std::size_t i) {
  const double x = static_cast<double>(tile.normal_x[i]);
  const double y = static_cast<double>(tile.normal_y[i]);
  const double z = static_cast<double>(tile.normal_z[i]);
  return x * x + y * y + z * z;
}

// Whether the callback kept the rules for every ray. Without branches, so that it is vectorised.
bool IsSound(const RayTile& tile, const float* range_max_m, std::size_t num_surfaces) {
  bool is_sound = true;
  // Surfaces 1 to last_surface are those of hits; 0 - 1 wraps around to the greatest number.
  const auto last_surface = static_cast<std::uint32_t>(num_surfaces - 1);
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float range_m = tile.range_m[i];
    const double squared_length = SquaredLength(tile, i);
    const bool is_miss = (tile.surface[i] == 0) & (range_m == range_max_m[i]);
    const bool is_hit = (tile.surface[i] - 1U < last_surface) & (range_m >= 0.0F) &
                        (range_m <= range_max_m[i]) &
                        (squared_length >= kLeastNormal * kLeastNormal) &
                        (squared_length <= kLongestNormal * kLongestNormal);
    is_sound &= is_miss | is_hit;
  }
  return is_sound;
}

// The rule that the callback broke for ray `i`; empty if none.
std::string BrokenRule(const RayTile& tile,
                       std::size_t i,
                       float range_max_m,
                       std::size_t num_surfaces) {
  const float range_m = tile.range_m[i];
  const std::uint32_t surface = tile.surface[i];
  if (surface >= num_surfaces) {
    return "surface: must be less than " + std::to_string(num_surfaces) + Got(surface);
  }
  if (surface == 0) {
    if (range_m == range_max_m) return "";
    return "range_m: must stay as it is where surface is 0" + Got(range_m);
  }
  if (!(range_m >= 0.0F && range_m <= range_max_m)) {
    return "range_m: must be in [0, " + NumberText(range_max_m) + "]" + Got(range_m);
  }
  const double length = std::sqrt(SquaredLength(tile, i));
  if (length >= kLeastNormal && length <= kLongestNormal) return "";
  return "the normal's length must be >= 1e-15 and <= 1e15" + Got(length);
}

std::vector<std::string> NamesOfLabels(const LabelTable& labels) {
  std::vector<std::string> names;
  for (const Label& label : labels.labels()) names.push_back(label.name);
  return names;
}

std::vector<std::string> NamesOfMaterials(const MaterialLibrary& materials) {
  std::vector<std::string> names;
  for (const Material& material : materials.materials()) names.push_back(material.name);
  names.erase(names.begin());  // "none".
  return names;
}

// The index of a name, or nothing if it is at fault.
std::optional<std::size_t> IndexOf(const std::string& place,
                                   const char* kind,
                                   const char* name,
                                   const std::vector<std::string>& known,
                                   ErrorList& errors) {
  const std::string whole = place + "." + kind;
  if (name == nullptr) {
    errors.Add({whole, "must not be null", ""});
    return std::nullopt;
  }
  const auto found = std::find(known.begin(), known.end(), name);
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  errors.Add({whole, Unknown(kind, name, known), Quoted(name)});
  return std::nullopt;
}

}  // namespace

HostMotion::HostMotion(const railcast_motion& motion,
                       const FrameTime& time,
                       const Transform& vehicle_from_sensor)
    : begin_(PartsOf(motion.world_from_sensor, "motion.world_from_sensor")),
      end_(PartsOf(motion.world_from_sensor_end, "motion.world_from_sensor_end")),
      scene_origin_m_(FiniteVector(motion.scene_origin_m, "motion.scene_origin_m")),
      time_(time),
      sensor_from_vehicle_(vehicle_from_sensor.inverse()) {
  for (const Pose& pose : {begin_, end_}) {
    const double away_m = (pose.position_m - scene_origin_m_).cwiseAbs().maxCoeff();
    if (away_m <= kMillimetreReach_m) continue;
    throw ArgumentError(
        "motion.scene_origin_m: must lie within 8192 m of the sensor, since float32 loses "
        "millimetres beyond" +
        Got(away_m));
  }
}

Transform HostMotion::window_from_world() const {
  return MakeTransform(Eigen::Matrix3d::Identity(), -scene_origin_m_);
}

Transform HostMotion::WorldFromVehicle(std::int64_t time_ns) const {
  const double duration_ns = std::max(1.0, static_cast<double>(time_.duration_ns));
  const double share = static_cast<double>(time_ns - time_.stamp_ns) / duration_ns;
  const Vector3 position_m = begin_.position_m + share * (end_.position_m - begin_.position_m);
  const Eigen::Quaterniond rotation = begin_.rotation.slerp(share, end_.rotation);
  return MakeTransform(rotation.toRotationMatrix(), position_m) * sensor_from_vehicle_;
}

railcast_pose PoseOf(const Transform& transform) {
  Eigen::Quaterniond rotation(transform.linear());
  if (rotation.w() < 0.0) rotation.coeffs() *= -1.0;
  railcast_pose pose{};
  Eigen::Map<Vector3>(pose.position_m) = transform.translation();
  Eigen::Map<Eigen::Vector4d>(pose.quaternion_xyzw) = rotation.coeffs();
  return pose;
}

void HostCaster::Cast(RayTile& tile) const {
  float range_max_m[kTileSize];
  std::copy_n(tile.range_m, tile.num_rays, range_max_m);
  const railcast_rays rays = RaysOf(tile);
  const int result = [&] {
    try {
      return cast_rays_(user_, &rays);
    } catch (...) {  // The host may be written in C++.
      throw CallbackError("the callback threw an exception");
    }
  }();
  if (result != 0) throw CallbackError("the callback returned " + std::to_string(result));
  if (IsSound(tile, range_max_m, surfaces_.size())) return;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const std::string rule = BrokenRule(tile, i, range_max_m[i], surfaces_.size());
    if (rule.empty()) continue;
    throw CallbackError("callback: ray " + std::to_string(i) + " of " +
                        std::to_string(tile.num_rays) + ": " + rule);
  }
}

std::vector<Surface> SurfacesOf(const railcast_surface* surfaces,
                                std::size_t num_surfaces,
                                const SurfaceNames& names) {
  const railcast_surface& nothing = NotNull(surfaces, "surfaces");
  if (num_surfaces == 0) throw ArgumentError("num_surfaces: must be > 0 (got 0)");
  if (nothing.material != nullptr || nothing.label != nullptr || nothing.instance != 0 ||
      nothing.is_ego != 0) {
    throw ArgumentError("surfaces[0]: must be all zero, since it stands for nothing");
  }
  const std::vector<std::string> materials = NamesOfMaterials(names.materials);
  const std::vector<std::string> labels = NamesOfLabels(names.labels);
  ErrorList errors;
  std::vector<Surface> table(1);
  for (std::size_t i = 1; i < num_surfaces; ++i) {
    const std::string place = "surfaces[" + std::to_string(i) + "]";
    const auto material = IndexOf(place, "material", surfaces[i].material, materials, errors);
    const auto label = IndexOf(place, "label", surfaces[i].label, labels, errors);
    if (!material || !label) continue;
    const std::size_t in_library = *material + 1;
    table.push_back(
        {.label = names.labels.labels()[*label].id,
         .instance = surfaces[i].instance,
         .reflectivity = static_cast<float>(names.materials.materials()[in_library].reflectivity),
         .material = static_cast<std::uint16_t>(in_library),
         .is_ego = surfaces[i].is_ego != 0});
  }
  if (!errors.empty()) throw ArgumentError(Join(errors.lines(), "\n"));
  return table;
}

}  // namespace railcast
