#include "core/scenario/descriptions.h"

#include <vector>

#include "railcast/objects.h"

namespace railcast {

// The tables of models: railcast's own, scenarios/models/models.json, and those of users.

void Describe(Archive& a, RailVehicleSpec& s) {
  a.Required("pivot_distance_m", s.pivot_distance_m, "Between the pivots of the two bogies.",
             PositiveUpTo(100));
  a.Required("bogie", s.bogie,
             "Mesh of either bogie; its origin is in the pivot's axis at top of rail.",
             ExistingFile());
}

void Describe(Archive& a, OsdarSpec& s) {
  a.Required("class", s.class_name, "Class in OSDaR23.", NonEmptyString());
  a.Optional("type", s.type, "Attribute type, of vehicles.", NonEmptyString());
  a.Optional("species", s.species, "Attribute species, of animals.", NonEmptyString());
  a.Optional("pose", s.pose, "Attribute pose, of animals.", NonEmptyString());
}

void Describe(Archive& a, ModelSpec& s) {
  a.Required("name", s.name, "Unique; the type of objects and of trains' vehicles.",
             NonEmptyString());
  a.Required("file", s.file,
             "Its mesh, x forward and z up: OBJ, PLY, STL, OFF, glTF, FBX, DAE or 3DS, or one of "
             "railcast's own, such as railcast:car.ply.",
             ExistingFile());
  a.Required("label", s.label, "Name of a label.", NonEmptyString());
  a.Required("size_m", s.size_m,
             "Length, width, and height above the origin, within 2 cm or 1 %; vehicles couple at "
             "the ends of their length.",
             Within(1e-3, 1000));
  a.Optional("parts", s.parts, "Materials and labels of parts of the mesh.");
  a.Optional("material", s.material, "Material of parts that nothing else gives one.");
  a.Optional("up", s.up, "Upward axis of the mesh; absent: as its file says, otherwise z.");
  a.Optional("unit_m", s.unit_m, "Metres per file unit; absent: as the file says, otherwise 1.",
             Within(1e-6, 1e6));
  a.Optional("origin", s.origin,
             "Point of the mesh that stands at the object's place: the origin of its file or the "
             "foot of its bounding box.");
  a.Optional("tolerance_mm", s.tolerance_mm,
             "How far the surfaces of a simplified mesh may be from those of its file; 0 = it "
             "stays as it is.",
             Within(0, 100));
  a.Optional("rail_vehicle", s.rail_vehicle,
             "Makes it run on rails, on two bogies; the mesh's origin is midway between their "
             "pivots at top of rail.");
  a.Optional("lies_on_rail", s.lies_on_rail,
             "Without h_m it is at top of rail, not on the ground.");
  a.Optional("osdar", s.osdar, "Class and attributes in OSDaR; absent: the label's class.");
  a.Optional("kitti", s.kitti, "Class in KITTI's benchmark; absent: the label's class.",
             NonEmptyString());
  a.Ensure({"origin", "rail_vehicle"}, s.origin == MeshOrigin::kFile || !s.rail_vehicle,
           "must be \"file\" for a rail vehicle, whose pivots are about it");
  a.Ensure({"lies_on_rail", "rail_vehicle"}, !s.lies_on_rail || !s.rail_vehicle,
           "must not be given beside rail_vehicle");
}

void Describe(Archive& a, ModelFile& s) {
  a.Required("models", s.models, "The models.", NonEmptyList());
  a.Unique("models", s.models, "name", &ModelSpec::name);
}

}  // namespace railcast
