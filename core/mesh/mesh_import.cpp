#include "core/mesh/mesh_import.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <utility>

#include "core/base/error.h"
#include "core/base/inputs.h"
#include "core/base/shipped_files.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/base/unit_comment.h"
#include "core/mesh/gltf_buffers.h"
#include "core/mesh/mesh_format.h"
#include "core/mesh/mesh_readers.h"

namespace railcast {
namespace {

std::string Readable() {
  return HasAssimp() ? "OBJ, PLY, STL, OFF, glTF, FBX, DAE and 3DS" : "OBJ, PLY, STL and OFF";
}

/// What is wrong with a file of no known format.
std::string UnknownFormatText(const std::string& bytes, const std::filesystem::path& file) {
  if (const auto stl = UnevenStlOf(bytes, file)) {
    const bool is_cut = stl->num_bytes > bytes.size();
    const std::size_t difference =
        is_cut ? stl->num_bytes - bytes.size() : bytes.size() - stl->num_bytes;
    return "is a binary STL file of " + std::to_string(stl->num_triangles) +
           " triangles by its header and must have " + std::to_string(stl->num_bytes) + " bytes; " +
           std::to_string(difference) + (is_cut ? " are missing" : " are too many");
  }
  return "is of no known format; " + Readable() + " files can be read";
}

/// STL files and assimp have coordinates in single precision, with steps of 1 mm from 8 km from the
/// origin on.
void CheckPrecision(const std::string& shown, const PolygonSoup& soup, double unit_m) {
  constexpr double kLargest_m = 8192.0;
  for (const Vector3& point : soup.points) {
    const double largest = point.cwiseAbs().maxCoeff();
    if (largest * unit_m <= kLargest_m) continue;
    throw InputError(shown + ": coordinates of this format must lie within 8192 m of its origin, " +
                     "for they have single precision" + Got(largest * unit_m) +
                     "; OBJ, PLY and OFF files keep all their digits");
  }
}

/// Other types of numbers, or units, show in a size that nothing has.
void CheckMeshSize(const std::string& shown, const PolygonSoup& soup, double unit_m) {
  constexpr double kLargest_m = 1e6;
  if (soup.points.empty()) return;
  Eigen::AlignedBox3d box;
  for (const Vector3& point : soup.points) box.extend(point);
  const double size_m = unit_m * box.sizes().maxCoeff();
  if (size_m <= kLargest_m) return;
  throw InputError(shown + ": must be at most 1000 km large" + Got(size_m) +
                   ": another unit or type?");
}

/// Cutting a face into triangles takes time as the square of its corners.
void CheckCorners(const std::string& shown, const PolygonSoup& soup) {
  for (std::size_t i = 0; i < soup.faces.size(); ++i) {
    const std::size_t num_corners = soup.faces[i].corners.size();
    if (num_corners <= kMostFaceCorners) continue;
    throw InputError(shown + ": face " + std::to_string(i) + " must have at most " +
                     std::to_string(kMostFaceCorners) + " corners" + Got(num_corners));
  }
}

/// A mesh file, whole in memory.
struct MeshSource {
  std::string bytes;
  std::filesystem::path file;
  std::vector<FileBeside> beside;
};

PolygonSoup ReadObjIn(MeshSource& source, const std::string& shown, double largest) {
  std::map<std::string, std::optional<double>> luminances;
  for (const FileBeside& library : source.beside) {
    ReadMtl(ShownPath(source.file.parent_path() / library.name), AsUtf8(library.bytes), luminances);
  }
  std::istringstream in(std::move(source.bytes));
  PolygonSoup soup = ObjReader(shown, largest).Read(in);
  for (const std::string& material : soup.materials) {
    const auto known = luminances.find(material);
    soup.luminances.push_back(known == luminances.end() ? std::nullopt : known->second);
    // What Blender writes where there is none.
    const bool is_none = material == "None" || material == "(null)";
    if (known != luminances.end() || is_none || source.beside.empty()) continue;
    AddRemark({RemarkKind::kMaterialFileMissing, shown, 1, Quoted(material)}, soup.remarks);
  }
  return soup;
}

/// Reads a scene by assimp and takes from it the units that are not given.
PolygonSoup ReadSceneIn(MeshSource source,
                        MeshFormat format,
                        const std::string& shown,
                        MeshUnits& units) {
  // These assimp has turned and scaled as the file says.
  if (format == MeshFormat::kDae && (units.unit_m || units.y_up)) {
    throw InputError(shown + ": says itself what its unit and its upward axis are: leave out " +
                     "unit_m and up");
  }
  SceneMesh scene = ReadScene(
      {format, std::move(source.bytes), std::move(source.beside), units.y_up.has_value()}, shown);
  if (!units.unit_m) units.unit_m = scene.unit_m;
  if (!units.y_up) units.y_up = scene.y_up;
  return std::move(scene.soup);
}

/// The unit that a comment at the head of an OBJ or PLY file names.
std::optional<double> UnitInHead_m(std::string_view bytes, MeshFormat format) {
  const bool is_ply = format == MeshFormat::kPly;
  if (!is_ply && format != MeshFormat::kObj) return std::nullopt;
  while (const auto line = TakeLine(bytes)) {
    const auto words = Words(*line);
    if (words.empty()) continue;
    const bool is_comment =
        is_ply ? words[0] == "comment" || words[0] == "obj_info" : words[0].starts_with('#');
    if (!is_comment && (!is_ply || words[0] == "end_header")) break;
    if (const auto unit_m = is_comment ? UnitOfComment_m(*line) : std::nullopt) return unit_m;
  }
  return std::nullopt;
}

PolygonSoup ReadSoup(MeshSource source,
                     MeshFormat format,
                     const std::string& shown,
                     MeshUnits& units) {
  const double largest = static_cast<double>(std::numeric_limits<float>::max()) /
                         std::max(1.0, units.unit_m.value_or(1.0));
  switch (format) {
    case MeshFormat::kObj:
      return ReadObjIn(source, shown, largest);
    case MeshFormat::kPly:
      return ReadPlyMesh(shown, source.bytes, largest);
    case MeshFormat::kAsciiStl:
      return ReadAsciiStl(shown, source.bytes);
    case MeshFormat::kBinaryStl:
      return ReadBinaryStl(shown, source.bytes);
    case MeshFormat::kOff:
      return ReadOff(shown, source.bytes, largest);
    default:
      return ReadSceneIn(std::move(source), format, shown, units);
  }
}

/// Text as UTF-8; what is binary stays as it is.
std::string MeshTextOf(std::string bytes) {
  return IsBinaryStl(bytes) ? std::move(bytes) : AsUtf8(std::move(bytes));
}

ImportedMesh ParseSource(MeshSource source, const MeshUnits& given) {
  source.bytes = MeshTextOf(std::move(source.bytes));
  const std::string shown = ShownPath(source.file);
  const std::optional<MeshFormat> format = MeshFormatOf(source.bytes, source.file);
  if (!format) throw InputError(shown + ": " + UnknownFormatText(source.bytes, source.file));
  MeshUnits units = given;
  if (!units.unit_m) units.unit_m = UnitInHead_m(source.bytes, *format);
  const PolygonSoup soup = ReadSoup(std::move(source), *format, shown, units);
  const double unit_m = units.unit_m.value_or(1.0);
  const bool is_single =
      IsScene(*format) || *format == MeshFormat::kAsciiStl || *format == MeshFormat::kBinaryStl;
  if (is_single) CheckPrecision(shown, soup, unit_m);
  CheckMeshSize(shown, soup, unit_m);
  CheckCorners(shown, soup);
  ImportedMesh mesh = MakeTriangles(soup, unit_m, units.y_up.value_or(false));
  mesh.has_own_up = IsScene(*format) && *format != MeshFormat::k3ds;
  for (Remark& remark : mesh.remarks) remark.place = shown;
  if (mesh.parts.empty()) throw InputError(shown + ": holds no triangle");
  return mesh;
}

/// Whether a name is that of a file in the folder where it is looked for.
bool IsNameBeside(const std::string& name) {
  return !name.empty() && name != "." && name != ".." &&
         name.find_first_of(std::string_view("/\\\0", 3)) == std::string::npos;
}

std::string WithoutDot(const std::string& name) {
  return name.starts_with("./") ? name.substr(2) : name;
}

std::vector<FileBeside> BuffersBeside(const std::string& bytes, const std::filesystem::path& file) {
  const std::string shown = ShownPath(file);
  std::vector<FileBeside> files;
  for (const std::string& uri : BuffersOfGltf(bytes)) {
    const std::string name = WithoutDot(FileOfUri(uri));
    if (!IsNameBeside(name)) {
      throw InputError(shown + ": must name files beside it only (got " + Quoted(uri) + ")");
    }
    const std::filesystem::path beside = file.parent_path() / name;
    std::error_code error;
    if (!std::filesystem::is_regular_file(beside, error)) {
      throw InputError(shown + ": names " + Quoted(name) + ", which must be a file beside it");
    }
    files.push_back({name, *ReadInput(beside)});
  }
  return files;
}

/// Adds a file beside another if it is there, once; returns whether it is.
bool AddBeside(const std::string& given,
               const std::filesystem::path& file,
               std::vector<FileBeside>& files) {
  const std::string name = WithoutDot(given);
  const std::filesystem::path beside = file.parent_path() / name;
  std::error_code error;
  if (!IsNameBeside(name) || !std::filesystem::is_regular_file(beside, error)) return false;
  const auto is_same = [&](const FileBeside& other) { return other.name == name; };
  if (std::ranges::none_of(files, is_same)) files.push_back({name, *ReadInput(beside)});
  return true;
}

/// Materials have colours only where their library is there: many OBJ files come without.
std::vector<FileBeside> LibrariesBeside(const std::string& bytes,
                                        const std::filesystem::path& file,
                                        std::vector<Remark>& remarks) {
  std::vector<FileBeside> files;
  for (const std::vector<std::string>& names : MaterialLibrariesOf(bytes)) {
    if (AddBeside(names.front(), file, files)) continue;
    std::vector<std::string> missing;
    for (std::size_t i = 1; i < names.size(); ++i) {
      if (!AddBeside(names[i], file, files)) missing.push_back(names[i]);
    }
    // Several words of which none is a file are the name of one.
    if (missing.size() + 1 == names.size()) missing = {names.front()};
    for (const std::string& name : missing) {
      AddRemark({RemarkKind::kMaterialFileMissing, ShownPath(file), 1, Quoted(name)}, remarks);
    }
  }
  return files;
}

std::vector<FileBeside> BesideOf(const std::string& text,
                                 const std::filesystem::path& file,
                                 std::vector<Remark>& remarks) {
  const std::optional<MeshFormat> format = MeshFormatOf(text, file);
  if (format == MeshFormat::kObj) return LibrariesBeside(text, file, remarks);
  if (format == MeshFormat::kGltf || format == MeshFormat::kGlb) return BuffersBeside(text, file);
  return {};
}

}  // namespace

ImportedMesh ParseMesh(std::string bytes,
                       const std::filesystem::path& file,
                       const MeshUnits& units) {
  return ParseSource({.bytes = std::move(bytes), .file = file, .beside = {}}, units);
}

std::vector<FileBeside> FilesBesideMesh(const std::string& bytes,
                                        const std::filesystem::path& file) {
  std::vector<Remark> remarks;
  return BesideOf(MeshTextOf(bytes), file, remarks);
}

ImportedMesh ReadMesh(const std::filesystem::path& file, const MeshUnits& units) {
  if (const auto shipped = ShippedFile(file.native())) {
    if (!units.unit_m && !units.y_up) return ReadShippedPly(*shipped);
    return ParseMesh(std::string(*shipped), file, units);
  }
  std::string bytes = MeshTextOf(*ReadInput(file));
  std::vector<Remark> remarks;
  std::vector<FileBeside> beside = BesideOf(bytes, file, remarks);
  ImportedMesh mesh =
      ParseSource({.bytes = std::move(bytes), .file = file, .beside = std::move(beside)}, units);
  mesh.remarks.insert(mesh.remarks.end(), remarks.begin(), remarks.end());
  for (const Remark& remark : mesh.remarks) Publish(remark);
  return mesh;
}

}  // namespace railcast
