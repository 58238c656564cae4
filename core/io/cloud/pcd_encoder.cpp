#include "railcast/io/cloud_files.h"

#include <pcl/io/lzf.h>
#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "core/base/error.h"
#include "core/io/cloud/woven_cloud.h"
#include "core/io/field_layout.h"

namespace railcast {
namespace {

void AppendCompressedFields(const SelectedFields& fields, std::string& bytes) {
  std::string plain;
  fields.ForEach([&](std::string_view, std::string_view, const auto& values) {
    const std::size_t size = values.size() * sizeof(values[0]);
    const std::size_t begin = plain.size();
    plain.resize(begin + size);
    std::memcpy(plain.data() + begin, values.data(), size);
  });
  AppendCompressed(plain, bytes);
}

template <typename Stored>
void AppendNumber(Stored value, std::string& bytes) {
  if constexpr (std::is_floating_point_v<Stored>) {
    // to_chars may print the sign of a NaN, but readers expect "nan".
    if (std::isnan(value)) {
      bytes += "nan";
      return;
    }
  }
  std::array<char, 24> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  bytes.append(digits.data(), end);
}

void AppendText(std::size_t num_slots, const SelectedFields& fields, std::string& bytes) {
  for (std::size_t slot = 0; slot < num_slots; ++slot) {
    fields.ForEach([&](std::string_view, std::string_view, const auto& values) {
      using Stored = typename StoredType<ElementOf<decltype(values)>>::Type;
      AppendNumber(static_cast<Stored>(values[slot]), bytes);
      bytes += ' ';
    });
    bytes.back() = '\n';
  }
}

}  // namespace

void AppendCompressed(const std::string& plain, std::string& bytes) {
  Check(plain.size() < std::numeric_limits<std::uint32_t>::max() / 2, "a frame is below 2 GiB");
  // LZF adds at most one byte per 32 where nothing repeats.
  std::string packed(plain.size() + plain.size() / 16 + 64, '\0');
  const std::uint32_t packed_size =
      pcl::lzfCompress(plain.data(), static_cast<std::uint32_t>(plain.size()), packed.data(),
                       static_cast<std::uint32_t>(packed.size()));
  Check(packed_size > 0 || plain.empty(), "LZF output fits its bound");
  std::array<char, 8> sizes{};
  StoreAt<std::uint32_t>(sizes.data(), packed_size);
  StoreAt<std::uint32_t>(sizes.data() + 4, plain.size());
  bytes.append(sizes.data(), sizes.size());
  bytes.append(packed, 0, packed_size);
}

void EncodePcd(const Frame& frame,
               const FieldSelection& fields,
               PcdEncoding encoding,
               std::string& bytes) {
  const SelectedFields selected(frame, fields);
  const pcl::PCLPointCloud2 cloud = DescribeCloud(frame, selected);
  const Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  const Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
  pcl::PCDWriter writer;
  switch (encoding) {
    case PcdEncoding::kBinary: {
      const std::string header =
          writer.generateHeaderBinary(cloud, origin, orientation) + "DATA binary\n";
      bytes.resize(header.size() + frame.num_slots() * cloud.point_step);
      header.copy(bytes.data(), header.size());
      WeaveRows(frame, selected, cloud.point_step, bytes.data() + header.size());
      break;
    }
    case PcdEncoding::kBinaryCompressed:
      bytes = writer.generateHeaderBinaryCompressed(cloud, origin, orientation) +
              "DATA binary_compressed\n";
      AppendCompressedFields(selected, bytes);
      break;
    case PcdEncoding::kAscii:
      bytes = writer.generateHeaderASCII(cloud, origin, orientation) + "DATA ascii\n";
      AppendText(frame.num_slots(), selected, bytes);
      break;
  }
}

}  // namespace railcast
