#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/objects.h"
#include "railcast/remark.h"
#include "railcast/scene.h"

namespace railcast {

/// What meshes take their materials and labels from.
struct MeshTables {
  SurfaceClass surface;  ///< The object's (SurfaceOfObject).
  const LabelTable& labels;
  const MaterialLibrary& materials;
};

/// What became of the triangles of one name in a mesh file.
struct MeshPartUse {
  std::string material;         ///< In the file; empty = none.
  std::string group;            ///< In the file; empty = none.
  std::size_t num_triangles{};  ///< In the model.
  SurfaceClass surface;
  std::string why_material;  ///< In words that name nothing from the file.
  std::string why_label;
};

/// An object made from a mesh file.
struct MeshObject {
  Model model;  ///< One part for each material and label.
  std::vector<MeshPartUse> parts;
  /// Where the mesh lies in its file's frame, in metres, z up; before `size_m` scales it.
  Eigen::AlignedBox3d file_bounds_m;
  bool has_own_up{};             ///< Whether the format of the file says which axis is up.
  std::size_t num_faces{};       ///< In the file.
  std::size_t num_flat{};        ///< Triangles left out because they have no area in float32.
  std::size_t num_cornerless{};  ///< Faces left out for lack of three different corners.
  std::vector<Remark> remarks;   ///< Of the file's reader.
  std::size_t num_read{};        ///< Triangles before the mesh was simplified.
  double deviation_m{};          ///< The greatest measured between the two; 0 if it was not.
};

/// Reads a mesh file and gives each of its parts a material and a label.
///
/// The material of a part is, in this order: that of the entry in `spec.parts` that names its
/// group; of the entry that names its material; the object's, if the spec gives one; the one that a
/// word in the name of its material, or of its group if it has no material, stands for
/// (MaterialOfName), if the library has it; the paint for its colour (PaintOfLuminance), if the
/// file gives one; and that of the object's type. Labels likewise, except
/// that no word stands for one.
///
/// With `spec.tolerance_mm`, the parts are simplified at their size in the world
/// (SimplifiedOnce()), with normals within 20 degrees of those that they stand for.
///
/// Frame: as MakeObjectModel() has it.
/// @throws InputError as MakeObjectModel() does. Faults of `parts` have the places "/parts/0/of",
///   "/parts/0/material" and "/parts/0/label".
[[nodiscard]] MeshObject MakeMeshObject(const ObjectSpec& spec, const MeshTables& tables);

/// As MakeMeshObject() for each of several files instead of that of `spec`, whose `parts` may name
/// those of any of them.
[[nodiscard]] std::vector<MeshObject> MakeMeshObjects(const ObjectSpec& spec,
                                                      std::span<const std::string> files,
                                                      const MeshTables& tables);

}  // namespace railcast
