#include "generator/import/map/map_formats.h"

#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

/// What a value is, as messages show it.
std::string GotOf(const Json& value) {
  return value.is_primitive() ? ShownText(value.dump()) : value.type_name();
}

class GeoJsonPlaceCheck {
 public:
  void CheckObject(const Json& object, const std::string& pointer, int depth);
  [[nodiscard]] ErrorList& errors() { return errors_; }

 private:
  /// A list of places, of lines, or of areas.
  void CheckList(const Json& list, const std::string& pointer, int depth);
  /// @return Whether it has a height; absent if it is no place.
  std::optional<bool> CheckPosition(const Json& position, const std::string& pointer);

  ErrorList errors_;
};

std::optional<bool> GeoJsonPlaceCheck::CheckPosition(const Json& position,
                                                     const std::string& pointer) {
  if (position.size() < 2) {
    errors_.Add({pointer, "must have a longitude and a latitude",
                 std::to_string(position.size()) + " numbers"});
    return std::nullopt;
  }
  for (std::size_t i = 0; i < position.size(); ++i) {
    if (position[i].is_number()) continue;
    errors_.Add({pointer + "/" + std::to_string(i), "must be a number", GotOf(position[i])});
  }
  return position.size() >= 3;
}

/// Areas of several parts are nested three deep.
constexpr int kDeepestList = 3;

void GeoJsonPlaceCheck::CheckList(const Json& list, const std::string& pointer, int depth) {
  std::optional<bool> has_heights;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string place = pointer + "/" + std::to_string(i);
    if (!list[i].is_array()) {
      errors_.Add({place, "must be a list of coordinates", GotOf(list[i])});
      continue;
    }
    if (!list[i].empty() && list[i].front().is_array() && depth < kDeepestList) {
      CheckList(list[i], place, depth + 1);
      continue;
    }
    const std::optional<bool> has_height = CheckPosition(list[i], place);
    if (!has_heights) has_heights = has_height;
    if (!has_height || *has_heights == *has_height) continue;
    errors_.Add({place, "must have a height if other points of its line do",
                 *has_height ? "one, but others have none" : "none"});
  }
}

void GeoJsonPlaceCheck::CheckObject(const Json& object, const std::string& pointer, int depth) {
  constexpr int kDeepest = 8;
  if (!object.is_object()) return;
  if (depth > kDeepest) {
    errors_.Add({pointer, "must not be nested deeper than 8 levels", "more"});
    return;
  }
  for (const char* key : {"features", "geometries"}) {
    if (!object.contains(key) || !object[key].is_array()) continue;
    for (std::size_t i = 0; i < object[key].size(); ++i) {
      CheckObject(object[key][i], pointer + "/" + key + "/" + std::to_string(i), depth + 1);
    }
  }
  if (object.contains("geometry")) {
    CheckObject(object["geometry"], pointer + "/geometry", depth + 1);
  }
  if (!object.contains("coordinates")) return;
  const Json& coordinates = object["coordinates"];
  const std::string place = pointer + "/coordinates";
  if (!coordinates.is_array()) {
    errors_.Add({place, "must be a list of coordinates", GotOf(coordinates)});
  } else if (object.contains("type") && object["type"] == "Point") {
    CheckPosition(coordinates, place);
  } else {
    CheckList(coordinates, place, 1);
  }
}

}  // namespace

void CheckGeoJsonPlaces(const std::filesystem::path& file) {
  const Json root = ReadMapJson(file);
  GeoJsonPlaceCheck check;
  check.CheckObject(root, "", 0);
  AtPlace(ShownPath(file) + ": ", [&] { check.errors().ThrowIfAny(); });
}

}  // namespace railcast
