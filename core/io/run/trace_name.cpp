#include "core/io/run/trace_name.h"

#include <algorithm>
#include <cstddef>

#include "core/base/text.h"

namespace railcast {
namespace {

// OSI 3.8.0, whose messages are of type sv.
constexpr std::string_view kTraceBegin = "19700101T000000Z_sv_380_";

bool IsWordLetter(char letter) {
  return IsDigit(letter) || (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
         letter == '_';
}

}  // namespace

std::string TraceName(const TraceNaming& naming) {
  std::string version = naming.protobuf_version;
  std::erase(version, '.');
  std::string sensor = naming.sensor.empty() ? "lidar" : naming.sensor;
  std::ranges::replace_if(
      sensor, [](char letter) { return !IsWordLetter(letter); }, '_');
  return std::string(kTraceBegin) + version + "_" + std::to_string(naming.num_frames) + "_" +
         sensor + std::string(naming.extension);
}

bool IsTraceName(std::string_view name) {
  if (!name.starts_with(kTraceBegin)) return false;
  name.remove_prefix(kTraceBegin.size());
  const std::size_t end = std::min(name.find('.'), name.size());
  const std::string_view extension = name.substr(end);
  return std::ranges::all_of(name.substr(0, end), IsWordLetter) &&
         (extension == ".osi" || extension == ".mcap");
}

}  // namespace railcast
