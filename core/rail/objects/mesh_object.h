#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/objects.h"
#include "railcast/remark.h"
#include "railcast/scene.h"
#include "railcast/world_spec.h"

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
  std::vector<Remark> remarks;   ///< Remarks of the file's reader.
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

/// Does MakeMeshObject() for each of `files` in place of the spec's own. Entries of `spec.parts`
/// may name parts of any of these files.
[[nodiscard]] std::vector<MeshObject> MakeMeshObjects(const ObjectSpec& spec,
                                                      std::span<const std::string> files,
                                                      const MeshTables& tables);

/// Main dimensions of a rail vehicle, as its table of models has them.
struct RailVehicleMeasures {
  double length_m{};          ///< Over buffers or couplers.
  double pivot_distance_m{};  ///< Between the pivots of the two bogies.
  double width_m{};
  double height_m{};  ///< Above top of rail; with a raised pantograph, that of its contact strip.
};

/// @pre IsRailVehicle(type).
[[nodiscard]] RailVehicleMeasures MeasuresOf(const ObjectType& type);

/// The whole vehicle on straight track: the body with its bogies half of `pivot_distance_m` before
/// and behind the middle.
[[nodiscard]] Model WholeOf(const Model& body, const Model& bogie, double pivot_distance_m);

/// Things that a table of models describes, as opposed to shapes that code makes.

/// The pieces of a model, of which only a rail vehicle has two: its body, with the origin midway
/// between the pivots, and either bogie, with the origin in its pivot's axis. Parts have materials
/// and labels as those of a mesh object have (mesh_object.h), with `otherwise` for a material that
/// nothing says.
/// @pre The type has a model.
/// @throws InputError as CheckNamesOfModel(), and for a model of the scenario's own table with
///   faults whose places begin with "/models/" and its place there.
[[nodiscard]] std::vector<Model> MakeTableModel(const ObjectType& type,
                                                std::uint16_t otherwise,
                                                const LabelTable& labels,
                                                const MaterialLibrary& materials);

/// @throws InputError with a line for every name of the type's model, if it has one, that the
/// tables
///   lack, if both could be read.
void CheckNamesOfModel(const ObjectType& type,
                       const LabelTable& labels,
                       const MaterialLibrary& materials);

/// Whether objects of the type may have surfaces of the material.
[[nodiscard]] bool MayHaveMaterial(const ObjectType& type, std::string_view name);

}  // namespace railcast
