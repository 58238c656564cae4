#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/field_layout.h"
#include "generator/world/world_export.h"

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of glTF 2.0.
constexpr int kFloat = 5126;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kVertexData = 34962;
constexpr int kIndexData = 34963;
constexpr std::size_t kPositionBytes = 3 * sizeof(float);
constexpr std::size_t kColorBytes = 4 * sizeof(std::uint16_t);
constexpr std::size_t kIndexBytes = sizeof(std::uint32_t);

template <typename T>
void AppendValue(T value, std::string& bytes) {
  std::array<char, sizeof(T)> stored{};
  StoreAt<T>(stored.data(), value);
  bytes.append(stored.data(), stored.size());
}

/// A share of full light, of 65535, for a byte of sRGB (IEC 61966-2-1): colours of vertices are
/// linear in glTF.
std::uint16_t LinearOf(std::uint8_t srgb) {
  const double share = srgb / 255.0;
  const double linear = share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
  return static_cast<std::uint16_t>(std::lround(65535.0 * linear));
}

/// Where the data of all parts lie, one kind after the other, and the accessors that find them.
class GlbLayout {
 public:
  explicit GlbLayout(const std::vector<Part>& parts) {
    for (const Part& part : parts) AddPart(part.mesh);
  }

  /// The bytes of the chunk of the binary data.
  [[nodiscard]] std::size_t num_bytes() const {
    return num_vertices_ * (kPositionBytes + kColorBytes) + num_corners_ * kIndexBytes;
  }

  [[nodiscard]] Json Views() const {
    const std::size_t colors = num_vertices_ * kPositionBytes;
    const std::size_t indices = colors + num_vertices_ * kColorBytes;
    Json views = {View(0, colors, kVertexData), View(colors, indices - colors, kVertexData),
                  View(indices, num_bytes() - indices, kIndexData)};
    // All parts share the views of vertices, and a view that several accessors share has a stride.
    views[0]["byteStride"] = kPositionBytes;
    views[1]["byteStride"] = kColorBytes;
    return views;
  }
  /// Positions, colours and indices of the parts in turn.
  [[nodiscard]] const Json& accessors() const { return accessors_; }

 private:
  static Json View(std::size_t offset, std::size_t length, int target) {
    return {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}, {"target", target}};
  }

  void AddAccessor(int view, std::size_t offset, int type, std::size_t count, const char* shape) {
    accessors_.push_back({{"bufferView", view},
                          {"byteOffset", offset},
                          {"componentType", type},
                          {"count", count},
                          {"type", shape}});
  }

  void AddPart(const Mesh& mesh) {
    AddAccessor(0, num_vertices_ * kPositionBytes, kFloat, mesh.vertices.size(), "VEC3");
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
    accessors_.back()["min"] = {box.min().x(), box.min().y(), box.min().z()};
    accessors_.back()["max"] = {box.max().x(), box.max().y(), box.max().z()};
    AddAccessor(1, num_vertices_ * kColorBytes, kUnsignedShort, mesh.vertices.size(), "VEC4");
    accessors_.back()["normalized"] = true;
    AddAccessor(2, num_corners_ * kIndexBytes, kUnsignedInt, 3 * mesh.triangles.size(), "SCALAR");
    num_vertices_ += mesh.vertices.size();
    num_corners_ += 3 * mesh.triangles.size();
  }

  std::size_t num_vertices_ = 0;
  std::size_t num_corners_ = 0;
  Json accessors_ = Json::array();
};

/// Appends positions, colours and indices of all parts, as GlbLayout has them.
void AppendData(const std::vector<Part>& parts, const LabelTable& labels, std::string& bytes) {
  for (const Part& part : parts) {
    for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
      for (const float coordinate : vertex) AppendValue(coordinate, bytes);
    }
  }
  for (const Part& part : parts) {
    std::string color;
    for (const std::uint8_t share : labels.Find(part.label)->rgb) {
      AppendValue(LinearOf(share), color);
    }
    AppendValue(std::numeric_limits<std::uint16_t>::max(), color);  // Opaque.
    for (std::size_t i = 0; i < part.mesh.vertices.size(); ++i) bytes += color;
  }
  for (const Part& part : parts) {
    for (const auto& triangle : part.mesh.triangles) {
      for (const std::uint32_t corner : triangle) AppendValue(corner, bytes);
    }
  }
}

/// The materials that parts have, each once, in rising order.
std::vector<std::uint16_t> MaterialsOf(const ExportedWorld& exported) {
  std::vector<std::uint16_t> used;
  for (const Part& part : exported.parts) used.push_back(part.material);
  std::ranges::sort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return used;
}

/// Everything but the data: a node for each part below one that turns them, as glTF has y up.
Json SceneJson(const ExportedWorld& exported,
               const LabelTable& labels,
               const MaterialLibrary& materials) {
  const double half_turn = std::sqrt(0.5);
  const Json root = {{"name", "world"}, {"rotation", {-half_turn, 0.0, 0.0, half_turn}}};
  Json nodes = Json::array({root});
  Json meshes = Json::array();
  const std::vector<std::uint16_t> used = MaterialsOf(exported);
  for (const Part& part : exported.parts) {
    const std::size_t mesh = meshes.size();
    const auto material = std::ranges::find(used, part.material) - used.begin();
    Json primitive = {{"attributes", {{"POSITION", 3 * mesh}, {"COLOR_0", 3 * mesh + 1}}},
                      {"indices", 3 * mesh + 2},
                      {"material", material}};
    meshes.emplace_back()["primitives"] = Json::array({std::move(primitive)});
    nodes.front()["children"].push_back(nodes.size());
    nodes.push_back({{"name", labels.Find(part.label)->name}, {"mesh", mesh}});
  }
  Json named = Json::array();
  for (const std::uint16_t material : used) {
    named.push_back({{"name", materials.materials().at(material).name},
                     {"doubleSided", true},
                     {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}});
  }
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      rows.push_back(exported.world_from_export.matrix()(row, column));
    }
  }
  Json json = Json::object();
  json["asset"] = {{"version", "2.0"}, {"generator", "railcast"}};
  json["asset"]["extras"]["world_from_export"] = std::move(rows);
  json["scene"] = 0;
  json["scenes"][0]["nodes"] = Json::array({0});
  json["nodes"] = std::move(nodes);
  json["meshes"] = std::move(meshes);
  json["materials"] = std::move(named);
  return json;
}

}  // namespace

std::string EncodeGlbMesh(const ExportedWorld& exported,
                          const LabelTable& labels,
                          const MaterialLibrary& materials) {
  for (const Part& part : exported.parts) {
    Check(labels.Find(part.label) != nullptr, "a part's label is in the label table");
  }
  const GlbLayout layout(exported.parts);
  Json scene = SceneJson(exported, labels, materials);
  scene["accessors"] = layout.accessors();
  scene["bufferViews"] = layout.Views();
  scene["buffers"][0]["byteLength"] = layout.num_bytes();
  std::string json = scene.dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  constexpr std::size_t kHeaders = 12 + 8 + 8;
  const std::size_t length = kHeaders + json.size() + layout.num_bytes();
  if (length > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError("--out: a .glb file must have fewer than 4294967296 bytes" + Got(length) +
                     "; choose .ply, or a shorter stretch");
  }
  std::string bytes;
  bytes.reserve(length);
  bytes += "glTF";
  for (const std::size_t number : {std::size_t{2}, length, json.size()}) {
    AppendValue(static_cast<std::uint32_t>(number), bytes);
  }
  bytes += "JSON" + json;
  AppendValue(static_cast<std::uint32_t>(layout.num_bytes()), bytes);
  bytes.append("BIN\0", 4);
  AppendData(exported.parts, labels, bytes);
  return bytes;
}

}  // namespace railcast
