#include "core/io/recording/cloud_fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/median.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/io/field_layout.h"

namespace railcast {
namespace {

constexpr double kStep_m = 1e3;

/// Calls `visit(slot, stored value)` for every point of the frame.
template <typename Visitor>
void VisitPoints(const Cloud& cloud,
                 const CloudField& column,
                 const SlotPlan& plan,
                 const Frame& frame,
                 Visitor&& visit) {
  VisitField(cloud, column, [&](std::size_t i, auto value) {
    const std::uint32_t slot = plan.slots.empty() ? static_cast<std::uint32_t>(i) : plan.slots[i];
    if (slot != kNoSlot && !std::isnan(frame.range_m[slot])) {
      visit(slot, static_cast<double>(value));
    }
  });
}

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// A name that other software gives to one of our fields with the same meaning.
struct Alias {
  std::string_view ours;
  std::string_view theirs;
};
constexpr std::array<Alias, 9> kAliases = {{
    {"intensity", "reflectivity"},
    {"intensity", "remission"},
    {"ring", "channel"},
    {"ring", "laser"},
    {"ring", "line"},
    // Aeva's sensors, as their recordings and Nebula name them.
    {"radial_velocity_mps", "velocity"},
    {"radial_velocity_mps", "range_rate"},
    {"time_ns", "time_offset_ns"},
    {"ring", "line_index"},
}};

/// Columns that are not kept: colours, whose packed numbers mean nothing.
constexpr std::array<std::string_view, 6> kUnwanted = {"rgb",   "rgba", "red",
                                                       "green", "blue", "alpha"};

// Limits memory: a damaged or hostile header may name thousands of fields, each of which would be
// stored for all slots.
constexpr std::size_t kMaxForeign = 64;

[[noreturn]] void FailValue(const std::string& name,
                            const std::string& field,
                            std::uint64_t limit,
                            double got) {
  throw InputError(name + ": " + field + ": must be a whole number from 0 to " + NumberText(limit) +
                   " (got " + NumberText(got) + ")");
}

/// Returns the value as a whole number up to `limit`, or nothing if it is not one.
template <typename Value>
std::optional<std::uint64_t> WholeNumber(Value value, std::uint64_t limit) {
  if constexpr (std::is_floating_point_v<Value>) {
    // NaN fails the first comparison; 2^53 exceeds every limit.
    if (!(value >= Value{0}) || value > Value{0x1p53} || value != std::floor(value)) {
      return std::nullopt;
    }
  } else if constexpr (std::is_signed_v<Value>) {
    if (value < Value{0}) return std::nullopt;
  }
  // The value is not negative here, whatever its type.
  const auto whole = static_cast<std::uint64_t>(
      static_cast<std::conditional_t<std::is_same_v<Value, std::int8_t>, std::uint8_t, Value>>(
          value));
  return whole <= limit ? std::optional(whole) : std::nullopt;
}

template <typename Field>
constexpr std::uint64_t LimitOf() {
  if constexpr (std::is_same_v<Field, Outcome>) {
    return kOutcomeNames.size() - 1;
  } else {
    return std::numeric_limits<Field>::max();
  }
}

// A value of the field's own type needs no check; that is the case in most files, which railcast
// wrote.
template <typename Field, typename Value>
Field Convert(Value value, const CloudField& column, const std::string& name) {
  if constexpr (std::is_same_v<Field, Value> || std::is_same_v<Field, float>) {
    return static_cast<Field>(value);
  } else {
    const auto whole = WholeNumber(value, LimitOf<Field>());
    if (!whole) FailValue(name, column.name, LimitOf<Field>(), static_cast<double>(value));
    return static_cast<Field>(*whole);
  }
}

template <typename Field>
void CopyColumn(const Cloud& cloud,
                const CloudField& column,
                const SlotPlan& plan,
                const std::string& name,
                std::vector<Field>& values) {
  Field* const out = values.data();
  const std::uint32_t* const slots = plan.slots.empty() ? nullptr : plan.slots.data();
  if (slots == nullptr) {
    VisitField(cloud, column,
               [&](std::size_t i, auto value) { out[i] = Convert<Field>(value, column, name); });
    return;
  }
  VisitField(cloud, column, [&](std::size_t i, auto value) {
    if (slots[i] != kNoSlot) out[slots[i]] = Convert<Field>(value, column, name);
  });
}

template <typename Values>
void FillAbsent(Values& values) {
  using Value = ElementOf<Values>;
  std::ranges::fill(values, std::is_same_v<Value, float> ? static_cast<Value>(kNaN) : Value{});
}

// Whether a field is an index, which in a grid is computed from the slot.
bool IsIndex(std::string_view name) {
  return name == "ring" || name == "column" || name == "return_index" || name == "return_count";
}

void MarkEmptySlots(Frame& frame, bool has_range) {
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    const float x = frame.x[i];
    const float y = frame.y[i];
    const float z = frame.z[i];
    const float range_m = std::sqrt(x * x + y * y + z * z);
    if (std::isfinite(range_m) && range_m > 0.0F) {
      if (!has_range || !std::isfinite(frame.range_m[i])) frame.range_m[i] = range_m;
    } else {
      frame.x[i] = frame.y[i] = frame.z[i] = frame.range_m[i] = kNaN;
    }
  }
}

/// Returns the columns that hold our fields.
std::vector<const CloudField*> OwnColumns(const Cloud& cloud, const Frame& frame) {
  std::vector<const CloudField*> own;
  ForEachField(frame, [&](std::string_view name, std::string_view, const auto&) {
    own.push_back(FindFieldOf(cloud, name));
  });
  return own;
}

/// Copies the columns that hold no field of ours.
/// @pre Slots without a point are marked.
void FillForeign(const Cloud& cloud, const SlotPlan& plan, RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  const std::vector<const CloudField*> own = OwnColumns(cloud, frame);
  Remark left_out{.kind = RemarkKind::kFieldsLeftOut, .place = recorded.name, .number = 0};
  for (const CloudField& column : cloud.fields) {
    const std::string_view name = column.plain_name();
    if (name == kPaddingField) continue;
    const bool is_own = std::ranges::find(own, &column) != own.end();
    const bool is_wanted = recorded.foreign.size() < kMaxForeign && cloud.Find(name) == &column &&
                           std::ranges::find(kUnwanted, name) == kUnwanted.end();
    if ((!is_own && !is_wanted) || column.count > 1) {
      constexpr std::size_t kMostNamed = 5;
      if (left_out.number < kMostNamed) {
        left_out.detail.append(left_out.detail.empty() ? "" : ", ").append(ShownText(column.name));
        if (is_own || is_wanted) left_out.detail += " but for its first number";
      }
      ++left_out.number;
    }
    if (is_own || !is_wanted) continue;
    std::vector<float> values(frame.num_slots(), kNaN);
    CopyColumn(cloud, column, plan, recorded.name, values);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::isnan(frame.x[i])) values[i] = kNaN;
    }
    // Programs and Python have names of UTF-8.
    recorded.foreign.push_back({ShownLines(name), std::move(values)});
  }
  AddRemark(left_out, recorded.remarks);
}

/// Says that positions far from 0 are stored in single precision.
void RemarkRounded(const std::array<const CloudField*, 3>& columns,
                   const Vector3& middle_m,
                   RecordedFrame& recorded) {
  double step_m = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (columns.at(axis)->type != NumberType::kFloat) continue;
    const auto at_m = static_cast<float>(std::abs(middle_m[static_cast<Eigen::Index>(axis)]));
    const float next_m = std::nextafter(at_m, std::numeric_limits<float>::infinity());
    if (double{at_m} > kFarPosition_m) step_m = std::max(step_m, double{next_m - at_m});
  }
  if (step_m == 0.0) return;
  const auto num = std::ranges::count_if(recorded.frame.range_m,
                                         [](float range_m) { return !std::isnan(range_m); });
  AddRemark({.kind = RemarkKind::kPositionsRounded,
             .place = recorded.name,
             .number = static_cast<std::uint64_t>(num),
             .detail = "in steps of " + ShortText(step_m) + " m"},
            recorded.remarks);
}

}  // namespace

void FillGridIndices(Frame& frame) {
  std::size_t slot = 0;
  for (std::uint32_t row = 0; row < frame.rows; ++row) {
    for (std::uint32_t column = 0; column < frame.columns; ++column) {
      std::uint8_t count = 0;
      for (std::uint32_t r = 0; r < frame.returns; ++r) count += !std::isnan(frame.x[slot + r]);
      for (std::uint32_t r = 0; r < frame.returns; ++r, ++slot) {
        frame.ring[slot] = static_cast<std::uint16_t>(row);
        frame.column[slot] = column;
        frame.return_index[slot] = static_cast<std::uint8_t>(r);
        frame.return_count[slot] = count;
      }
    }
  }
}

void TakeFromNearOrigin(const Cloud& cloud, const SlotPlan& plan, RecordedFrame& recorded) {
  Frame& frame = recorded.frame;
  const bool is_near = std::ranges::none_of(
      frame.range_m, [](float range_m) { return double{range_m} > kFarPosition_m; });
  if (is_near) return;
  const std::array<const CloudField*, 3> columns = {
      FindFieldOf(cloud, "x"), FindFieldOf(cloud, "y"), FindFieldOf(cloud, "z")};
  const bool is_double = std::ranges::any_of(
      columns, [](const CloudField* column) { return column->type == NumberType::kDouble; });
  Vector3 middle_m = Vector3::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> values_m;
    VisitPoints(cloud, *columns.at(static_cast<std::size_t>(axis)), plan, frame,
                [&](std::uint32_t, double value_m) { values_m.push_back(value_m); });
    if (values_m.empty()) return;
    middle_m[axis] = MedianOf(values_m);
  }
  if (!(middle_m.norm() > kFarPosition_m)) return;
  RemarkRounded(columns, middle_m, recorded);
  if (!is_double) return;
  recorded.origin_m = kStep_m * (middle_m / kStep_m).array().round().matrix();
  const std::array<std::vector<float>*, 3> positions_m = {&frame.x, &frame.y, &frame.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double origin_m = recorded.origin_m[static_cast<Eigen::Index>(axis)];
    VisitPoints(cloud, *columns.at(axis), plan, frame, [&](std::uint32_t slot, double value_m) {
      (*positions_m.at(axis))[slot] = static_cast<float>(value_m - origin_m);
    });
  }
}

void RemarkRoundedValues(const Cloud& cloud, const SlotPlan& plan, RecordedFrame& recorded) {
  for (const ForeignField& field : recorded.foreign) {
    const auto found = std::ranges::find_if(cloud.fields, [&](const CloudField& column) {
      return ShownLines(column.plain_name()) == field.name;
    });
    if (found == cloud.fields.end()) continue;
    const CloudField& column = *found;
    if (SizeOf(column.type) < sizeof(float) || column.type == NumberType::kFloat) continue;
    double largest = 0.0;
    std::uint64_t num = 0;
    VisitPoints(cloud, column, plan, recorded.frame, [&](std::uint32_t, double value) {
      constexpr double kAllWholeNumbers = 0x1p24;
      const double size = std::abs(value);
      if (!(size > kAllWholeNumbers) || std::isinf(value)) return;
      if (double{static_cast<float>(value)} != value) ++num;
      largest = std::max(largest, size);
    });
    if (num == 0) continue;
    const auto stored = static_cast<float>(largest);
    const float next = std::nextafter(stored, std::numeric_limits<float>::infinity());
    AddRemark(
        {.kind = RemarkKind::kValuesRounded,
         .place = recorded.name,
         .number = num,
         .detail = ShownText(field.name) + " in steps of " + ShortText(double{next - stored})},
        recorded.remarks);
  }
}

const CloudField* FindFieldOf(const Cloud& cloud, std::string_view name) {
  if (const CloudField* const own = cloud.Find(name)) return own;
  for (const Alias& alias : kAliases) {
    if (alias.ours != name) continue;
    if (const CloudField* const theirs = cloud.Find(alias.theirs)) return theirs;
  }
  const auto in_capitals = std::ranges::find_if(cloud.fields, [&](const CloudField& field) {
    const std::string lower = LowerCase(field.plain_name());
    return lower == name || std::ranges::any_of(kAliases, [&](const Alias& alias) {
             return alias.ours == name && alias.theirs == lower;
           });
  });
  return in_capitals == cloud.fields.end() ? nullptr : &*in_capitals;
}

const CloudField& NeedFieldOf(const Cloud& cloud, std::string_view field, const std::string& name) {
  const CloudField* const column = FindFieldOf(cloud, field);
  if (column != nullptr) return *column;
  throw InputError(name + ": has no field " + std::string(field));
}

std::vector<std::uint32_t> LoadIndices(const Cloud& cloud,
                                       const CloudField& column,
                                       std::uint32_t limit,
                                       const std::string& name) {
  std::vector<std::uint32_t> indices(cloud.num_points());
  VisitField(cloud, column, [&](std::size_t i, auto value) {
    const auto whole = WholeNumber(value, limit);
    if (!whole) FailValue(name, column.name, limit, static_cast<double>(value));
    indices[i] = static_cast<std::uint32_t>(*whole);
  });
  return indices;
}

void FillFrame(const Cloud& cloud, const SlotPlan& plan, RecordedFrame& recorded) {
  for (const char* axis : {"x", "y", "z"}) (void)NeedFieldOf(cloud, axis, recorded.name);
  for (const Remark& remark : cloud.remarks) AddRemark(remark, recorded.remarks);
  Frame& frame = recorded.frame;
  frame.has_velocity = FindFieldOf(cloud, "radial_velocity_mps") != nullptr ||
                       FindFieldOf(cloud, "true_radial_velocity_mps") != nullptr;
  frame.Resize(plan.rows, plan.columns, plan.returns);
  frame.sensor_from_spin = plan.sensor_from_spin;
  recorded.is_grid = plan.is_grid;
  recorded.why_no_grid = plan.why_no_grid;
  recorded.slot_of_entry = plan.slots;
  if (plan.slots.empty()) {
    recorded.slot_of_entry.resize(cloud.num_points());
    std::iota(recorded.slot_of_entry.begin(), recorded.slot_of_entry.end(), 0U);
  }
  ForEachField(frame, [&](std::string_view name, std::string_view, auto& values) {
    if (plan.is_grid && IsIndex(name)) return;
    const CloudField* const column = FindFieldOf(cloud, name);
    // The plan may leave slots without a point, and these keep the absent value.
    if (column == nullptr || !plan.slots.empty()) FillAbsent(values);
    if (column == nullptr) return;
    try {
      CopyColumn(cloud, *column, plan, recorded.name, values);
      recorded.fields.emplace(name);
    } catch (const InputError& error) {
      FillAbsent(values);
      AddRemark({.kind = RemarkKind::kFieldsLeftOut,
                 .place = recorded.name,
                 .detail = std::string(error.what()).substr(recorded.name.size() + 2)},
                recorded.remarks);
    }
  });
  MarkEmptySlots(frame, recorded.Has("range_m"));
  recorded.fields.emplace("range_m");
  TakeFromNearOrigin(cloud, plan, recorded);
  FillForeign(cloud, plan, recorded);
  if (!plan.is_grid) return;
  FillGridIndices(frame);
  recorded.fields.insert({"ring", "column", "return_index", "return_count"});
}

}  // namespace railcast
