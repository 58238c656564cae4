#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/fit/known_planes.h"
#include "core/base/error.h"
#include "tests/fuzz/fault_lines.h"
#include "tests/fuzz/input_files.h"

namespace railcast {
namespace {

using Json = nlohmann::json;

Json Numbers(const Vector3& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

std::string PlanesText(const std::vector<KnownPlane>& planes) {
  Json list = Json::array();
  for (const KnownPlane& plane : planes) {
    Json json = {{"name", plane.name},
                 {"material", plane.material},
                 {"point_m", Numbers(plane.point_m)},
                 {"normal", Numbers(plane.normal)}};
    if (plane.radius_m) json["radius_m"] = *plane.radius_m;
    for (const Vector3& corner_m : plane.corners_m) json["corners_m"].push_back(Numbers(corner_m));
    list.push_back(std::move(json));
  }
  return Json{{"version", 1}, {"planes", std::move(list)}}.dump();
}

void CheckPlane(const KnownPlane& plane) {
  constexpr double kTolerance = 1e-12;
  Check(!plane.name.empty() && !plane.surface().empty(), "a plane has a name");
  Check(plane.point_m.allFinite(), "a plane is somewhere");
  Check(std::abs(plane.normal.norm() - 1.0) < kTolerance, "a normal has length 1");
  Check(plane.radius_m.has_value() == plane.corners_m.empty(), "a plane has one extent");
  Check(!plane.radius_m || *plane.radius_m > 0.0, "a radius is one");
  for (const Vector3& corner_m : plane.corners_m) Check(corner_m.allFinite(), "a corner is, too");
}

void ReadPlanes(std::string_view input) {
  try {
    const InputFiles files(input);
    const std::vector<KnownPlane> planes = ReadKnownPlanes(InputFiles::first());
    Check(!planes.empty(), "a file has planes");
    for (const KnownPlane& plane : planes) CheckPlane(plane);
    const std::vector<KnownPlane> again =
        ReadKnownPlanes(InputFiles::Write("written.json", PlanesText(planes)));
    Check(again.size() == planes.size(), "what is written is read");
    for (std::size_t i = 0; i < planes.size(); ++i) {
      Check(again[i].name == planes[i].name && again[i].surface() == planes[i].surface() &&
                again[i].point_m == planes[i].point_m && again[i].radius_m == planes[i].radius_m &&
                again[i].corners_m == planes[i].corners_m,
            "and says the same");
    }
  } catch (const InputError& error) {
    CheckFaultLines(error.what());
  }
}

}  // namespace
}  // namespace railcast

/// What libFuzzer calls: a file of planes and others that it names, as InputFiles has them.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  railcast::ReadPlanes({reinterpret_cast<const char*>(data), size});
  return 0;
}
