#include "generator/world/world_export.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/field_layout.h"
#include "core/scene/object_pieces.h"

namespace railcast {
namespace {

// Sizes in PLY.
constexpr std::size_t kVertexBytes = 3 * sizeof(float);
constexpr std::size_t kFaceBytes = 1 + 3 * 4 + 3 + 4 + 4;

std::string TransformText(const Transform& transform) {
  std::string text;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      text += ' ';
      text += NumberText(transform.matrix()(row, column));
    }
  }
  return text;
}

const Label& LabelOf(const Part& part, const LabelTable& labels) {
  const Label* label = labels.Find(part.label);
  Check(label != nullptr, "a part's label is in the label table");
  return *label;
}

void AppendVertices(const Part& part, std::string& bytes) {
  for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
    const std::array<float, 3> position = {vertex.x(), vertex.y(), vertex.z()};
    std::array<char, sizeof position> stored{};
    std::memcpy(stored.data(), position.data(), sizeof position);
    bytes.append(stored.data(), stored.size());
  }
}

void AppendFaces(const Part& part, const Label& label, std::uint32_t base, std::string& bytes) {
  std::array<char, kFaceBytes> stored{};
  stored[0] = 3;
  std::memcpy(&stored[13], label.rgb.data(), 3);
  StoreAt<std::int32_t>(&stored[16], part.label);
  StoreAt<std::int32_t>(&stored[20], part.material);
  for (const auto& triangle : part.mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      StoreAt<std::int32_t>(&stored[1 + 4 * i], base + triangle[i]);
    }
    bytes.append(stored.data(), stored.size());
  }
}

}  // namespace

std::vector<int> ChunksOfObjects(const RailWorld& world, std::int64_t time_ns) {
  const double last = std::ceil(world.alignment().length_m() / RailWorld::kChunkLength_m) - 1.0;
  std::vector<int> chunks;
  for (std::size_t i = 0; i < world.objects().size(); ++i) {
    const double s_m = world.ObjectChainage_m(i, time_ns);
    chunks.push_back(
        static_cast<int>(std::clamp(std::floor(s_m / RailWorld::kChunkLength_m), 0.0, last)));
  }
  return chunks;
}

ExportedWorld ExportWorld(const World& world,
                          const std::vector<int>& chunks,
                          const std::vector<int>& object_chunks,
                          std::int64_t time_ns,
                          const std::function<void(std::size_t, const MeshSize&)>& on_progress) {
  Check(object_chunks.size() == world.objects().size(), "every object belongs to a chunk");
  ExportedWorld exported;
  exported.world_from_export = world.WorldFromChunk(chunks.front());
  const Transform export_from_world = exported.world_from_export.inverse();
  PartGatherer gatherer;
  std::size_t num_gathered = 0;
  for (const int index : chunks) {
    const Transform export_from_chunk = export_from_world * world.WorldFromChunk(index);
    const Chunk chunk = world.BuildChunk(index);
    gatherer.Add(chunk.ground, Eigen::Affine3d(export_from_chunk));
    for (const Placement& placement : chunk.placements) {
      gatherer.Add(*placement.model, export_from_chunk * placement.chunk_from_model);
    }
    for (std::size_t i = 0; i < object_chunks.size(); ++i) {
      if (object_chunks[i] != index) continue;
      const std::vector<Transform> world_from_pieces = world.WorldFromPieces(i, time_ns);
      for (std::size_t piece = 0; piece < world_from_pieces.size(); ++piece) {
        gatherer.Add(*PieceOf(world.objects()[i], piece),
                     Eigen::Affine3d(export_from_world * world_from_pieces[piece]));
      }
    }
    on_progress(++num_gathered, gatherer.size());
  }
  exported.parts = gatherer.TakeParts();
  return exported;
}

std::string EncodePlyMesh(const ExportedWorld& exported, const LabelTable& labels) {
  std::size_t num_vertices = 0;
  std::size_t num_faces = 0;
  for (const Part& part : exported.parts) {
    num_vertices += part.mesh.vertices.size();
    num_faces += part.mesh.triangles.size();
  }
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment world_from_export" +
                      TransformText(exported.world_from_export) + "\nelement vertex " +
                      std::to_string(num_vertices) +
                      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                      std::to_string(num_faces) +
                      "\nproperty list uchar int vertex_indices\nproperty uchar red\n"
                      "property uchar green\nproperty uchar blue\nproperty int label\n"
                      "property int material\nend_header\n";
  bytes.reserve(bytes.size() + num_vertices * kVertexBytes + num_faces * kFaceBytes);
  for (const Part& part : exported.parts) AppendVertices(part, bytes);
  std::uint32_t base = 0;
  for (const Part& part : exported.parts) {
    AppendFaces(part, LabelOf(part, labels), base, bytes);
    base += static_cast<std::uint32_t>(part.mesh.vertices.size());
  }
  return bytes;
}

std::string EncodeObjMesh(const ExportedWorld& exported,
                          const LabelTable& labels,
                          const MaterialLibrary& materials) {
  std::string text = "# world_from_export" + TransformText(exported.world_from_export) + "\n";
  std::uint32_t base = 1;  // OBJ counts from 1.
  const Label* current = nullptr;
  for (const Part& part : exported.parts) {
    const Label& label = LabelOf(part, labels);
    if (&label != current) text += "o " + label.name + "\n";
    current = &label;
    text += "usemtl " + materials.materials().at(part.material).name + "\n";
    for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
      text += 'v';
      for (const float value : {vertex.x(), vertex.y(), vertex.z()}) {
        text += ' ';
        text += NumberText(value);
      }
      text += '\n';
    }
    for (const auto& triangle : part.mesh.triangles) {
      text += 'f';
      for (const std::uint32_t index : triangle) {
        text += ' ';
        text += NumberText(base + index);
      }
      text += '\n';
    }
    base += static_cast<std::uint32_t>(part.mesh.vertices.size());
  }
  return text;
}

}  // namespace railcast
