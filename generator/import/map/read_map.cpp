#include "generator/import/map/read_map.h"

#include <array>
#include <string>

#include "core/base/input_file.h"
#include "generator/import/map/overpass_json.h"
#include "generator/import/map/railml_map.h"
#include "generator/import/map/vector_map.h"

namespace railcast {
namespace {

std::string BeginningOf(const std::filesystem::path& file) {
  std::array<char, 4096> bytes{};
  std::ifstream stream = OpenInput(file);
  stream.read(bytes.data(), bytes.size());
  return {bytes.data(), static_cast<std::size_t>(stream.gcount())};
}

/// GeoJSON is JSON, too, and may have a property `elements`, but it begins with what it is.
bool IsOverpass(std::string_view begin) {
  const std::size_t first = begin.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return first != std::string_view::npos && begin[first] == '{' &&
         begin.find("\"elements\"") != std::string_view::npos &&
         begin.find("\"Feature\"") == std::string_view::npos &&
         begin.find("\"FeatureCollection\"") == std::string_view::npos;
}

}  // namespace

RailMap ReadMap(const std::filesystem::path& file) {
  const std::string begin = BeginningOf(file);
  if (IsOverpass(begin)) return ReadOverpassJson(file);
  return IsRailMl(begin) ? ReadRailMl(file) : ReadVectorMap(file);
}

}  // namespace railcast
