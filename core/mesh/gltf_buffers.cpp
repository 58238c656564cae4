#include "core/mesh/gltf_buffers.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

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
