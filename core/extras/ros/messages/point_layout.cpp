#include "core/extras/ros/messages/point_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/io/cloud/woven_cloud.h"
#include "core/io/field_layout.h"

namespace railcast::ros {
namespace {

/// A slot of a frame, of which a point is stored.
struct PointSource {
  const Frame& frame;
  std::size_t slot{};
  std::uint16_t channel{};  ///< The vendor's number.

  [[nodiscard]] std::int64_t time_ns() const { return frame.stamp_ns + frame.time_ns[slot]; }
  [[nodiscard]] bool has_point() const { return HasPoint(frame.outcome[slot]); }
  /// 0 to 255, as the vendors' calibrated sensors count it; 0 without a point.
  [[nodiscard]] float reflectivity() const {
    return has_point() ? ReflectivityByte(frame.intensity[slot]) : 0.0F;
  }
};

/// A field of a vendor's points.
struct LayoutField {
  std::string_view name;
  std::uint32_t offset{};
  std::uint8_t datatype{};
  void (*store)(const PointSource& point, char* place){};
};

template <auto kMember>
void StoreMember(const PointSource& point, char* place) {
  StoreAt<float>(place, (point.frame.*kMember)[point.slot]);
}
constexpr LayoutField kX = {"x", 0, PointField::kFloat32, &StoreMember<&Frame::x>};
constexpr LayoutField kY = {"y", 4, PointField::kFloat32, &StoreMember<&Frame::y>};
constexpr LayoutField kZ = {"z", 8, PointField::kFloat32, &StoreMember<&Frame::z>};

void StoreReflectivity(const PointSource& point, char* place) {
  StoreAt<float>(place, point.reflectivity());
}
void StoreChannel(const PointSource& point, char* place) {
  StoreAt<std::uint16_t>(place, point.channel);
}

constexpr auto kVelodyneFields = std::to_array<LayoutField>({
    kX,
    kY,
    kZ,
    {"intensity", 12, PointField::kFloat32,
     [](const PointSource& point, char* place) {
       StoreAt<float>(place, point.has_point() ? point.reflectivity()
                                               : std::numeric_limits<float>::quiet_NaN());
     }},
    {"ring", 16, PointField::kUint16, &StoreChannel},
    {"time", 18, PointField::kFloat32,
     [](const PointSource& point, char* place) {
       StoreAt<float>(place, SecondsFromNs(point.frame.time_ns[point.slot]));
     }},
});

constexpr auto kOusterFields = std::to_array<LayoutField>({
    kX,
    kY,
    kZ,
    // Ouster's count of signal photons has no scale that a simulation could know; this is the
    // received power over the detection threshold.
    {"intensity", 16, PointField::kFloat32,
     [](const PointSource& point, char* place) {
       const float ratio = point.frame.power_ratio[point.slot];
       StoreAt<float>(place, point.has_point() && !std::isnan(ratio) ? ratio : 0.0F);
     }},
    {"t", 20, PointField::kUint32,
     [](const PointSource& point, char* place) {
       StoreAt<std::uint32_t>(place, point.frame.time_ns[point.slot]);
     }},
    {"reflectivity", 24, PointField::kUint16,
     [](const PointSource& point, char* place) {
       StoreAt<std::uint16_t>(place, point.reflectivity());
     }},
    {"ring", 26, PointField::kUint16, &StoreChannel},
    {"ambient", 28, PointField::kUint16,
     [](const PointSource&, char* place) { StoreAt<std::uint16_t>(place, 0); }},
    {"range", 32, PointField::kUint32,
     [](const PointSource& point, char* place) {
       const float range_m = point.frame.range_m[point.slot];
       StoreAt<std::uint32_t>(place, point.has_point() ? std::lround(range_m * 1e3F) : 0);
     }},
});

constexpr auto kHesaiFields = std::to_array<LayoutField>({
    kX,
    kY,
    kZ,
    {"intensity", 12, PointField::kFloat32, &StoreReflectivity},
    {"ring", 16, PointField::kUint16, &StoreChannel},
    {"timestamp", 18, PointField::kFloat64,
     [](const PointSource& point, char* place) {
       StoreAt<double>(place, SecondsFromNs(point.time_ns()));
     }},
});

constexpr auto kLivoxFields = std::to_array<LayoutField>({
    kX,
    kY,
    kZ,
    {"intensity", 12, PointField::kFloat32, &StoreReflectivity},
    {"tag", 16, PointField::kUint8,
     [](const PointSource&, char* place) { StoreAt<std::uint8_t>(place, 0); }},
    {"line", 17, PointField::kUint8,
     [](const PointSource& point, char* place) { StoreAt<std::uint8_t>(place, point.channel); }},
    {"timestamp", 18, PointField::kFloat64,
     [](const PointSource& point, char* place) { StoreAt<double>(place, point.time_ns()); }},
});

// Autoware's PointXYZIRCAEDT. Its return types are those of Nebula: 3 strongest, 1 last, 2 first;
// 0, unknown, where a firing has one return, since a frame does not say which.
constexpr auto kAutowareFields = std::to_array<LayoutField>({
    kX,
    kY,
    kZ,
    {"intensity", 12, PointField::kUint8,
     [](const PointSource& point, char* place) {
       StoreAt<std::uint8_t>(place, static_cast<std::uint8_t>(std::lround(point.reflectivity())));
     }},
    {"return_type", 13, PointField::kUint8,
     [](const PointSource& point, char* place) {
       constexpr std::array<std::uint8_t, 3> kTypes = {3, 1, 2};
       StoreAt<std::uint8_t>(
           place, point.frame.returns == 1 ? 0 : kTypes.at(point.slot % point.frame.returns));
     }},
    {"channel", 14, PointField::kUint16, &StoreChannel},
    {"azimuth", 16, PointField::kFloat32,
     [](const PointSource& point, char* place) {
       StoreAt<float>(place, std::atan2(point.frame.y[point.slot], point.frame.x[point.slot]));
     }},
    {"elevation", 20, PointField::kFloat32,
     [](const PointSource& point, char* place) {
       StoreAt<float>(place,
                      std::atan2(point.frame.z[point.slot],
                                 std::hypot(point.frame.x[point.slot], point.frame.y[point.slot])));
     }},
    {"distance", 24, PointField::kFloat32, &StoreMember<&Frame::range_m>},
    {"time_stamp", 28, PointField::kUint32,
     [](const PointSource& point, char* place) {
       StoreAt<std::uint32_t>(place, point.frame.time_ns[point.slot]);
     }},
});

constexpr const char* kNeedsVelocity = "--fields aeva: needs a sensor with lidar.velocity";

constexpr auto kAevaFields = std::to_array<LayoutField>({
    kX,
    kY,
    kZ,
    {"reflectivity", 12, PointField::kFloat32, &StoreReflectivity},
    {"velocity", 16, PointField::kFloat32, &StoreMember<&Frame::radial_velocity_mps>},
    {"time_offset_ns", 20, PointField::kUint32,
     [](const PointSource& point, char* place) {
       StoreAt<std::uint32_t>(place, point.frame.time_ns[point.slot]);
     }},
    {"line_index", 24, PointField::kUint8,
     [](const PointSource& point, char* place) { StoreAt<std::uint8_t>(place, point.channel); }},
});
// Lines have 8 bits.
constexpr std::uint32_t kMostLines = 256;

/// A cloud of slots of a frame, in the order in which a vendor's driver sends them.
struct SlotCloud {
  std::uint32_t height{};
  std::uint32_t width{};
  std::vector<std::size_t> slots;
  bool is_dense{};
};

SlotCloud PointsOnly(const Frame& frame, bool is_dense) {
  SlotCloud cloud{1, 0, {}, is_dense};
  // In the order of the firings' columns, as a sensor reports them.
  for (std::uint32_t i = 0; i < frame.width(); ++i) {
    for (std::uint32_t row = 0; row < frame.rows; ++row) {
      const std::size_t slot = std::size_t{row} * frame.width() + i;
      if (HasPoint(frame.outcome[slot])) cloud.slots.push_back(slot);
    }
  }
  cloud.width = static_cast<std::uint32_t>(cloud.slots.size());
  return cloud;
}

// A row for each column of the frame and each of its returns.
SlotCloud RowsOfColumns(const Frame& frame) {
  SlotCloud cloud{frame.width(), frame.rows, {}, false};
  for (std::uint32_t i = 0; i < frame.width(); ++i) {
    for (std::uint32_t row = 0; row < frame.rows; ++row) {
      cloud.slots.push_back(std::size_t{row} * frame.width() + i);
    }
  }
  return cloud;
}

// The channels from the highest down, of one of the returns.
SlotCloud RowsFromAbove(const Frame& frame, std::uint32_t return_index) {
  SlotCloud cloud{frame.rows, frame.columns, {}, true};
  for (std::uint32_t row = frame.rows; row-- > 0;) {
    for (std::uint32_t column = 0; column < frame.columns; ++column) {
      const std::size_t slot =
          std::size_t{row} * frame.width() + std::size_t{column} * frame.returns + return_index;
      cloud.slots.push_back(slot);
      cloud.is_dense = cloud.is_dense && HasPoint(frame.outcome[slot]);
    }
  }
  return cloud;
}

/// A vendor's layout.
struct VendorLayout {
  std::span<const LayoutField> fields;
  std::uint32_t point_step{};
  SlotCloud cloud;
};

VendorLayout LayoutOf(PointLayout layout, const Frame& frame, std::uint32_t cloud) {
  switch (layout) {
    case PointLayout::kVelodyne:
      return {kVelodyneFields, 22, RowsOfColumns(frame)};
    case PointLayout::kOuster:
      return {kOusterFields, 48, RowsFromAbove(frame, cloud)};
    case PointLayout::kHesai:
      return {kHesaiFields, 26, PointsOnly(frame, false)};
    case PointLayout::kLivox:
      return {kLivoxFields, 26, PointsOnly(frame, true)};
    case PointLayout::kAeva:
      return {kAevaFields, 25, PointsOnly(frame, true)};
    case PointLayout::kAutoware:
      return {kAutowareFields, 32, PointsOnly(frame, true)};
    case PointLayout::kRailcast:
      break;
  }
  Check(false, "a vendor's layout");
  return {};
}

// The vendors' numbers of the channels in a frame's rows, of which 0 is the lowest.
std::vector<std::uint16_t> ChannelsInRows(PointLayout layout,
                                          std::uint32_t rows,
                                          const std::vector<std::uint16_t>& channel_of_row) {
  const bool has_own = layout == PointLayout::kHesai || layout == PointLayout::kAutoware;
  if (has_own && channel_of_row.size() == rows) return channel_of_row;
  std::vector<std::uint16_t> channels(rows);
  for (std::uint32_t row = 0; row < rows; ++row) {
    const bool is_from_above = layout == PointLayout::kOuster || layout == PointLayout::kHesai ||
                               layout == PointLayout::kAeva;
    channels[row] = static_cast<std::uint16_t>(is_from_above ? rows - 1 - row : row);
  }
  return channels;
}

void PutVendorPoints(const Frame& frame,
                     const VendorLayout& layout,
                     const std::vector<std::uint16_t>& channels,
                     PointCloud2& message) {
  for (const LayoutField& field : layout.fields) {
    message.fields.push_back({std::string(field.name), field.offset, field.datatype, 1});
  }
  message.height = layout.cloud.height;
  message.width = layout.cloud.width;
  message.point_step = layout.point_step;
  message.is_dense = layout.cloud.is_dense;
  message.data.resize(layout.cloud.slots.size() * layout.point_step);
  char* place = reinterpret_cast<char*>(message.data.data());
  for (const std::size_t slot : layout.cloud.slots) {
    const PointSource point{frame, slot, channels[slot / frame.width()]};
    for (const LayoutField& field : layout.fields) field.store(point, place + field.offset);
    place += layout.point_step;
  }
}

void PutOwnPoints(const Frame& frame, const FieldSelection& fields, PointCloud2& message) {
  const SelectedFields selected(frame, fields);
  const Cloud cloud = DescribeCloud(frame, selected);
  for (const CloudField& field : cloud.fields) {
    message.fields.push_back(
        {field.name, field.offset, static_cast<std::uint8_t>(field.type), field.count});
  }
  message.height = cloud.height;
  message.width = cloud.width;
  message.point_step = cloud.point_step;
  message.is_dense = std::ranges::all_of(frame.outcome, &HasPoint);
  message.data.resize(frame.num_slots() * cloud.point_step);
  WeaveRows(frame, selected, cloud.point_step, reinterpret_cast<char*>(message.data.data()));
}

}  // namespace

CloudSpec ParseCloudSpec(std::string_view text, bool has_velocity, bool has_track) {
  if (const auto layout = ValueNamed<PointLayout>(text)) {
    if (*layout == PointLayout::kAeva && !has_velocity) throw InputError(kNeedsVelocity);
    return {*layout, {}};
  }
  CloudSpec spec{PointLayout::kRailcast, FieldSelection(text, has_velocity, has_track)};
  for (const std::string_view name : {"x", "y", "z"}) {
    if (spec.fields.Has(name)) continue;
    throw InputError("--fields: must contain x, y and z for messages of ROS 2 (got " +
                     spec.fields.Text() + ")");
  }
  return spec;
}

std::string TextOf(const CloudSpec& spec) {
  return spec.layout == PointLayout::kRailcast ? spec.fields.Text()
                                               : std::string(NameOf(spec.layout));
}

std::uint32_t NumClouds(PointLayout layout, std::uint32_t num_returns) {
  return layout == PointLayout::kOuster ? num_returns : 1;
}

PointCloud2 MakeCloud(const Frame& frame,
                      const CloudSpec& spec,
                      std::string frame_id,
                      const std::vector<std::uint16_t>& channel_of_row,
                      std::uint32_t cloud) {
  const bool is_aeva = spec.layout == PointLayout::kAeva;
  if ((is_aeva || spec.layout == PointLayout::kLivox) && frame.rows > kMostLines) {
    throw InputError("--fields " + TextOf(spec) + ": needs at most 256 channels" + Got(frame.rows));
  }
  if (is_aeva && !frame.has_velocity) {
    throw InputError(kNeedsVelocity);
  }
  PointCloud2 message;
  message.header = {TimeOf(frame.stamp_ns), std::move(frame_id)};
  if (spec.layout == PointLayout::kRailcast) {
    PutOwnPoints(frame, spec.fields, message);
  } else {
    PutVendorPoints(frame, LayoutOf(spec.layout, frame, cloud),
                    ChannelsInRows(spec.layout, frame.rows, channel_of_row), message);
  }
  message.row_step = message.width * message.point_step;
  return message;
}

Time TimeOf(std::int64_t time_ns) {
  const std::int64_t rest_ns = (time_ns % kNsPerS + kNsPerS) % kNsPerS;
  const std::int64_t time_s = (time_ns - rest_ns) / kNsPerS;
  if (!std::in_range<std::int32_t>(time_s)) {
    throw InputError("stamps in messages of ROS 2 must be before 2038-01-19 03:14:08 (got " +
                     NumberText(time_s) + " s since 1970)");
  }
  return {static_cast<std::int32_t>(time_s), static_cast<std::uint32_t>(rest_ns)};
}

}  // namespace railcast::ros
