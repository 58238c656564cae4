#include "generator/check/check_report.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/rail/objects/mesh_object.h"
#include "core/rail/objects/object_models.h"
#include "railcast/remark.h"

namespace railcast {
namespace {

constexpr double kLargest_m = 100.0;
constexpr double kSmallest_m = 0.01;

/// What an object's model depends on: all else is as in a new spec.
ObjectSpec OfModelAlone(const ObjectSpec& object) {
  ObjectSpec spec;
  spec.type = object.type;
  spec.size_m = object.size_m;
  spec.file = object.file;
  spec.up = object.up;
  spec.unit_m = object.unit_m;
  spec.label = object.label;
  spec.material = object.material;
  spec.origin = object.origin;
  spec.parts = object.parts;
  spec.tolerance_mm = object.tolerance_mm;
  return spec;
}

/// Objects with the same model.
struct MeshUsers {
  ObjectSpec spec;
  std::vector<const ObjectSpec*> objects;
};

std::vector<MeshUsers> UsersOfMeshes(std::span<const ObjectSpec> objects) {
  std::vector<MeshUsers> users;
  for (const ObjectSpec& object : objects) {
    if (object.type != ObjectType::kMesh) continue;
    const ObjectSpec spec = OfModelAlone(object);
    auto same = users.begin();
    while (same != users.end() && same->spec != spec) ++same;
    if (same == users.end()) same = users.insert(same, {.spec = spec, .objects = {}});
    same->objects.push_back(&object);
  }
  return users;
}

double AreaOf_m2(const Model& model) {
  double area_m2 = 0.0;
  for (const Part& part : model.parts) {
    for (const auto& [a, b, c] : part.mesh.triangles) {
      const Vector3 origin = part.mesh.vertices[a].cast<double>();
      const Vector3 ab = part.mesh.vertices[b].cast<double>() - origin;
      const Vector3 ac = part.mesh.vertices[c].cast<double>() - origin;
      area_m2 += 0.5 * ab.cross(ac).norm();
    }
  }
  return area_m2;
}

std::string CountText(std::size_t count, const char* thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

std::string LeftOutText(const MeshObject& mesh) {
  std::string text;
  if (mesh.num_flat > 0) text = CountText(mesh.num_flat, "triangle") + " without area";
  if (mesh.num_cornerless > 0) {
    text += (text.empty() ? "" : " and ") + CountText(mesh.num_cornerless, "face") +
            " with fewer than three different corners";
  }
  if (!text.empty()) text = ReportLine("", "left out: " + text);
  for (Remark remark : mesh.remarks) {
    remark.place.clear();
    text += ReportLine("", "remark: " + remark.Text());
  }
  return text;
}

/// How far the mesh was simplified.
std::string SimplifiedText(const ObjectSpec& spec, const MeshObject& mesh) {
  if (spec.tolerance_mm == 0.0) return "";
  const std::size_t num_left = mesh.model.num_triangles();
  const std::string tolerance = "simplified to " + ShortText(spec.tolerance_mm) + " mm: ";
  if (num_left == mesh.num_read) {
    return ReportLine("", tolerance + "no triangle can be left out");
  }
  return ReportLine("", tolerance + std::to_string(num_left) + " of " +
                            CountText(mesh.num_read, "triangle") + ", deviation " +
                            ShortText(1e3 * mesh.deviation_m) + " mm");
}

/// One line for each name and what became of it.
std::string PartsText(const MeshObject& mesh,
                      const LabelTable& labels,
                      const MaterialLibrary& materials) {
  constexpr std::size_t kMostLines = 50;
  std::vector<std::pair<std::string, std::size_t>> lines;  // With their triangles.
  std::map<std::string, std::size_t> line_of;
  for (const MeshPartUse& part : mesh.parts) {
    const std::string& name = part.material.empty() ? part.group : part.material;
    const Label* label = labels.Find(part.surface.label);
    const std::string line =
        (name.empty() ? "no name" : Quoted(name)) + ": material " +
        ShownText(materials.materials().at(part.surface.material).name) + " (" + part.why_material +
        "), label " +
        (label == nullptr ? std::to_string(part.surface.label) : ShownText(label->name)) + " (" +
        part.why_label + "), ";
    const auto [it, is_new] = line_of.try_emplace(line, lines.size());
    if (is_new) lines.emplace_back(line, 0);
    lines[it->second].second += part.num_triangles;
  }
  std::string text;
  for (std::size_t i = 0; i < std::min(lines.size(), kMostLines); ++i) {
    text += ReportLine("", lines[i].first + CountText(lines[i].second, "triangle"));
  }
  if (lines.size() > kMostLines) {
    text += ReportLine("", "and " + CountText(lines.size() - kMostLines, "more name"));
  }
  return text;
}

/// Whether it stands on the ground of a file with y up, although z is taken to be up.
bool SeemsToHaveYUp(const ObjectSpec& spec, const MeshObject& mesh) {
  if (mesh.has_own_up || spec.up == UpAxis::kY) return false;
  const Vector3& min = mesh.file_bounds_m.min();
  const Vector3& max = mesh.file_bounds_m.max();
  const Vector3 size = mesh.file_bounds_m.sizes();
  constexpr double kOnPlane = 0.02;
  constexpr double kThroughPlane = 0.25;
  return (size.array() > 0.0).all() && std::abs(min.y()) <= kOnPlane * size.y() &&
         min.z() < -kThroughPlane * size.z() && max.z() > kThroughPlane * size.z();
}

std::string WarningsText(const ObjectSpec& object, const MeshObject& mesh) {
  const Eigen::AlignedBox3d box = mesh.model.Bounds();
  std::string text;
  const auto warn = [&](const std::string& what) {
    text += ReportLine("", "WARNING: " + Quoted(object.name) + " " + what);
  };
  const double extent_m = box.sizes().maxCoeff();
  if (extent_m > kLargest_m) warn("is larger than 100 m: is its unit right?");
  if (extent_m < kSmallest_m) warn("is smaller than 1 cm: is its unit right?");
  const double below_m = -box.min().z() - object.h_m.value_or(0.0);
  const bool leans = object.roll_deg != 0.0 || object.pitch_deg != 0.0;
  if (object.origin == MeshOrigin::kFile && !leans && below_m > 0.5 * box.sizes().z()) {
    warn("is mostly below " + std::string(object.h_m ? "top of rail" : "the ground") +
         ", down to " + ShortText(below_m) + " m: is its origin right?");
  }
  if (SeemsToHaveYUp(object, mesh)) {
    warn("stands on the plane y = 0 of its file, not on z = 0: is its up \"y\"?");
  }
  return text;
}

}  // namespace

std::string MeshesText(std::span<const ObjectSpec> objects,
                       const LabelTable& labels,
                       const MaterialLibrary& materials) {
  const std::vector<MeshUsers> all = UsersOfMeshes(objects);
  if (all.empty()) return "";
  const RailSurfaces surfaces(labels, materials);
  std::string text;
  for (const MeshUsers& users : all) {
    const MeshObject mesh = MakeMeshObject(
        users.spec, {SurfaceOfObject(users.spec, surfaces, labels, materials), labels, materials});
    const Vector3 size_m = mesh.model.Bounds().sizes();
    const std::size_t others = users.objects.size() - 1;
    text += ReportLine(text.empty() ? "meshes" : "",
                       Quoted(users.objects.front()->name) +
                           (others == 0 ? "" : " and " + CountText(others, "other")) + ": " +
                           ShownPath(*users.spec.file));
    text += ReportLine("", ShortText(size_m.x()) + " x " + ShortText(size_m.y()) + " x " +
                               ShortText(size_m.z()) + " m, " +
                               CountText(mesh.model.num_triangles(), "triangle") + " of " +
                               CountText(mesh.num_faces + mesh.num_cornerless, "face") + ", " +
                               ShortText(AreaOf_m2(mesh.model)) + " m²");
    text +=
        LeftOutText(mesh) + SimplifiedText(users.spec, mesh) + PartsText(mesh, labels, materials);
    for (const ObjectSpec* object : users.objects) text += WarningsText(*object, mesh);
  }
  return text;
}

}  // namespace railcast
