#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace railcast {

/// The kinds of mesh files. Those from kGltf on are scenes, which assimp reads for railcast.
enum class MeshFormat { kObj, kPly, kAsciiStl, kBinaryStl, kOff, kGltf, kGlb, kFbx, kDae, k3ds };

/// Whether assimp reads it.
[[nodiscard]] constexpr bool IsScene(MeshFormat format) {
  return format >= MeshFormat::kGltf;
}

/// The format that a file's content is like; the extension counts only for OBJ files without
/// vertices.
[[nodiscard]] std::optional<MeshFormat> MeshFormatOf(const std::string& bytes,
                                                     const std::filesystem::path& file);

/// A binary STL file that has another length than its header says.
struct UnevenStl {
  std::size_t num_triangles{};  ///< By its header.
  std::size_t num_bytes{};      ///< Bytes that they take with the header.
};

/// What a file of no known format is if its name ends in .stl, or if it ends too soon and the
/// triangles that are whole are near enough to be a model's.
[[nodiscard]] std::optional<UnevenStl> UnevenStlOf(const std::string& bytes,
                                                   const std::filesystem::path& file);

}  // namespace railcast
