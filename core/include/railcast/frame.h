#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "railcast/enum_names.h"
#include "railcast/outcome.h"
#include "railcast/transform.h"

namespace railcast {

/// One class of railcast's label table and its counterparts in published data sets.
struct Label {
  std::uint32_t id{};
  std::string name;                   ///< Lower snake case, unique.
  std::array<std::uint8_t, 3> rgb{};  ///< Colours that colour-blind people can tell apart, too.
  std::string whu_railway3d;          ///< Class name in WHU-Railway3D; "Others" where none fits.
  std::string osdar23;                ///< Class name in OSDaR23; empty where none fits.
  /// Id written to .label files: SemanticKITTI's own where a class matches, above 259 otherwise.
  std::uint16_t semantic_kitti{};
  std::uint16_t semantic_kitti_nearest{};  ///< The closest of SemanticKITTI's own ids.

  bool operator==(const Label&) const = default;
};

/// The label table of `scenarios/labels.json`. Id 0 is `unlabeled`: the beam hit nothing.
class LabelTable {
 public:
  LabelTable() = default;
  /// @pre Ids and names are unique (the scenario reader checks this).
  explicit LabelTable(std::vector<Label> labels) : labels_(std::move(labels)) {}

  [[nodiscard]] const std::vector<Label>& labels() const { return labels_; }
  /// The label of that name or id; null if the table lacks it. Valid as long as the table.
  [[nodiscard]] const Label* Find(std::string_view name) const;
  [[nodiscard]] const Label* Find(std::uint32_t id) const;

  /// The id of a label.
  /// @throws InputError if the table lacks the name.
  [[nodiscard]] std::uint32_t Id(std::string_view name) const;
  /// The ids of labels, in ascending order.
  /// @param pointer JSON pointer of the list of names, for messages.
  /// @throws InputError with a fault for each name that the table lacks.
  [[nodiscard]] std::vector<std::uint32_t> Ids(const std::vector<std::string>& names,
                                               const std::string& pointer) const;

 private:
  std::vector<Label> labels_;
};

/// Frame of reference of the output points.
enum class OutputFrame {
  kSensor,   ///< Sensor frame at the time of each firing, as a real sensor reports points.
  kVehicle,  ///< The same points transformed by the mounting.
  kWorld,    ///< Transformed by the pose at the time of each firing, so without motion distortion.
};
template <>
inline constexpr auto kEnumNames<OutputFrame> =
    std::to_array<EnumName<OutputFrame>>({{OutputFrame::kSensor, "sensor"},
                                          {OutputFrame::kVehicle, "vehicle"},
                                          {OutputFrame::kWorld, "world"}});

/// Handedness of the axes of the output points.
enum class Handedness {
  kRight,
  kLeft,  ///< y is negated, as in Unreal Engine.
};
template <>
inline constexpr auto kEnumNames<Handedness> = std::to_array<EnumName<Handedness>>(
    {{Handedness::kRight, "right"}, {Handedness::kLeft, "left"}});

/// The axes in which frames store their points.
struct OutputSpec {
  OutputFrame frame = OutputFrame::kSensor;
  Handedness handedness = Handedness::kRight;
  /// World place subtracted from points in world axes: float32 resolves 1 mm only within 8 km of 0.
  std::array<double, 3> origin_m{0.0, 0.0, 0.0};

  bool operator==(const OutputSpec&) const = default;
};

/// Where the sensor is at a time of a scan.
struct ScanPose {
  std::uint32_t time_ns{};  ///< Since the stamp.
  Transform world_from_sensor = Transform::Identity();
};

/// One complete scan. For every firing it holds what came back, why nothing came back, and the
/// ground truth.
///
/// The frame is a struct of arrays with one element per slot: slot = row * width + column * returns
/// + return_index, where row 0 is the lowest channel and width = columns * returns. Patterns that
/// are not grids have one row. Missing values are NaN.
///
/// x, y, z are in the axes that OutputSpec::frame names; by default in the sensor frame at the time
/// of each firing, which includes the rolling-shutter distortion of a real sensor.
struct Frame {
  std::uint32_t index{};                                    ///< Frame number in the run.
  std::int64_t stamp_ns{};                                  ///< Simulation time of firing 0.
  Transform world_from_sensor = Transform::Identity();      ///< Pose at the stamp.
  Transform world_from_sensor_end = Transform::Identity();  ///< Pose at the last firing.
  /// Poses in between, by time: near enough to one another to be interpolated linearly. Empty where
  /// only the two above are known.
  std::vector<ScanPose> poses_between;
  std::uint32_t duration_ns{};  ///< From the stamp to the last firing.
  std::uint32_t rows{};         ///< Channels.
  std::uint32_t columns{};      ///< Azimuth steps.
  std::uint32_t returns{1};     ///< Slots per firing.
  /// The rotation into the axes of x, y and z from those about whose z the sensor spins; absent if
  /// it spins about their z, as all that is simulated does. Recorded clouds may be in other axes.
  std::optional<Eigen::Matrix3d> sensor_from_spin{};
  /// Whether the sensor measures velocities (VelocitySpec). If not, the two fields of velocity are
  /// empty, and ForEachField() leaves them out.
  bool has_velocity = false;

  // The measurement.
  std::vector<float> x, y, z;  ///< m
  /// Effective reflectance, 1 = white Lambertian at normal incidence; NaN in rung `geometry`.
  std::vector<float> intensity;
  /// Received power / detection threshold; NaN in rung `geometry`.
  std::vector<float> power_ratio;
  std::vector<float> range_m;          ///< Measured range.
  std::vector<std::uint32_t> time_ns;  ///< Since the stamp.
  std::vector<std::uint16_t> ring;     ///< Channel; 0 is the lowest.
  std::vector<std::uint32_t> column;   ///< Azimuth index.
  std::vector<std::uint8_t> return_index;
  std::vector<std::uint8_t> return_count;

  // Ground truth: what the beam hit first, whether or not it was detected.
  std::vector<std::uint32_t> label;  ///< Id in labels.json; 0 = the beam hit nothing.
  /// 0 = background without instances; see SceneObject::instance. A mirror image has that of the
  /// mirrored thing.
  std::vector<std::uint32_t> instance;
  std::vector<Outcome> outcome;
  std::vector<float> true_range_m;   ///< Range to the surface, before noise.
  std::vector<float> incidence_rad;  ///< Between the beam and the surface normal.
  /// Index into the material library; 0 = none. A mirror image has that of the mirrored surface.
  std::vector<std::uint16_t> material;
  /// Share of the beam, 0 to 1, that this echo's surfaces fill; NaN for clutter and single rays.
  std::vector<float> footprint_share;
  /// Share of the beam, 0 to 1, that falls beside the surface taking most of it: on surfaces at
  /// least 0.5 m nearer or farther, or into the sky. Marks mixed pixels. NaN for single rays.
  std::vector<float> mixed_share;

  /// Measured velocity of what sent the echo relative to the sensor, along the beam: positive =
  /// receding. m/s.
  std::vector<float> radial_velocity_mps;
  /// The same without measurement errors, from the exact motions. NaN for false echoes.
  std::vector<float> true_radial_velocity_mps;

  [[nodiscard]] std::uint32_t width() const { return columns * returns; }
  [[nodiscard]] std::size_t num_slots() const { return std::size_t{rows} * width(); }

  /// Sets the shape and resizes every field to num_slots() elements, but those of velocity to none
  /// if has_velocity is false. Reuses the memory if the shape is unchanged.
  void Resize(std::uint32_t new_rows, std::uint32_t new_columns, std::uint32_t new_returns);
};

/// Calls `visit(name, unit, values)` for every per-slot field that the frame has, in the order in
/// which files store them. All file formats, the viewer and the documentation use this one table.
/// `F` is Frame or const Frame.
template <typename F, typename Visitor>
void ForEachField(F& frame, Visitor&& visit) {
  visit("x", "m", frame.x);
  visit("y", "m", frame.y);
  visit("z", "m", frame.z);
  visit("intensity", "", frame.intensity);
  visit("power_ratio", "", frame.power_ratio);
  visit("range_m", "m", frame.range_m);
  visit("time_ns", "ns", frame.time_ns);
  visit("ring", "", frame.ring);
  visit("column", "", frame.column);
  visit("return_index", "", frame.return_index);
  visit("return_count", "", frame.return_count);
  visit("label", "", frame.label);
  visit("instance", "", frame.instance);
  visit("outcome", "", frame.outcome);
  visit("true_range_m", "m", frame.true_range_m);
  visit("incidence_rad", "rad", frame.incidence_rad);
  visit("material", "", frame.material);
  visit("footprint_share", "", frame.footprint_share);
  visit("mixed_share", "", frame.mixed_share);
  if (!frame.has_velocity) return;
  visit("radial_velocity_mps", "m/s", frame.radial_velocity_mps);
  visit("true_radial_velocity_mps", "m/s", frame.true_radial_velocity_mps);
}

/// Calls `visit(name, unit, values)` with every field that a frame may have, and no values.
template <typename Visitor>
void ForEachPossibleField(Visitor&& visit) {
  Frame frame;
  frame.has_velocity = true;
  ForEachField(std::as_const(frame), visit);
}

}  // namespace railcast
