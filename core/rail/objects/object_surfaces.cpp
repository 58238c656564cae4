#include "core/rail/objects/object_surfaces.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/rail/objects/animals.h"
#include "core/rail/objects/debris.h"
#include "core/rail/objects/road_vehicles.h"

namespace railcast {
namespace {

/// @tparam Surfaces The struct that has the surface.
template <class Surfaces>
struct ObjectSurfaceRow {
  SurfaceClass Surfaces::*surface;
  std::string_view material;
  std::string_view label;
};

constexpr ObjectSurfaceRow<RoadVehicleSurfaces> kRoadVehicleRows[] = {
    {&RoadVehicleSurfaces::paint, "car_paint", "road_vehicle"},
    {&RoadVehicleSurfaces::panel, "white_paint", "road_vehicle"},
    {&RoadVehicleSurfaces::window, "glass", "road_vehicle"},
    {&RoadVehicleSurfaces::trim, "black_paint", "road_vehicle"},
    {&RoadVehicleSurfaces::metal, "grey_paint", "road_vehicle"},
    {&RoadVehicleSurfaces::tyre, "black_rubber", "road_vehicle"},
    {&RoadVehicleSurfaces::reflector, "retro_sheeting", "road_vehicle"},
};

constexpr ObjectSurfaceRow<AnimalSurfaces> kAnimalRows[] = {
    {&AnimalSurfaces::coat, "fur", "animal"},
    {&AnimalSurfaces::horn, "horn", "animal"},
};

constexpr ObjectSurfaceRow<DebrisSurfaces> kDebrisRows[] = {
    {&DebrisSurfaces::wood, "wood", "object"},
    {&DebrisSurfaces::tyre, "black_rubber", "object"},
    {&DebrisSurfaces::stone, "ballast", "object"},
    {&DebrisSurfaces::soil, "soil", "object"},
    {&DebrisSurfaces::leaf, "leaf", "tree"},
    {&DebrisSurfaces::bark, "bark", "tree"},
    {&DebrisSurfaces::wire, "copper_wire", "contact_wire"},
    {&DebrisSurfaces::shoe_paint, "red_paint", "object"},
    {&DebrisSurfaces::shoe_iron, "rusty_steel", "object"},
};

constexpr ObjectSurfaceRow<PersonSurfaces> kPersonRows[] = {
    {&PersonSurfaces::skin, "skin", "person"},
    {&PersonSurfaces::clothing, "clothing", "person"},
};

constexpr ObjectSurfaceRow<PersonSurfaces> kHiVisRows[] = {
    {&PersonSurfaces::hi_vis_fabric, "hi_vis_fabric", "person"},
    {&PersonSurfaces::hi_vis_band, "hi_vis_band", "person"},
    {&PersonSurfaces::helmet, "plastic", "person"},
};

constexpr ObjectSurfaceRow<PersonSurfaces> kLuggageRows[] = {
    {&PersonSurfaces::suitcase, "plastic", "person"},
    {&PersonSurfaces::frame, "grey_paint", "person"},
    {&PersonSurfaces::tyre, "black_rubber", "person"},
    {&PersonSurfaces::canvas, "clothing", "person"},
    {&PersonSurfaces::reflector, "retro_sheeting", "person"},
};

/// Looks up surfaces and remembers the names that the tables lack, each once.
class SurfaceFinder {
 public:
  SurfaceFinder(const LabelTable& labels, const MaterialLibrary& materials)
      : labels_(labels), materials_(materials) {}

  template <class Surfaces, std::size_t kCount>
  void Find(const ObjectSurfaceRow<Surfaces> (&rows)[kCount], Surfaces& surfaces) {
    constexpr std::size_t kNoMaterials = 1;  // But that with index 0.
    const std::vector<Material>& all = materials_.materials();
    if (labels_.labels().empty() || all.size() <= kNoMaterials) return;
    for (const ObjectSurfaceRow<Surfaces>& row : rows) {
      const auto material = std::find_if(all.begin(), all.end(), [&](const Material& candidate) {
        return candidate.name == row.material;
      });
      const Label* label = labels_.Find(row.label);
      if (material == all.end()) missing_.insert("material \"" + std::string(row.material));
      if (label == nullptr) missing_.insert("label \"" + std::string(row.label));
      if (material == all.end() || label == nullptr) continue;
      surfaces.*row.surface = {static_cast<std::uint16_t>(material - all.begin()), label->id};
    }
  }
  /// @param key Of the object, which requires the names.
  void ThrowIfAnyIsMissing(const std::string& key) const {
    ErrorList errors;
    for (const std::string& what : missing_) errors.AddLine(key + ": requires the " + what + '"');
    errors.ThrowIfAny();
  }

 private:
  const LabelTable& labels_;
  const MaterialLibrary& materials_;
  std::set<std::string> missing_;
};

template <class Surfaces, std::size_t kCount>
Surfaces FindSurfaces(const ObjectSurfaceRow<Surfaces> (&rows)[kCount],
                      const LabelTable& labels,
                      const MaterialLibrary& materials) {
  Surfaces surfaces;
  SurfaceFinder finder(labels, materials);
  finder.Find(rows, surfaces);
  finder.ThrowIfAnyIsMissing("type");
  return surfaces;
}

template <class Surfaces, std::size_t kCount>
bool HasMaterial(const ObjectSurfaceRow<Surfaces> (&rows)[kCount], std::string_view name) {
  return std::any_of(std::begin(rows), std::end(rows),
                     [&](const auto& row) { return row.material == name; });
}

}  // namespace

PersonSurfaces FindPersonSurfaces(const PersonSpec& look,
                                  const LabelTable& labels,
                                  const MaterialLibrary& materials) {
  PersonSurfaces surfaces;
  SurfaceFinder finder(labels, materials);
  finder.Find(kPersonRows, surfaces);
  if (look.clothing == Clothing::kHiVis) finder.Find(kHiVisRows, surfaces);
  if (look.luggage != Luggage::kNone) finder.Find(kLuggageRows, surfaces);
  finder.ThrowIfAnyIsMissing("person");
  return surfaces;
}

RoadVehicleSurfaces FindRoadVehicleSurfaces(const LabelTable& labels,
                                            const MaterialLibrary& materials) {
  return FindSurfaces(kRoadVehicleRows, labels, materials);
}

AnimalSurfaces FindAnimalSurfaces(const LabelTable& labels, const MaterialLibrary& materials) {
  return FindSurfaces(kAnimalRows, labels, materials);
}

DebrisSurfaces FindDebrisSurfaces(const LabelTable& labels, const MaterialLibrary& materials) {
  return FindSurfaces(kDebrisRows, labels, materials);
}

std::string_view LabelNameOf(ObjectType type) {
  if (type == ObjectType::kPerson) return "person";
  if (IsRoadVehicle(type)) return "road_vehicle";
  if (IsAnimal(type)) return "animal";
  if (type == ObjectType::kBranch || type == ObjectType::kFallenTree) return "tree";
  return type == ObjectType::kHangingWire ? "contact_wire" : "object";
}

bool IsMaterialOf(ObjectType type, std::string_view name) {
  return (IsRoadVehicle(type) && HasMaterial(kRoadVehicleRows, name)) ||
         (IsAnimal(type) && HasMaterial(kAnimalRows, name)) ||
         (IsDebris(type) && HasMaterial(kDebrisRows, name));
}

}  // namespace railcast
