#include "core/extras/recipe/json_place.h"

#include <array>
#include <charconv>
#include <utility>
#include <vector>

#include "core/base/text.h"

namespace railcast {
namespace {

std::vector<std::string> StepsOf(std::string_view pointer) {
  std::vector<std::string> steps;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/') {
      steps.emplace_back();
    } else if (pointer[i] == '~') {
      steps.back() += pointer[++i] == '0' ? '~' : '/';
    } else {
      steps.back() += pointer[i];
    }
  }
  return steps;
}

void RemoveAlternative(Json& object, const std::string& key) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kPairs = {{
      {"visibility_m", "fog_density_per_m"},
      {"rain_intensity", "rain_rate_mmph"},
      {"track", "route"},
      {"profile", "path"},
      {"lidar", "lidars"},
  }};
  for (const auto& [one, other] : kPairs) {
    if (key == one) object.erase(std::string(other));
    if (key == other) object.erase(std::string(one));
  }
}

// Returns the member or element of that name; null if a list has no such element or the value
// neither.
Json* ChildAt(Json& parent, const std::string& step) {
  if (parent.is_null()) parent = Json::object();
  if (parent.is_object()) return &parent[step];
  if (!parent.is_array()) return nullptr;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(step.data(), step.data() + step.size(), index);
  const bool is_index = error == std::errc() && end == step.data() + step.size();
  return is_index && index < parent.size() ? &parent[index] : nullptr;
}

}  // namespace

std::optional<std::string> PointerFault(std::string_view pointer) {
  if (!pointer.starts_with('/')) return "must be a JSON pointer, which begins with /";
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] != '~') continue;
    const char next = i + 1 < pointer.size() ? pointer[i + 1] : ' ';
    if (next != '0' && next != '1') return "must be a JSON pointer, in which ~ is written as ~0";
  }
  return std::nullopt;
}

bool LiesWithin(std::string_view inner, std::string_view outer) {
  return inner.starts_with(outer) && (inner.size() == outer.size() || inner[outer.size()] == '/');
}

std::optional<std::string> SetAt(Json& root, std::string_view pointer, const Json& value) {
  Json* place = &root;
  std::string path;
  for (const std::string& step : StepsOf(pointer)) {
    if (place->is_object()) RemoveAlternative(*place, step);
    Json* const child = ChildAt(*place, step);
    if (child == nullptr) {
      const std::string what = path.empty() ? "the scenario" : ShownText(path);
      if (!place->is_array()) return what + " is neither an object nor a list";
      return what + " has no element " + ShownText(step);
    }
    path += PointerStep(step);
    place = child;
  }
  *place = value;
  return std::nullopt;
}

}  // namespace railcast
