#include "core/io/frame_files.h"

#include <array>
#include <utility>

#include "core/base/error.h"
#include "core/io/kitti.h"
#include "core/io/pcd_encoder.h"
#include "core/io/ply_encoder.h"

namespace railcast {
namespace {

constexpr std::array<std::pair<FrameFormat, std::string_view>, 6> kFormats = {{
    {FrameFormat::kPcd, "pcd"},
    {FrameFormat::kPcdCompressed, "pcd-compressed"},
    {FrameFormat::kPcdAscii, "pcd-ascii"},
    {FrameFormat::kPly, "ply"},
    {FrameFormat::kPlyCloudCompare, "ply-cloudcompare"},
    {FrameFormat::kKitti, "kitti"},
}};

std::string SixDigits(std::uint32_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < 6) digits.insert(0, 6 - digits.size(), '0');
  return digits;
}

}  // namespace

std::string_view FrameFormatName(FrameFormat format) {
  return kFormats[static_cast<std::size_t>(format)].second;
}

FrameFormat ParseFrameFormat(std::string_view name) {
  std::string valid;
  for (const auto& [format, format_name] : kFormats) {
    if (format_name == name) return format;
    valid += (valid.empty() ? "" : ", ") + std::string(format_name);
  }
  throw InputError("--format: unknown format \"" + std::string(name) + "\" (valid: " + valid + ")");
}

std::vector<std::string> FrameFileNames(FrameFormat format, std::uint32_t number) {
  const std::string digits = SixDigits(number);
  switch (format) {
    case FrameFormat::kKitti:
      return {"sequences/00/velodyne/" + digits + ".bin",
              "sequences/00/labels/" + digits + ".label"};
    case FrameFormat::kPly:
    case FrameFormat::kPlyCloudCompare:
      return {"frames/" + digits + ".ply"};
    default:
      return {"frames/" + digits + ".pcd"};
  }
}

void EncodeFrameFiles(const Frame& frame,
                      const FrameFileSpec& spec,
                      std::uint32_t number,
                      std::vector<FrameFile>& files,
                      const std::set<std::uint32_t>& moving) {
  const std::vector<std::string> names = FrameFileNames(spec.format, number);
  files.resize(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) files[i].name = names[i];
  if (spec.format == FrameFormat::kKitti) {
    EncodeKittiPoints(frame, files[0].bytes);
    EncodeKittiLabels(frame, spec.labels, moving, files[1].bytes);
    return;
  }
  std::string& bytes = files[0].bytes;
  switch (spec.format) {
    case FrameFormat::kPcd:
      return EncodePcd(frame, spec.fields, PcdEncoding::kBinary, bytes);
    case FrameFormat::kPcdCompressed:
      return EncodePcd(frame, spec.fields, PcdEncoding::kBinaryCompressed, bytes);
    case FrameFormat::kPcdAscii:
      return EncodePcd(frame, spec.fields, PcdEncoding::kAscii, bytes);
    case FrameFormat::kPly:
      return EncodePly(frame, spec.fields, PlyFlavour::kPcl, bytes);
    case FrameFormat::kPlyCloudCompare:
      return EncodePly(frame, spec.fields, PlyFlavour::kCloudCompare, bytes);
    case FrameFormat::kKitti:
      break;
  }
}

}  // namespace railcast
