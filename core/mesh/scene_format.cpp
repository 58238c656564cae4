#include <algorithm>
#include <string_view>

#include "core/mesh/assimp_reader.h"

namespace railcast {

std::optional<std::string> SceneFormatOf(const std::string& bytes) {
  const auto begin = std::string_view(bytes).substr(0, std::min<std::size_t>(bytes.size(), 4096));
  const auto holds = [&](std::string_view text) {
    return begin.find(text) != std::string_view::npos;
  };
  if (begin.starts_with("glTF")) return "glb";
  if (begin.starts_with("Kaydara FBX Binary") || (begin.starts_with(";") && holds("FBX"))) {
    return "fbx";
  }
  if (holds("<COLLADA")) return "dae";
  if (begin.starts_with("MM") && begin.size() > 6 && bytes.size() >= 16) return "3ds";
  const std::size_t first = begin.find_first_not_of(" \t\r\n");
  if (first != std::string_view::npos && begin[first] == '{' &&
      bytes.find("\"asset\"") != std::string::npos) {
    return "gltf";
  }
  return std::nullopt;
}

}  // namespace railcast
