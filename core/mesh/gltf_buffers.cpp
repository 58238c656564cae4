#include "core/mesh/gltf_buffers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

/// The JSON of a glTF file, which stands first in a binary one.
std::string_view JsonOf(const std::string& bytes) {
  constexpr std::size_t kHeaderBytes = 20;
  const std::string_view all = bytes;
  if (!all.starts_with("glTF")) return all;
  if (all.size() < kHeaderBytes) return {};
  std::uint32_t num_bytes = 0;
  std::memcpy(&num_bytes, bytes.data() + 12, sizeof(num_bytes));
  return all.substr(kHeaderBytes, num_bytes);
}

/// Extensions that assimp reads or that do not change shapes, whole or to their first letters.
constexpr auto kHarmlessExtensions = std::to_array<std::string_view>(
    {"KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_", "KHR_lights_",
     "EXT_lights_", "KHR_animation_", "KHR_techniques_webgl", "KHR_binary_glTF", "KHR_xmp",
     "KHR_xmp_", "KHR_mesh_quantization", "KHR_draco_mesh_compression", "EXT_mesh_features",
     "EXT_structural_metadata", "EXT_instance_features", "MSFT_lod", "ADOBE_materials_",
     "FB_materials_"});

bool IsHarmless(const std::string& extension) {
  // It has colours in place of those that are read.
  if (extension == "KHR_materials_pbrSpecularGlossiness") return false;
  return std::ranges::any_of(kHarmlessExtensions, [&](std::string_view known) {
    return known.ends_with('_') ? extension.starts_with(known) : extension == known;
  });
}

constexpr const char* kWithGltfpack = "gltfpack -noq -i IN.glb -o OUT.glb writes it without";

/// How to come to a file without an extension.
std::string WithoutExtension(const std::string& extension) {
  const bool is_meshopt = extension.find("meshopt") != std::string::npos;
  return is_meshopt ? kWithGltfpack : "railcast reads files without it only";
}

std::vector<std::string> StringsIn(const nlohmann::json& json, const char* key) {
  std::vector<std::string> strings;
  if (!json.is_object() || !json.contains(key) || !json.at(key).is_array()) return strings;
  for (const auto& one : json.at(key)) {
    if (one.is_string()) strings.push_back(one);
  }
  return strings;
}

/// The value of a key in an object, or of an index in a list; null if it is not there.
const nlohmann::json& ValueIn(const nlohmann::json& json, const nlohmann::json& key) {
  static const nlohmann::json none;
  if (json.is_object() && key.is_string()) {
    const auto found = json.find(key.get<std::string>());
    return found == json.end() ? none : *found;
  }
  const bool is_index = json.is_array() && key.is_number_unsigned();
  const std::size_t index = is_index ? key.get<std::size_t>() : json.size();
  return index < json.size() ? json[index] : none;
}

/// Positions that are whole numbers have another scale, which assimp does not know.
void CheckPositions(const nlohmann::json& json, const std::string& shown) {
  constexpr int kFloat = 5126;
  const nlohmann::json& accessors = ValueIn(json, "accessors");
  for (const auto& mesh : ValueIn(json, "meshes")) {
    for (const auto& primitive : ValueIn(mesh, "primitives")) {
      const nlohmann::json& key = ValueIn(ValueIn(primitive, "attributes"), "POSITION");
      const nlohmann::json& type = ValueIn(ValueIn(accessors, key), "componentType");
      if (!type.is_number() || type == kFloat) continue;
      throw InputError(shown + ": accessors/" + key.dump() +
                       "/componentType: of POSITION must be " + std::to_string(kFloat) +
                       ", float; KHR_mesh_quantization is not read (" + kWithGltfpack + ") (got " +
                       type.dump() + ")");
    }
  }
}

}  // namespace

std::vector<std::string> BuffersOfGltf(const std::string& bytes) {
  std::vector<std::string> names;
  const auto json = nlohmann::json::parse(JsonOf(bytes), nullptr, false);
  if (!json.is_object() || !json.contains("buffers")) return names;
  // A list, or in glTF 1 an object.
  for (const auto& buffer : json.at("buffers")) {
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer.at("uri").is_string()) continue;
    const std::string name = buffer.at("uri");
    const bool is_known = std::ranges::find(names, name) != names.end();
    if (!is_known && !name.starts_with("data:")) names.push_back(name);
  }
  return names;
}

std::vector<std::string> CheckGltf(const std::string& bytes, const std::string& shown) {
  const auto json = nlohmann::json::parse(JsonOf(bytes), nullptr, false);
  for (const std::string& name : StringsIn(json, "extensionsRequired")) {
    if (IsHarmless(name)) continue;
    throw InputError(shown + ": extensionsRequired: must be extensions that are read; " +
                     WithoutExtension(name) + " (got " + Quoted(name) + ")");
  }
  CheckPositions(json, shown);
  std::vector<std::string> unread = StringsIn(json, "extensionsUsed");
  std::erase_if(unread, IsHarmless);
  return unread;
}

std::string FileOfUri(const std::string& uri) {
  std::string name;
  const auto is_hex = [&](std::size_t place) {
    return place < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[place])) != 0;
  };
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && is_hex(i + 1) && is_hex(i + 2)) {
      name += static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      name += uri[i];
    }
  }
  return name;
}

}  // namespace railcast
