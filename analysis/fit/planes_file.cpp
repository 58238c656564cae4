#include <utility>

#include "analysis/fit/known_planes.h"
#include "core/base/error.h"
#include "core/scenario/json_reader.h"
#include "core/scenario/json_rules.h"

namespace railcast {
namespace {

using Triple = std::array<double, 3>;

/// A plane as the file has it.
struct PlaneSpec {
  std::string name;
  std::string material;
  Triple point_m{};
  Triple normal{};
  std::optional<double> radius_m;
  std::vector<Triple> corners_m;
};

struct PlanesFile {
  std::vector<PlaneSpec> planes;
};

double Length(const Triple& vector) {
  return Eigen::Map<const Vector3>(vector.data()).norm();
}

template <class Archive>
void Describe(Archive& a, PlaneSpec& s) {
  a.Required("name", s.name, "Unique.", NonEmptyString());
  a.Optional("material", s.material, "Planes of one material share a reflectance.");
  a.Required("point_m", s.point_m, "On the plane, in the sensor's axes.", Within(-1e4, 1e4));
  a.Required("normal", s.normal, "Of any length.", Within(-1e4, 1e4));
  a.Optional("radius_m", s.radius_m, "Extent about point_m.", Positive());
  a.Optional("corners_m", s.corners_m, "Or extent as a convex polygon.");
  a.Ensure({"normal"}, Length(s.normal) > 0.0, "must not be [0, 0, 0]");
  a.Ensure({"radius_m", "corners_m"}, s.radius_m.has_value() != !s.corners_m.empty(),
           "must be either radius_m or corners_m");
  a.Ensure({"corners_m"}, s.corners_m.empty() || s.corners_m.size() >= 3,
           "must have at least 3 corners");
}

template <class Archive>
void Describe(Archive& a, PlanesFile& s) {
  a.Required("planes", s.planes, "What the sensor looks at.", NonEmptyList());
  a.Unique("planes", s.planes, "name", &PlaneSpec::name);
}

Vector3 ToVector(const Triple& triple) {
  return {triple[0], triple[1], triple[2]};
}

}  // namespace

std::vector<KnownPlane> ReadKnownPlanes(const std::filesystem::path& file) {
  JsonSource source;
  PlanesFile content;
  if (const auto root = source.Open(file)) ReadValue(source, *root, content, Anything{});
  source.errors().ThrowIfAny();
  std::vector<KnownPlane> planes;
  for (const PlaneSpec& spec : content.planes) {
    KnownPlane plane{spec.name,
                     spec.material,
                     ToVector(spec.point_m),
                     ToVector(spec.normal).normalized(),
                     spec.radius_m,
                     {}};
    for (const Triple& corner : spec.corners_m) plane.corners_m.push_back(ToVector(corner));
    planes.push_back(std::move(plane));
  }
  return planes;
}

}  // namespace railcast
