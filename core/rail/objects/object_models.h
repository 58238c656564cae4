#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "core/rail/rail_surfaces.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/rail_world.h"
#include "railcast/scene.h"

namespace railcast {

inline constexpr double kPersonHeight_m = 1.75;

/// An adult in working clothes in mid-stride, about 1700 triangles. Frame: origin on the ground
/// between the feet, x in the direction of view, y left, z up; metres. Proportions are those of a
/// median adult (DIN 33402-2), scaled uniformly to exactly `height_m`.
[[nodiscard]] Model MakePerson(const RailSurfaces& surfaces, double height_m = kPersonHeight_m);

/// Freight wagons of 5700 to 6600 triangles each. Frame: origin in the middle of the wagon at top
/// of rail, x along it, y left, z up; metres. The flanges reach kFlangeHeight_m below the origin.
/// Dimensions: docs/physics.md 7.3 (DB Cargo's wagon catalogue, UIC standard parts).

/// Eaos, a high-sided open wagon: 14.04 over buffers, pivots 9.0 apart, floor 1.24 above top of
/// rail, inside 12.8 x 2.76 x 2.10, 3.0 wide.
[[nodiscard]] Model MakeOpenWagon(const RailSurfaces& surfaces);

/// Sgns, a 60-foot container wagon without floor: 19.74 over buffers, pivots 14.2 apart,
/// fish-bellied side sills, container supports 1.16 above top of rail with spigots on top.
[[nodiscard]] Model MakeFlatWagon(const RailSurfaces& surfaces);

/// Zacns, a tank wagon: 16.0 over buffers, pivots 10.5 apart, tank of 2.9 diameter, manhole cover
/// 4.27 above top of rail, with ladders, walkway and end platform.
[[nodiscard]] Model MakeTankWagon(const RailSurfaces& surfaces);

/// The geometry of an object of the scenario. Frame: x forward (the direction of increasing
/// chainage at heading 0), y left, z up; metres. The origin is the middle of the object's footprint
/// at its foot:
/// - box, pole, person: the lowest point is at z = 0;
/// - wagons: z = 0 is top of rail, so that `h_m` = 0 puts them on the track;
/// - mesh: the middle of the file's bounding box in plan, at its lowest point. The origin of a file
///   may be anywhere (a corner, the survey origin of a town), whereas track coordinates refer to
///   the middle of the object. With `size_m`, each axis is scaled to its length.
///
/// A person is scaled to the height in `size_m`; the other two values are ignored. `label` and
/// `material` of the spec, if given, apply to all parts.
///
/// @pre ObjectSpec::file is absolute or relative to the working directory.
/// @throws InputError with one line, `key: rule (got value)`, or as ReadMesh does.
[[nodiscard]] std::shared_ptr<const Model> MakeObjectModel(const ObjectSpec& spec,
                                                           const RailSurfaces& surfaces,
                                                           const LabelTable& labels,
                                                           const MaterialLibrary& materials);

/// Makes the models of objects. Objects that differ in nothing but name, place and motion share
/// one. The tables must outlive it.
class ObjectModels {
 public:
  ObjectModels(RailSurfaces surfaces, const LabelTable& labels, const MaterialLibrary& materials)
      : surfaces_(std::move(surfaces)), labels_(labels), materials_(materials) {}

  /// As MakeObjectModel().
  [[nodiscard]] std::shared_ptr<const Model> Of(const ObjectSpec& spec);

 private:
  using Shape = std::tuple<ObjectType,
                           std::optional<std::array<double, 3>>,
                           std::optional<std::string>,
                           std::optional<UpAxis>,
                           std::optional<double>,
                           std::optional<std::string>,
                           std::optional<std::string>>;

  RailSurfaces surfaces_;
  const LabelTable& labels_;
  const MaterialLibrary& materials_;
  std::map<Shape, std::shared_ptr<const Model>> models_;
};

/// The label of the object as a whole: the spec's or else that of its type.
/// @throws InputError if the type or the label is unknown.
[[nodiscard]] std::uint32_t ObjectLabel(const ObjectSpec& spec,
                                        const RailSurfaces& surfaces,
                                        const LabelTable& labels);

}  // namespace railcast
