#include "core/io/run/sequence_files.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/base/text.h"
#include "core/io/run/motion_files.h"
#include "core/io/run/trace_name.h"
#include "core/scenario/archive.h"
#include "railcast/camera.h"

namespace railcast {
namespace {

constexpr std::array kNames = {kRunFile,        kManifestFile,   kScenarioFile,
                               kLabelsFile,     kMaterialsFile,  kCommandsFile,
                               kPosesFile,      kObjectsFile,    kFramesFile,
                               kKittiPosesFile, kKittiTimesFile, kKittiCalibrationFile,
                               kKittiLabelsFile};

bool IsHashDigit(char letter) {
  return IsDigit(letter) || (letter >= 'a' && letter <= 'f');
}

// Removes `part` from the front of `text`; returns false and leaves `text` if it does not begin so.
bool Take(std::string_view& text, std::string_view part) {
  if (!text.starts_with(part)) return false;
  text.remove_prefix(part.size());
  return true;
}

// Whether the name is like "000012.pcd": six digits, or more without a leading zero.
bool IsNumbered(std::string_view name, std::string_view extension) {
  constexpr std::size_t kMinDigits = 6;
  if (!name.ends_with(extension)) return false;
  name.remove_suffix(extension.size());
  return name.size() >= kMinDigits && std::ranges::all_of(name, IsDigit) &&
         (name.size() == kMinDigits || name.front() != '0');
}

// Whether the name is like "0123456789abcdef/wagon.obj".
bool IsInput(std::string_view name) {
  constexpr std::size_t kHashDigits = 16;
  if (name.size() < kHashDigits || !std::ranges::all_of(name.substr(0, kHashDigits), IsHashDigit)) {
    return false;
  }
  name.remove_prefix(kHashDigits);
  return Take(name, "/") && !name.empty() && name != "." && name != ".." &&
         name.find('/') == std::string_view::npos;
}

// Whether the name is like "front/color/000012.png" or "front/calibration.json".
bool IsOfCamera(std::string_view name) {
  const std::size_t end = name.find('/');
  if (end == std::string_view::npos || !IsCameraName(name.substr(0, end))) return false;
  name.remove_prefix(end + 1);
  if (name == kCalibrationName) return true;
  return std::ranges::any_of(CameraFileKinds(), [&](const FrameFileKind& kind) {
    std::string_view number = name;
    return Take(number, kind.folder) && IsNumbered(number, kind.extension);
  });
}

}  // namespace

void DescribeContent(Archive& a, KnownFile& s) {
  std::uint64_t bytes = s.bytes.value_or(0);
  a.Required("bytes", bytes, "Size of the file.");
  s.bytes = bytes;
  a.Required("xxh3", s.hash, "Hash of the file's bytes.");
}

void Describe(Archive& a, KnownFile& s) {
  a.Required("name", s.name, "Name of the file, relative to the directory.", NonEmptyString());
  DescribeContent(a, s);
}

const std::vector<FrameFileKind>& CameraFileKinds() {
  static const std::vector<FrameFileKind> kinds = {
      {"color/", ".png"}, {"label/", ".png"}, {"instance/", ".png"}, {"depth/", ".npy"}};
  return kinds;
}

bool IsCameraFile(std::string_view name) {
  return Take(name, kCameraFolder) && Take(name, "/") && IsOfCamera(name);
}

bool IsOfBag(std::string_view name) {
  return name == kBagLinesFile ||
         std::ranges::any_of(FrameFormats(), [&](const FrameFormat& format) {
           std::string_view rest = name;
           return !format.bag.empty() && Take(rest, format.bag) &&
                  (rest.empty() || rest.starts_with('/'));
         });
}

std::string FrameDigits(std::uint32_t number) {
  constexpr std::size_t kMinDigits = 6;
  std::string digits = std::to_string(number);
  if (digits.size() < kMinDigits) digits.insert(0, kMinDigits - digits.size(), '0');
  return digits;
}

bool IsSequenceFile(std::string_view name) {
  if (std::ranges::find(kNames, name) != kNames.end()) return true;
  for (const FrameFormat& format : FrameFormats()) {
    for (const FrameFileKind& file : format.files) {
      std::string_view number = name;
      if (Take(number, file.folder) && IsNumbered(number, file.extension)) return true;
    }
  }
  if (IsCameraFile(name) || IsMotionFile(name) || IsOfBag(name) || IsTraceName(name)) return true;
  return Take(name, kInputsFolder) && Take(name, "/") && IsInput(name);
}

}  // namespace railcast
