#include "railcast/io/cloud_files.h"

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/io/cloud/cloud.h"
#include "core/io/cloud/track_fields.h"
#include "core/io/field_layout.h"

namespace railcast {
namespace {

bool IsCoordinate(std::string_view name) {
  return name == "x" || name == "y" || name == "z";
}

std::vector<std::size_t> SlotsWithPoint(const Frame& frame) {
  std::vector<std::size_t> slots;
  slots.reserve(frame.num_slots());
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (HasPoint(frame.outcome[slot])) slots.push_back(slot);
  }
  return slots;
}

// Calls `visit(name, values, Stored{})` for every selected field with the type the file stores.
template <typename Visitor>
void ForEachProperty(const SelectedFields& fields, PlyFlavour flavour, Visitor&& visit) {
  fields.ForEach([&](std::string_view name, std::string_view unit, const auto& values) {
    using Stored = typename StoredType<ElementOf<decltype(values)>>::Type;
    if (flavour == PlyFlavour::kPcl || IsCoordinate(name)) {
      visit(std::string(name), values, Stored{});
    } else if constexpr (std::is_floating_point_v<Stored>) {
      visit("scalar_" + std::string(name), values, Stored{});
    } else if (unit == "ns") {
      // Values reach 4.29e9, which exceeds an int but is exact in a double.
      visit("scalar_" + std::string(name), values, double{});
    } else {
      visit("scalar_" + std::string(name), values, std::int32_t{});
    }
  });
}

// The labels and instances come from the user's files and may be large; all other fields are small
// by construction.
void CheckFitsInt(const std::vector<std::uint32_t>& ids, std::string_view name) {
  for (const std::uint32_t id : ids) {
    if (id > std::uint32_t{std::numeric_limits<std::int32_t>::max()}) {
      throw InputError("--format ply-cloudcompare: " + std::string(name) +
                       " must be < 2147483648 (got " + std::to_string(id) + ")");
    }
  }
}

}  // namespace

void EncodePly(const Frame& frame,
               const FieldSelection& fields,
               PlyFlavour flavour,
               std::string& bytes) {
  if (!fields.Has("x") || !fields.Has("y") || !fields.Has("z")) {
    throw InputError("--fields: a PLY file needs x, y and z (got " + fields.Text() + ")");
  }
  if (flavour == PlyFlavour::kCloudCompare) {
    CheckFitsInt(frame.label, "label");
    CheckFitsInt(frame.instance, "instance");
  }
  const SelectedFields selected(frame, fields);
  const std::vector<std::size_t> slots = SlotsWithPoint(frame);
  std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(slots.size()) + "\n";
  std::size_t step = 0;
  ForEachProperty(selected, flavour, [&](const std::string& name, const auto&, auto zero) {
    header.append("property ").append(PlyTypeName(NumberTypeOf<decltype(zero)>()));
    header += " " + name + "\n";
    step += sizeof zero;
  });
  header += "end_header\n";

  bytes.resize(header.size() + slots.size() * step);
  header.copy(bytes.data(), header.size());
  char* place = bytes.data() + header.size();
  ForEachProperty(selected, flavour, [&](const std::string&, const auto& values, auto zero) {
    const auto* from = values.data();
    for (std::size_t i = 0; i < slots.size(); ++i) {
      StoreAt<decltype(zero)>(place + i * step, from[slots[i]]);
    }
    place += sizeof zero;
  });
}

}  // namespace railcast
