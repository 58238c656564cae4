#include "analysis/study/drawn_keys.h"

#include <nlohmann/json.hpp>
#include <string_view>

namespace railcast {
namespace {

void AddKeysOf(const Json& option, std::set<std::string>& keys) {
  const Json draws = option.value("draws", Json::object());
  const Json set = option.value("set", Json::object());
  for (const auto& [pointer, value] : draws.items()) keys.insert(pointer);
  for (const auto& [pointer, value] : set.items()) {
    keys.insert(pointer);
    if (!value.is_object()) continue;
    const Json leaves = value.flatten();
    for (const auto& [below, leaf] : leaves.items()) keys.insert(pointer + below);
  }
}

}  // namespace

std::set<std::string> DrawnKeys(const std::string& name, const Json& recipe) {
  std::set<std::string> keys = {name};
  const Json none = Json::array();
  for (const Json& group : recipe.value("groups", none)) {
    if (group.value("name", std::string()) != name) continue;
    for (const Json& option : group.value("options", none)) AddKeysOf(option, keys);
  }
  return keys;
}

bool IsAtOrBelow(const std::string& pointer, const std::string& key) {
  return pointer.starts_with(key) && (pointer.size() == key.size() || pointer[key.size()] == '/');
}

}  // namespace railcast
