#include "core/mesh/gltf_buffers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
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

/// Throws unless a member of an accessor, if it is there, is one of these.
void CheckMember(const std::string& place,
                 const nlohmann::json& object,
                 const char* member,
                 const std::vector<nlohmann::json>& allowed,
                 const std::string& rule) {
  const nlohmann::json& value = ValueIn(object, member);
  if (value.is_null() || std::ranges::find(allowed, value) != allowed.end()) return;
  throw InputError(place + "/" + member + ": " + rule + " (got " + ShownText(value.dump()) + ")");
}

/// Throws if positions and indices are not as the format has them, which assimp does not ask.
/// Positions may be whole numbers where the file says so.
void CheckPrimitive(const nlohmann::json& json,
                    const nlohmann::json& primitive,
                    bool is_quantised,
                    const std::string& shown) {
  constexpr int kTriangles = 4;
  const nlohmann::json& accessors = ValueIn(json, "accessors");
  const nlohmann::json& key = ValueIn(ValueIn(primitive, "attributes"), "POSITION");
  const nlohmann::json& index_key = ValueIn(primitive, "indices");
  const nlohmann::json& positions = ValueIn(accessors, key);
  const nlohmann::json& indices = ValueIn(accessors, index_key);
  const std::string place = shown + ": accessors/" + key.dump();
  const std::string index_place = shown + ": accessors/" + index_key.dump();
  if (is_quantised) {
    CheckMember(place, positions, "componentType", {5120, 5121, 5122, 5123, 5126},
                "of POSITION must be 5120 to 5123 or 5126");
  } else {
    CheckMember(place, positions, "componentType", {5126},
                "of POSITION must be 5126, float, unless KHR_mesh_quantization is required");
  }
  CheckMember(place, positions, "type", {"VEC3"}, "of POSITION must be VEC3");
  CheckMember(index_place, indices, "componentType", {5121, 5123, 5125},
              "of indices must be 5121, 5123 or 5125");
  const nlohmann::json& view_key = ValueIn(positions, "bufferView");
  const nlohmann::json& stride =
      ValueIn(ValueIn(ValueIn(json, "bufferViews"), view_key), "byteStride");
  const int least = is_quantised ? 4 : 12;
  const bool is_stride = stride.is_number_unsigned() && stride >= least && stride <= 252 &&
                         stride.get<std::uint64_t>() % 4 == 0;
  if (!stride.is_null() && !is_stride) {
    throw InputError(shown + ": bufferViews/" + view_key.dump() +
                     "/byteStride: of POSITION must be a multiple of 4 from " + NumberText(least) +
                     " to 252 (got " + ShownText(stride.dump()) + ")");
  }
  const nlohmann::json& mode = ValueIn(primitive, "mode");
  const nlohmann::json& count = ValueIn(index_key.is_null() ? positions : indices, "count");
  const bool is_whole = !count.is_number_unsigned() || count.get<std::uint64_t>() % 3 == 0;
  if (is_whole || !(mode.is_null() || mode == kTriangles)) return;
  throw InputError((index_key.is_null() ? place : index_place) +
                   "/count: of triangles must be a multiple of 3 (got " + count.dump() + ")");
}

/// Throws if a node's place is no list of as many numbers as the format has.
void CheckNode(const nlohmann::json& node, const std::string& place) {
  const std::map<std::string, std::size_t> sizes = {
      {"translation", 3}, {"rotation", 4}, {"scale", 3}, {"matrix", 16}};
  for (const auto& [member, size] : sizes) {
    const nlohmann::json& value = ValueIn(node, member);
    if (value.is_null()) continue;
    const bool is_right =
        value.is_array() && value.size() == size &&
        std::ranges::all_of(value, [](const auto& one) { return one.is_number(); });
    if (is_right) continue;
    throw InputError(place + "/" + member + ": must be " + std::to_string(size) + " numbers (got " +
                     ShownText(value.dump()) + ")");
  }
}

/// Throws if data within the file have other letters than base64.
void CheckLetters(const nlohmann::json& json, const std::string& shown) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=";
  constexpr std::string_view kBegin = ";base64,";
  for (const auto& buffer : ValueIn(json, "buffers")) {
    const nlohmann::json& uri = ValueIn(buffer, "uri");
    const std::string text = uri.is_string() ? uri.get<std::string>() : "";
    const std::size_t begin = text.starts_with("data:") ? text.find(kBegin) : std::string::npos;
    if (begin == std::string::npos) continue;
    const std::size_t wrong = text.find_first_not_of(kLetters, begin + kBegin.size());
    if (wrong == std::string::npos) continue;
    throw InputError(shown + ": buffers/uri: must be base64 (got " + Quoted(text.substr(wrong, 1)) +
                     ")");
  }
}

}  // namespace

nlohmann::json JsonOfGltf(const std::string& bytes) {
  return nlohmann::json::parse(JsonOf(bytes), nullptr, false);
}

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

std::vector<std::string> BuffersOfGltf(const std::string& bytes) {
  std::vector<std::string> names;
  const auto json = JsonOfGltf(bytes);
  if (!json.is_object() || !json.contains("buffers")) return names;
  // A list, or in glTF 1 an object, in which this one is the file itself, whatever its uri.
  for (const auto& [key, buffer] : json.at("buffers").items()) {
    if (key == "binary_glTF") continue;
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer.at("uri").is_string()) continue;
    const std::string name = buffer.at("uri");
    const bool is_known = std::ranges::find(names, name) != names.end();
    if (!is_known && !name.starts_with("data:")) names.push_back(name);
  }
  return names;
}

std::vector<std::string> CheckGltf(const std::string& bytes, const std::string& shown) {
  const auto json = JsonOfGltf(bytes);
  const auto required = StringsIn(json, "extensionsRequired");
  for (const std::string& name : required) {
    if (IsHarmless(name)) continue;
    throw InputError(shown + ": extensionsRequired: must be extensions that are read; " +
                     WithoutExtension(name) + " (got " + Quoted(name) + ")");
  }
  const bool is_quantised = std::ranges::find(required, "KHR_mesh_quantization") != required.end();
  for (const auto& mesh : ValueIn(json, "meshes")) {
    for (const auto& primitive : ValueIn(mesh, "primitives"))
      CheckPrimitive(json, primitive, is_quantised, shown);
  }
  for (const auto& [key, node] : ValueIn(json, "nodes").items()) {
    CheckNode(node, shown + ": nodes/" + ShownText(key));
  }
  CheckLetters(json, shown);
  std::vector<std::string> unread = StringsIn(json, "extensionsUsed");
  std::erase_if(unread, IsHarmless);
  return unread;
}

std::optional<std::size_t> TrianglesOfGltf(const std::string& bytes, std::size_t num_primitives) {
  const auto json = JsonOfGltf(bytes);
  std::size_t num_triangles = 0;
  std::size_t num_found = 0;
  for (const auto& mesh : ValueIn(json, "meshes")) {
    for (const auto& primitive : ValueIn(mesh, "primitives")) {
      const nlohmann::json& indices = ValueIn(primitive, "indices");
      const nlohmann::json& count = ValueIn(ValueIn(ValueIn(json, "accessors"), indices), "count");
      const bool has_triangles = ValueIn(primitive, "mode").is_null() || primitive["mode"] == 4;
      if (!has_triangles || !count.is_number_unsigned()) return std::nullopt;
      num_triangles += count.get<std::size_t>() / 3;
      ++num_found;
    }
  }
  return num_found == num_primitives ? std::optional(num_triangles) : std::nullopt;
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
