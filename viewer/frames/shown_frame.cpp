#include "viewer/frames/shown_frame.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/io/recording/recorded_motion.h"

namespace railcast {
namespace {

template <typename Value>
std::size_t NumBytesOf(const std::vector<Value>& values) {
  return values.capacity() * sizeof(Value);
}

void UndoMotion(const RecordedFrame& recorded, ShownFrame& shown) {
  constexpr std::size_t kGrain = 4096;
  const RecordedMotion motion(recorded, Compensation::kAll);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, shown.num_points(), kGrain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        Eigen::Map<Eigen::Vector3f>(&shown.positions_m[3 * i]) =
                            motion.PointOf(shown.slots[i]);
                      }
                    });
}

using Kind = FieldValues::Kind;

/// A railcast field under the short name that the user gives.
struct ColorField {
  std::string_view name;
  /// Name in railcast/frame.h; for computed values, of the field they need.
  std::string_view field;
  std::string_view title;
  Kind kind{};
  double factor = 1.0;  ///< Converts the frame's unit to the title's.
};

constexpr std::string_view kNoise = "noise";

constexpr auto kColorFields = std::to_array<ColorField>({
    {"label", "label", "label", Kind::kCategory},
    {"instance", "instance", "instance", Kind::kCategory},
    {"outcome", "outcome", "outcome", Kind::kCategory},
    {"range", "range_m", "range [m]", Kind::kAmount},
    {"height", "z", "height [m]", Kind::kAmount},
    {"intensity", "intensity", "intensity", Kind::kAmount},
    {"power", "power_ratio", "power / threshold", Kind::kAmount},
    {"time", "time_ns", "time [ms]", Kind::kAmount, 1e-6},
    {"ring", "ring", "ring", Kind::kAmount},
    {"column", "column", "column", Kind::kAmount},
    {"return", "return_index", "return", Kind::kCategory},
    {"returns", "return_count", "returns of the firing", Kind::kCategory},
    {kNoise, "true_range_m", "measured - true [mm]", Kind::kDifference},
    {"true_range", "true_range_m", "true range [m]", Kind::kAmount},
    {"velocity", "radial_velocity_mps", "velocity along the beam [m/s]", Kind::kDifference},
    {"true_velocity", "true_radial_velocity_mps", "true velocity along the beam [m/s]",
     Kind::kDifference},
    {"incidence", "incidence_rad", "incidence [deg]", Kind::kAmount, 180.0 / std::numbers::pi},
    {"material", "material", "material", Kind::kCategory},
    {"footprint_share", "footprint_share", "share of the beam", Kind::kAmount},
    {"mixed_share", "mixed_share", "mixed share of the beam", Kind::kAmount},
    {"x", "x", "x [m]", Kind::kAmount},
    {"y", "y", "y [m]", Kind::kAmount},
});

const ColorField* FindColorField(std::string_view name) {
  const auto* const found = std::ranges::find(kColorFields, name, &ColorField::name);
  return found == kColorFields.end() ? nullptr : found;
}

/// Returns the name by which a foreign field is chosen: the one in its file, prefixed with "file_"
/// where a railcast field has the same name.
std::string FieldNameOf(const ForeignField& field) {
  std::string name = field.name;
  if (FindColorField(name) != nullptr) name.insert(0, "file_");
  return name;
}

/// Returns the values of the points at `slots`.
template <typename Values>
std::vector<double> ValuesAt(const Values& values, const std::vector<std::uint32_t>& slots) {
  std::vector<double> picked(slots.size());
  std::ranges::transform(slots, picked.begin(),
                         [&](std::uint32_t slot) { return static_cast<double>(values[slot]); });
  return picked;
}

std::vector<double> Noise_mm(const ShownFrame& shown) {
  std::vector<double> noise_mm = ValuesAt(shown.frame().range_m, shown.slots);
  const std::vector<double> true_m = ValuesAt(shown.frame().true_range_m, shown.slots);
  for (std::size_t i = 0; i < noise_mm.size(); ++i) noise_mm[i] = 1e3 * (noise_mm[i] - true_m[i]);
  return noise_mm;
}

/// Returns x, y or z at the stamp, where the points are shown.
std::vector<double> Positions_m(const ShownFrame& shown, std::size_t axis) {
  std::vector<double> values_m(shown.num_points());
  for (std::size_t i = 0; i < values_m.size(); ++i) {
    values_m[i] = static_cast<double>(shown.positions_m[3 * i + axis]);
  }
  return values_m;
}

std::vector<double> Load(const ShownFrame& shown, const ColorField& field) {
  if (field.name == kNoise) return Noise_mm(shown);
  if (field.field.size() == 1) {
    return Positions_m(shown, static_cast<std::size_t>(field.field[0] - 'x'));
  }
  std::vector<double> loaded;
  ForEachField(shown.frame(), [&](std::string_view name, std::string_view, const auto& values) {
    if (name == field.field) loaded = ValuesAt(values, shown.slots);
  });
  for (double& value : loaded) value *= field.factor;
  return loaded;
}

}  // namespace

std::size_t NumBytesOf(const ShownFrame& shown) {
  const RecordedFrame& recorded = *shown.recorded;
  std::size_t num_bytes = sizeof(ShownFrame) + sizeof(RecordedFrame) +
                          NumBytesOf(shown.positions_m) + NumBytesOf(shown.slots) +
                          NumBytesOf(recorded.objects);
  ForEachField(recorded.frame, [&](std::string_view, std::string_view, const auto& values) {
    num_bytes += NumBytesOf(values);
  });
  for (const ForeignField& field : recorded.foreign) num_bytes += NumBytesOf(field.values);
  return num_bytes;
}

void FrameShelf::Put(std::size_t place, std::shared_ptr<const ShownFrame> shown) {
  num_bytes_ += NumBytesOf(*shown);
  frames_.emplace_front(place, std::move(shown));
  while (frames_.size() > 1 &&
         (frames_.size() > limits_.num_frames || num_bytes_ > limits_.num_bytes)) {
    num_bytes_ -= NumBytesOf(*frames_.back().second);
    frames_.pop_back();
  }
}

std::shared_ptr<const ShownFrame> FrameShelf::Find(std::size_t place) const {
  const auto found = std::ranges::find(frames_, place, [](const auto& kept) { return kept.first; });
  return found == frames_.end() ? nullptr : found->second;
}

std::shared_ptr<const ShownFrame> FrameShelf::Use(std::size_t place) {
  const auto found = std::ranges::find(frames_, place, [](const auto& kept) { return kept.first; });
  if (found == frames_.end()) return nullptr;
  frames_.splice(frames_.begin(), frames_, found);
  return found->second;
}

ShownFrame MakeShownFrame(RecordedFrame recorded) {
  ShownFrame shown;
  const Frame& frame = recorded.frame;
  // Many frames are kept, so the vectors are made without spare capacity.
  const auto num_points = static_cast<std::size_t>(
      std::ranges::count_if(frame.x, [](float x_m) { return !std::isnan(x_m); }));
  shown.positions_m.reserve(3 * num_points);
  shown.slots.reserve(num_points);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (std::isnan(frame.x[slot])) continue;
    shown.positions_m.insert(shown.positions_m.end(),
                             {frame.x[slot], frame.y[slot], frame.z[slot]});
    shown.slots.push_back(static_cast<std::uint32_t>(slot));
  }
  if (KnowsMotion(recorded)) UndoMotion(recorded, shown);
  shown.recorded = std::make_shared<const RecordedFrame>(std::move(recorded));
  return shown;
}

std::vector<std::string> ColorableFields(const RecordedFrame& recorded) {
  std::vector<std::string> names;
  for (const ColorField& field : kColorFields) {
    if (field.name == kNoise && !recorded.Has("range_m")) continue;
    if (field.field.size() == 1 || recorded.Has(field.field)) names.emplace_back(field.name);
  }
  for (const ForeignField& field : recorded.foreign) names.push_back(FieldNameOf(field));
  return names;
}

FieldValues ValuesOf(const ShownFrame& shown, const std::string& name) {
  const std::vector<std::string> colorable = ColorableFields(*shown.recorded);
  if (std::ranges::find(colorable, name) == colorable.end()) {
    throw InputError("has no field " + name + " to color by (has: " + Join(colorable) + ")");
  }
  if (const ColorField* const field = FindColorField(name)) {
    return {.kind = field->kind, .title = std::string(field->title), .values = Load(shown, *field)};
  }
  const auto foreign = std::ranges::find(shown.recorded->foreign, name, FieldNameOf);
  return {.kind = Kind::kAmount, .title = name, .values = ValuesAt(foreign->values, shown.slots)};
}

std::string DefaultColorField(const RecordedFrame& recorded) {
  return recorded.Has("label") ? "label" : "height";
}

}  // namespace railcast
