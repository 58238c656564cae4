#include "core/io/cloud/pcd_encoder.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/base/error.h"
#include "core/io/cloud/woven_cloud.h"
#include "core/io/field_layout.h"
#include "railcast/io/cloud_files.h"

// The header of liblzf is one of C.
extern "C" {
#include <lzf.h>
}

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

void AppendText(std::size_t num_slots, const SelectedFields& fields, std::string& bytes) {
  for (std::size_t slot = 0; slot < num_slots; ++slot) {
    fields.ForEach([&](std::string_view, std::string_view, const auto& values) {
      using Stored = typename StoredType<ElementOf<decltype(values)>>::Type;
      AppendWord(static_cast<Stored>(values[slot]), bytes);
      bytes += ' ';
    });
    bytes.back() = '\n';
  }
}

}  // namespace

char PcdLetter(NumberType type) {
  return VisitNumberType(type, [](auto zero) {
    using Value = decltype(zero);
    return std::is_floating_point_v<Value> ? 'F' : std::is_signed_v<Value> ? 'I' : 'U';
  });
}

std::string PcdHeaderOf(const Cloud& cloud, std::string_view data) {
  std::string names, sizes, types, counts;
  std::size_t offset = 0;
  for (const CloudField& field : cloud.fields) {
    Check(field.offset == offset, "the fields of a cloud are packed");
    offset += field.num_bytes();
    names += ' ' + field.name;
    sizes += ' ' + std::to_string(SizeOf(field.type));
    types += {' ', PcdLetter(field.type)};
    counts += ' ' + std::to_string(field.count);
  }
  Check(cloud.point_step == offset, "the points of a cloud are packed");
  std::string header = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n";
  header += "FIELDS" + names + "\nSIZE" + sizes + "\nTYPE" + types + "\nCOUNT" + counts + '\n';
  header += "WIDTH " + std::to_string(cloud.width) + "\nHEIGHT " + std::to_string(cloud.height);
  header += "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(cloud.num_points());
  header += "\nDATA " + std::string(data) + '\n';
  return header;
}

std::string EncodePcd(const Cloud& cloud, bool is_compressed) {
  Check(cloud.data.size() == cloud.num_points() * cloud.point_step, "a cloud has all its points");
  if (!is_compressed || cloud.data.empty()) {
    return PcdHeaderOf(cloud, "binary")
        .append(reinterpret_cast<const char*>(cloud.data.data()), cloud.data.size());
  }
  std::string fields(cloud.data.size(), '\0');
  Transpose(FieldSizes(cloud), cloud.num_points(), cloud.data.data(), false, fields.data());
  std::string bytes = PcdHeaderOf(cloud, "binary_compressed");
  AppendCompressed(fields, bytes);
  return bytes;
}

void AppendCompressed(const std::string& plain, std::string& bytes) {
  Check(plain.size() < std::numeric_limits<std::uint32_t>::max() / 2, "a frame is below 2 GiB");
  // LZF adds at most one byte per 32 where nothing repeats.
  std::string packed(plain.size() + plain.size() / 16 + 64, '\0');
  const std::uint32_t packed_size =
      lzf_compress(plain.data(), static_cast<std::uint32_t>(plain.size()), packed.data(),
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
  const Cloud cloud = DescribeCloud(frame, selected);
  switch (encoding) {
    case PcdEncoding::kBinary: {
      const std::string header = PcdHeaderOf(cloud, "binary");
      bytes.resize(header.size() + frame.num_slots() * cloud.point_step);
      header.copy(bytes.data(), header.size());
      WeaveRows(frame, selected, cloud.point_step, bytes.data() + header.size());
      break;
    }
    case PcdEncoding::kBinaryCompressed:
      bytes = PcdHeaderOf(cloud, "binary_compressed");
      AppendCompressedFields(selected, bytes);
      break;
    case PcdEncoding::kAscii:
      bytes = PcdHeaderOf(cloud, "ascii");
      AppendText(frame.num_slots(), selected, bytes);
      break;
  }
}

}  // namespace railcast
