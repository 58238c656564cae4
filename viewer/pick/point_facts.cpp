#include "viewer/pick/picks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "core/base/units.h"
#include "railcast/outcome.h"

namespace railcast {
namespace {

constexpr std::size_t kNameWidth = 17;
constexpr std::size_t kMaxWidth = 60;
// Width of one coordinate: 5300000.123 and a space.
constexpr std::size_t kCoordinateWidth = 12;
constexpr double kMmPerM = 1e3;

std::string CoordinatesText(const Vector3& point_m) {
  std::string text;
  for (const double coordinate_m : point_m) {
    const std::string number = FixedText(coordinate_m, 3);
    text.append(kCoordinateWidth - std::min(kCoordinateWidth, number.size()), ' ').append(number);
  }
  return text + " m";
}

// Six digits, as in the effect trace.
std::string ValueText(float value) {
  if (std::isnan(value)) return "-";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", static_cast<double>(value));
  return text.data();
}

std::string QuantityText(double value, int num_decimals, const std::string& unit) {
  std::string text = FixedText(value, num_decimals);
  return std::isnan(value) ? text : text + " " + unit;
}

std::string NamedText(std::string name, std::uint32_t number) {
  const std::string digits = std::to_string(number);
  return name.empty() ? digits : name.append(" (").append(digits).append(")");
}

// Returns a file's name without its folders; a long name keeps its end, which tells frames apart.
std::string FileText(const std::string& name) {
  constexpr std::size_t kRoom = kMaxWidth - kNameWidth;
  std::string file = name.substr(name.find_last_of('/') + 1);
  if (file.size() <= kRoom) return file;
  return std::string("...").append(file, file.size() - (kRoom - 3));
}

/// The lines about one slot of a frame.
class Facts {
 public:
  Facts(const RecordedFrame& recorded, const RecordingInfo& info, std::uint32_t slot)
      : recorded_(recorded), frame_(recorded.frame), info_(info), slot_(slot) {}

  void Add(std::string name, const std::string& value) {
    // Foreign names may be longer than the column.
    name.resize(std::max(kNameWidth, name.size() + 1), ' ');
    lines_.push_back(name.append(value));
  }

  /// Adds the line if the recording has the field.
  template <typename Text>
  void AddField(std::string_view field, const std::string& name, Text&& text) {
    if (recorded_.Has(field)) Add(name, text());
  }

  void AddMeasurement() {
    AddField("range_m", "range", [&] { return QuantityText(At(frame_.range_m), 4, "m"); });
    AddField("intensity", "intensity", [&] { return ValueText(frame_.intensity[slot_]); });
    AddField("power_ratio", "power ratio", [&] { return ValueText(frame_.power_ratio[slot_]); });
    AddField("radial_velocity_mps", "velocity",
             [&] { return QuantityText(At(frame_.radial_velocity_mps), 2, "m/s"); });
    AddField("time_ns", "time",
             [&] { return QuantityText(frame_.time_ns[slot_] / double{kNsPerUs}, 3, "us"); });
    AddField("ring", "ring", [&] { return std::to_string(frame_.ring[slot_]); });
    AddField("column", "column", [&] { return std::to_string(frame_.column[slot_]); });
    AddField("return_index", "return index",
             [&] { return std::to_string(frame_.return_index[slot_]); });
    AddField("return_count", "return count",
             [&] { return std::to_string(frame_.return_count[slot_]); });
    for (const ForeignField& field : recorded_.foreign) {
      Add(field.name, ValueText(field.values[slot_]));
    }
  }

  void AddTruth() {
    const std::size_t num_measured = lines_.size();
    lines_.emplace_back("truth");
    AddField("label", "label", [&] { return NamedText(LabelName(), frame_.label[slot_]); });
    AddField("instance", "instance",
             [&] { return NamedText(ObjectName(), frame_.instance[slot_]); });
    AddField("material", "material",
             [&] { return NamedText(MaterialName(), frame_.material[slot_]); });
    AddField("outcome", "outcome", [&] { return std::string(OutcomeName(frame_.outcome[slot_])); });
    AddField("true_range_m", "true range",
             [&] { return QuantityText(At(frame_.true_range_m), 4, "m"); });
    AddField("true_range_m", "noise", [&] { return NoiseText(); });
    AddField("incidence_rad", "incidence",
             [&] { return QuantityText(DegFromRad(At(frame_.incidence_rad)), 2, "deg"); });
    AddField("footprint_share", "footprint share",
             [&] { return FixedText(At(frame_.footprint_share), 3); });
    AddField("mixed_share", "mixed share", [&] { return FixedText(At(frame_.mixed_share), 3); });
    AddField("true_radial_velocity_mps", "true velocity",
             [&] { return QuantityText(At(frame_.true_radial_velocity_mps), 2, "m/s"); });
    if (lines_.size() == num_measured + 1) lines_.pop_back();
  }

  [[nodiscard]] std::vector<std::string> TakeLines() { return std::move(lines_); }

 private:
  [[nodiscard]] double At(const std::vector<float>& values) const {
    return static_cast<double>(values[slot_]);
  }
  [[nodiscard]] std::string LabelName() const {
    const Label* const label = info_.labels.Find(frame_.label[slot_]);
    return label == nullptr ? std::string() : label->name;
  }
  [[nodiscard]] std::string ObjectName() const {
    const std::uint32_t instance = frame_.instance[slot_];
    const auto object = std::ranges::find(recorded_.objects, instance, &RecordedObject::instance);
    return instance == 0 || object == recorded_.objects.end() ? std::string() : object->name;
  }
  [[nodiscard]] std::string MaterialName() const {
    const std::uint16_t material = frame_.material[slot_];
    return material < info_.materials.size() ? info_.materials[material] : std::string();
  }
  [[nodiscard]] std::string NoiseText() const {
    const double noise_mm = kMmPerM * (At(frame_.range_m) - At(frame_.true_range_m));
    const std::string text = QuantityText(noise_mm, 1, "mm");
    const bool has_sign = text.front() == '-' || std::isnan(noise_mm);
    return std::string(has_sign ? "" : "+").append(text);
  }

  const RecordedFrame& recorded_;
  const Frame& frame_;
  const RecordingInfo& info_;
  std::uint32_t slot_;
  std::vector<std::string> lines_;
};

}  // namespace

std::vector<std::string> PointFacts(const ShownFrame& shown,
                                    const RecordingInfo& info,
                                    std::size_t point) {
  const RecordedFrame& recorded = *shown.recorded;
  const Frame& frame = recorded.frame;
  const std::uint32_t slot = shown.slots[point];
  const float* const at_stamp_m = shown.positions_m.data() + 3 * point;
  const Vector3 stamp_m = Eigen::Map<const Eigen::Vector3f>(at_stamp_m).cast<double>();
  const Vector3 firing_m =
      Eigen::Vector3f(frame.x[slot], frame.y[slot], frame.z[slot]).cast<double>();

  Facts facts(recorded, info, slot);
  facts.Add("file", FileText(recorded.name));
  facts.Add("frame", std::to_string(frame.index));
  facts.Add("slot", std::to_string(slot));
  const std::string position = CoordinatesText(firing_m + recorded.origin_m);
  facts.Add("position", position);
  const std::string stamp_position = CoordinatesText(stamp_m + recorded.origin_m);
  if (stamp_position != position) facts.Add("at the stamp", stamp_position);
  if (recorded.has_pose) {
    facts.Add("in the world",
              CoordinatesText(frame.world_from_sensor * (stamp_m + recorded.origin_m)));
  }
  facts.AddMeasurement();
  facts.AddTruth();
  return facts.TakeLines();
}

}  // namespace railcast
