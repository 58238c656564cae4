#include "core/rail/objects/mesh_object.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/base/text.h"
#include "core/mesh/mesh_import.h"
#include "core/mesh/simplify.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/objects/object_surfaces.h"

namespace railcast {
namespace {

/// Beyond, float32 has steps of 1 mm.
constexpr double kFarthestFromOrigin_m = 8192.0;

constexpr double kNormalTolerance_deg = 20.0;

MeshUnits UnitsOfMesh(const ObjectSpec& spec) {
  MeshUnits units{.unit_m = spec.unit_m, .y_up = std::nullopt};
  if (spec.up) units.y_up = *spec.up == UpAxis::kY;
  return units;
}

/// For example: "body", "glass" and 3 more.
std::string ShortList(const std::set<std::string>& names) {
  constexpr std::size_t kMostShown = 12;
  std::string text;
  std::size_t num_shown = 0;
  for (const std::string& name : names) {
    if (num_shown == kMostShown) break;
    text += (num_shown++ == 0 ? "" : ", ") + Quoted(name);
  }
  if (names.size() > num_shown)
    text += " and " + std::to_string(names.size() - num_shown) + " more";
  return text;
}

std::string PlaceOfEntry(std::size_t entry, const char* key) {
  return "/parts/" + std::to_string(entry) + "/" + key;
}

/// The entries of ObjectSpec::parts, with their names looked up.
class PartEntries {
 public:
  /// @throws InputError with all faults of the entries.
  PartEntries(const ObjectSpec& spec,
              std::span<const ImportedMesh> meshes,
              const MeshTables& tables)
      : spec_(spec) {
    std::set<std::string> names;
    for (const ImportedMesh& mesh : meshes) {
      for (const NamedMesh& part : mesh.parts) names.insert({part.material, part.group});
    }
    names.erase("");
    ErrorList faults;
    for (std::size_t i = 0; i < spec.parts.size(); ++i) {
      const MeshPartSpec& entry = spec.parts[i];
      if (!names.contains(entry.of)) {
        faults.Add({PlaceOfEntry(i, "of"),
                    names.empty()
                        ? "must name a material or group of the file, which names none"
                        : "must name a material or group of the file: " + ShortList(names),
                    Quoted(entry.of)});
      }
      LookUp(entry, i, tables, faults);
    }
    faults.ThrowIfAny();
  }

  struct Choice {
    std::optional<std::uint16_t> material;
    std::optional<std::uint32_t> label;
    std::string why_material;
    std::string why_label;
  };

  /// What the entries say of a part. One for its group has precedence over one for its material.
  [[nodiscard]] Choice Of(const NamedMesh& part) const {
    Choice choice;
    for (const std::string* name : {&part.group, &part.material}) {
      for (std::size_t i = 0; i < entries_.size(); ++i) {
        if (name->empty() || spec_.parts[i].of != *name) continue;
        const std::string why = "as parts/" + std::to_string(i) + " says";
        if (!choice.material && entries_[i].material) {
          choice.material = entries_[i].material;
          choice.why_material = why;
        }
        if (!choice.label && entries_[i].label) {
          choice.label = entries_[i].label;
          choice.why_label = why;
        }
      }
    }
    return choice;
  }

 private:
  struct Entry {
    std::optional<std::uint16_t> material;
    std::optional<std::uint32_t> label;
  };

  void LookUp(const MeshPartSpec& entry,
              std::size_t i,
              const MeshTables& tables,
              ErrorList& faults) {
    Entry found;
    if (entry.material) {
      found.material = IndexOfMaterial(tables.materials, *entry.material);
      if (!found.material) {
        faults.Add({PlaceOfEntry(i, "material"), "must be in the material library",
                    Quoted(*entry.material)});
      }
    }
    if (entry.label) {
      const Label* label = tables.labels.Find(*entry.label);
      if (label != nullptr) {
        found.label = label->id;
      } else {
        faults.Add({PlaceOfEntry(i, "label"), "must be in the label table", Quoted(*entry.label)});
      }
    }
    entries_.push_back(found);
  }

  const ObjectSpec& spec_;
  std::vector<Entry> entries_;  // In the order of spec_.parts.
};

/// The surface of a part, with the reasons.
MeshPartUse UseOf(const NamedMesh& part,
                  const PartEntries& entries,
                  const ObjectSpec& spec,
                  const MeshTables& tables) {
  PartEntries::Choice choice = entries.Of(part);
  if (!choice.material && !spec.material) {
    const auto named = MaterialOfName(part.material.empty() ? part.group : part.material);
    if (named) choice.material = IndexOfMaterial(tables.materials, named->material);
    if (choice.material) choice.why_material = "by the word " + Quoted(named->word);
  }
  if (!choice.material && !spec.material && part.luminance) {
    choice.material = PaintOfLuminance(tables.materials, *part.luminance);
    if (choice.material) {
      choice.why_material = "by its colour, of luminance " + ShortText(*part.luminance);
    }
  }
  const auto otherwise = [](bool is_objects) { return is_objects ? "the object's" : "the type's"; };
  if (!choice.material) choice.why_material = otherwise(spec.material.has_value());
  if (!choice.label) choice.why_label = otherwise(spec.label.has_value());
  return {.material = part.material,
          .group = part.group,
          .num_triangles = part.mesh.triangles.size(),
          .surface = {.material = choice.material.value_or(tables.surface.material),
                      .label = choice.label.value_or(tables.surface.label)},
          .why_material = std::move(choice.why_material),
          .why_label = std::move(choice.why_label)};
}

/// From the mesh's own frame, about its middle, to the object's: first moved, then scaled.
struct MeshPlace {
  Vector3 offset_m;
  Vector3 scale;

  void Apply(Mesh& mesh) const {
    for (Eigen::Vector3f& vertex : mesh.vertices) {
      vertex = scale.cwiseProduct(vertex.cast<double>() + offset_m).cast<float>();
    }
  }
};

Vector3 ScaleOfMesh(const ObjectSpec& spec, const Eigen::AlignedBox3d& box) {
  if (!spec.size_m) return Vector3::Ones();
  const Vector3 size_m((*spec.size_m)[0], (*spec.size_m)[1], (*spec.size_m)[2]);
  if (!(size_m.array() > 0.0).all() || !size_m.allFinite()) {
    throw InputError("size_m: must be > 0 (got " + NumberText(size_m.x()) + ", " +
                     NumberText(size_m.y()) + ", " + NumberText(size_m.z()) + ")");
  }
  if (!(box.sizes().array() > 0.0).all()) {
    throw InputError("size_m: cannot stretch a mesh that is flat");
  }
  return size_m.cwiseQuotient(box.sizes());
}

/// @param box Of the mesh about its middle.
MeshPlace PlaceOfMesh(const ObjectSpec& spec,
                      const ImportedMesh& mesh,
                      const Eigen::AlignedBox3d& box) {
  MeshPlace place{.offset_m = mesh.origin_m, .scale = ScaleOfMesh(spec, box)};
  if (spec.origin == MeshOrigin::kFoot) {
    place.offset_m = -Vector3(box.center().x(), box.center().y(), box.min().z());
    return place;
  }
  const auto reach_m = [&](const Vector3& corner) {
    return place.scale.cwiseProduct(corner + place.offset_m).cwiseAbs().maxCoeff();
  };
  const double farthest_m = std::max(reach_m(box.min()), reach_m(box.max()));
  if (farthest_m > kFarthestFromOrigin_m) {
    throw InputError(
        {{"/origin",
          "must be \"foot\" for a mesh that reaches further than 8192 m from its file's origin",
          ShortText(farthest_m) + " m"}});
  }
  return place;
}

/// @return The deviation.
double SimplifyParts(double tolerance_m, ImportedMesh& mesh) {
  std::vector<Mesh> parts;
  for (NamedMesh& part : mesh.parts) parts.push_back(std::move(part.mesh));
  const auto simplified =
      SimplifiedOnce(parts, {.deviation_m = tolerance_m, .normal_deg = kNormalTolerance_deg});
  for (std::size_t p = 0; p < parts.size(); ++p) mesh.parts[p].mesh = simplified->parts[p];
  return simplified->deviation_m;
}

MeshObject MakeOfMesh(const ObjectSpec& spec,
                      const PartEntries& entries,
                      const MeshTables& tables,
                      ImportedMesh mesh) {
  Eigen::AlignedBox3d box;
  for (const NamedMesh& part : mesh.parts) {
    for (const Eigen::Vector3f& vertex : part.mesh.vertices) box.extend(vertex.cast<double>());
  }
  MeshObject object{.model = {.name = std::string(NameOf(spec.type)), .parts = {}},
                    .parts = {},
                    .file_bounds_m = {mesh.origin_m + box.min(), mesh.origin_m + box.max()},
                    .has_own_up = mesh.has_own_up,
                    .num_faces = mesh.num_faces,
                    .num_flat = mesh.num_flat,
                    .num_cornerless = mesh.num_cornerless,
                    .remarks = mesh.remarks,
                    .num_read = mesh.num_triangles()};
  const MeshPlace place = PlaceOfMesh(spec, mesh, box);
  for (NamedMesh& part : mesh.parts) place.Apply(part.mesh);
  if (spec.tolerance_mm > 0.0) object.deviation_m = SimplifyParts(1e-3 * spec.tolerance_mm, mesh);
  for (NamedMesh& part : mesh.parts) {
    object.parts.push_back(UseOf(part, entries, spec, tables));
    Mesh& whole = MeshOf(object.parts.back().surface, object.model);
    if (whole.vertices.empty()) {
      whole = std::move(part.mesh);
    } else {
      whole.Append(part.mesh);
    }
  }
  return object;
}

}  // namespace

MeshObject MakeMeshObject(const ObjectSpec& spec, const MeshTables& tables) {
  if (!spec.file) throw InputError("file: required for type \"mesh\"");
  return std::move(MakeMeshObjects(spec, {&*spec.file, 1}, tables).front());
}

std::vector<MeshObject> MakeMeshObjects(const ObjectSpec& spec,
                                        std::span<const std::string> files,
                                        const MeshTables& tables) {
  std::vector<ImportedMesh> meshes;
  for (const std::string& file : files) {
    meshes.push_back(WithinMemory([&] { return ReadingText(file); },
                                  [&] { return ReadMesh(file, UnitsOfMesh(spec)); }));
  }
  const PartEntries entries(spec, meshes, tables);
  std::vector<MeshObject> objects;
  for (ImportedMesh& mesh : meshes) {
    objects.push_back(MakeOfMesh(spec, entries, tables, std::move(mesh)));
  }
  return objects;
}

}  // namespace railcast
