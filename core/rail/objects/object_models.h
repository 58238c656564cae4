#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/objects/person.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/scene.h"
#include "railcast/world_spec.h"

namespace railcast {

/// The geometry of an object of the scenario. Frame: x forward (the direction of increasing
/// chainage at heading 0), y left, z up; metres. The origin is the middle of the object's footprint
/// at its foot:
/// - box, pole, person: the lowest point is at z = 0;
/// - models of a table: the origin of their mesh (railcast/objects.h); of rail vehicles z = 0 is
/// top
///   of rail, so that `h_m` = 0 puts them on the track;
/// - mesh: the middle of the file's bounding box in plan, at its lowest point, as the origin of a
///   file may be anywhere (a corner, the survey origin of a town); with origin "file" the file's
///   own. With `size_m`, each axis is scaled to its length. Materials and labels of its parts:
///   MakeMeshObject().
///
/// A person has the height in `size_m`; the other two values are ignored. `label` and `material` of
/// the spec, if given, apply to all parts.
///
/// @pre ObjectSpec::file is absolute or relative to the working directory.
/// @throws InputError with one line, `key: rule (got value)`, as ReadMesh does, or with faults
///   whose places are pointers that continue the object's.
[[nodiscard]] std::shared_ptr<const Model> MakeObjectModel(const ObjectSpec& spec,
                                                           const RailSurfaces& surfaces,
                                                           const LabelTable& labels,
                                                           const MaterialLibrary& materials);

/// How a person of the scenario is built. Its steady speed is the highest of its motion, or its
/// natural pace if it stands.
/// @pre The object is a person.
/// @throws InputError as MakeObjectModel().
[[nodiscard]] PersonBuild PersonBuildOf(const ObjectSpec& spec);

/// Whether the object is a person whose limbs move: one that walks along a track or path.
[[nodiscard]] bool WalksAbout(const ObjectSpec& spec);

/// Makes the models of objects. Objects that differ in nothing but name, place and motion share
/// one. The tables must outlive it.
class ObjectModels {
 public:
  ObjectModels(RailSurfaces surfaces, const LabelTable& labels, const MaterialLibrary& materials)
      : surfaces_(surfaces), labels_(labels), materials_(materials) {}

  using Pieces = std::vector<std::shared_ptr<const Model>>;

  /// As MakeObjectModel().
  [[nodiscard]] std::shared_ptr<const Model> Of(const ObjectSpec& spec);
  /// The body, the front bogie and the rear bogie of a rail vehicle (mesh_object.h).
  /// @throws InputError as MakeObjectModel() does.
  [[nodiscard]] Pieces VehiclePiecesOf(const ObjectSpec& spec);
  /// The pieces of a person that walks about, which WalkingPerson(PersonBuildOf(spec)) moves; other
  /// persons have none.
  [[nodiscard]] Pieces WalkingPiecesOf(const ObjectSpec& spec);

 private:
  using PersonKey = std::tuple<Posture, Physique, Clothing, Luggage, double>;
  using PartsKey =
      std::vector<std::tuple<std::string, std::optional<std::string>, std::optional<std::string>>>;
  using Shape = std::tuple<std::string,
                           std::optional<std::array<double, 3>>,
                           std::optional<std::string>,
                           std::optional<UpAxis>,
                           std::optional<double>,
                           std::optional<std::string>,
                           std::optional<std::string>,
                           double,
                           double,
                           std::optional<PersonKey>,
                           MeshOrigin,
                           double,
                           PartsKey>;
  [[nodiscard]] static Shape ShapeOf(const ObjectSpec& spec);
  /// What was made for the object's shape before, or else now.
  [[nodiscard]] Pieces PiecesOf(const ObjectSpec& spec,
                                const std::function<std::vector<Model>()>& make);

  RailSurfaces surfaces_;
  const LabelTable& labels_;
  const MaterialLibrary& materials_;
  std::map<Shape, std::shared_ptr<const Model>> models_;
  std::map<Shape, Pieces> pieces_;
};

/// Gives a person who walks about the pieces that WalkingPerson moves.
void GiveLimbs(const ObjectSpec& spec, ObjectModels& models, SceneObject& object);

/// The label of the object as a whole: the spec's or else that of its type.
/// @throws InputError if the type or the label is unknown.
[[nodiscard]] std::uint32_t ObjectLabel(const ObjectSpec& spec,
                                        const RailSurfaces& surfaces,
                                        const LabelTable& labels);

/// The material and label of the object as a whole: the spec's or else those of its type.
/// @throws InputError as ObjectLabel() does, and if the material is unknown.
[[nodiscard]] SurfaceClass SurfaceOfObject(const ObjectSpec& spec,
                                           const RailSurfaces& surfaces,
                                           const LabelTable& labels,
                                           const MaterialLibrary& materials);

}  // namespace railcast
