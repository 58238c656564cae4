#include "tests/core/rail/shipped_models.h"

#include <algorithm>

#include "core/rail/objects/mesh_object.h"
#include "core/scenario/object_types.h"
#include "tests/core/rail/test_tables.h"

namespace railcast {

std::vector<Model> PiecesOfModel(const ObjectType& type) {
  return MakeTableModel(type, 0, RailLabels(), RailMaterials());
}

Model WholeModel(const ObjectType& type) {
  const std::vector<Model> pieces = PiecesOfModel(type);
  if (!IsRailVehicle(type)) return pieces.front();
  return WholeOf(pieces.front(), pieces.back(), MeasuresOf(type).pivot_distance_m);
}

std::vector<ObjectType> TypesLabelled(const std::vector<std::string>& labels) {
  std::vector<ObjectType> types = ShippedTypes();
  std::erase_if(types, [&](const ObjectType& type) {
    return std::ranges::find(labels, type.model->label) == labels.end();
  });
  return types;
}

SurfaceClass SurfaceNamed(const std::string& material, const std::string& label) {
  return {RailMaterials().Index(material), RailLabels().Id(label)};
}

}  // namespace railcast
