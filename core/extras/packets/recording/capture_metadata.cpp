#include "core/extras/packets/recording/capture_metadata.h"

#include <vector>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"

namespace railcast {
namespace {

std::vector<std::filesystem::path> MetadataNames(const std::filesystem::path& capture) {
  std::string stem = capture.stem().string();
  std::vector<std::filesystem::path> names = {capture.parent_path() / (stem + "_0.json")};
  while (true) {
    names.push_back(capture.parent_path() / (stem + ".json"));
    const std::size_t end = stem.rfind('_');
    if (end == std::string::npos || end == 0) return names;
    stem.resize(end);
  }
}

}  // namespace

OusterMetadata ReadOusterMetadata(const std::filesystem::path& file) {
  // The largest that Ouster's sensors and programs write has some 20 kB.
  constexpr std::uintmax_t kMostBytes = 1U << 20U;
  CheckIsReadable(file);
  std::error_code error;
  const std::uintmax_t num_bytes = std::filesystem::file_size(file, error);
  if (num_bytes > kMostBytes) {
    throw InputError(ShownPath(file) + ": must have at most 1048576 bytes (got " +
                     NumberText(num_bytes) + ")");
  }
  const std::string text = ReadFileWhole(file);
  return AtPlace(ShownPath(file) + ": ", [&] { return ParseOusterOfPackets(text); });
}

CaptureMetadata FindOusterMetadata(const std::filesystem::path& capture) {
  CaptureMetadata found;
  for (const std::filesystem::path& name : MetadataNames(capture)) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(name, error)) continue;
    try {
      return {.file = name, .metadata = ReadOusterMetadata(name)};
    } catch (const InputError& fault) {
      if (found.file.empty()) found = {.file = name, .fault = fault.what()};
    }
  }
  return found;
}

}  // namespace railcast
