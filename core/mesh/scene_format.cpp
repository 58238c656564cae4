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
  if (begin.starts_with("MM") && bytes.size() >= 16) return "3ds";
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  const std::size_t first = begin.find_first_not_of(
      " \t\r\n", begin.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
  if (first == std::string_view::npos) return std::nullopt;
  if (begin[first] == '<' && holds("<COLLADA")) return "dae";
  if (begin[first] == '{' && bytes.find("\"asset\"") != std::string::npos) {
    return "gltf";
  }
  return std::nullopt;
}

}  // namespace railcast
