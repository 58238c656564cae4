#include "core/mesh/mesh_import.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/mesh/assimp_reader.h"
#include "core/mesh/obj_reader.h"
#include "core/mesh/off_reader.h"
#include "core/mesh/ply_mesh_reader.h"
#include "core/mesh/stl_reader.h"

namespace railcast {
namespace {

enum class Format { kObj, kPly, kAsciiStl, kBinaryStl, kOff, kScene };

struct KnownFormat {
  Format format{};
  std::string scene{};  ///< Of kScene: as SceneFormatOf() has it.
};

constexpr std::string_view kWordBreaks = " \t\r\n\v\f";

/// The first `length` bytes.
std::string_view Begin(std::string_view bytes, std::size_t length) {
  return bytes.substr(0, std::min(length, bytes.size()));
}

std::string_view FirstWord(std::string_view bytes) {
  bytes.remove_prefix(std::min(bytes.find_first_not_of(kWordBreaks), bytes.size()));
  return bytes.substr(0, bytes.find_first_of(kWordBreaks));
}

/// Whether a line begins with a word.
bool HasWord(std::string_view bytes, std::string_view word) {
  for (std::size_t begin = bytes.find('\n'); begin != std::string_view::npos;
       begin = bytes.find('\n', begin + 1)) {
    if (FirstWord(bytes.substr(begin)) == word) return true;
  }
  return false;
}

/// Whether a line begins with one of the keywords of an OBJ file's geometry.
bool HasObjLine(std::string_view bytes) {
  std::size_t begin = 0;
  while (begin < bytes.size()) {
    const std::string_view line = bytes.substr(begin, bytes.find('\n', begin) - begin);
    const std::string_view word = FirstWord(line);
    if (word == "v" || word == "f") return true;
    begin += line.size() + 1;
  }
  return false;
}

bool HasExtension(const std::filesystem::path& file, std::string_view lower) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return extension == lower;
}

std::optional<KnownFormat> FormatOf(const std::string& bytes, const std::filesystem::path& file) {
  const std::string_view word = FirstWord(Begin(bytes, 1024));
  const bool is_solid = word == "solid" || word == "SOLID";
  if (IsBinaryStl(bytes)) return KnownFormat{Format::kBinaryStl};
  if (word == "ply") return KnownFormat{Format::kPly};
  if (is_solid &&
      (HasWord(Begin(bytes, 65536), "facet") || HasWord(Begin(bytes, 65536), "FACET"))) {
    return KnownFormat{Format::kAsciiStl};
  }
  if (IsOff(Begin(bytes, 4096))) return KnownFormat{Format::kOff};
  if (const auto scene = SceneFormatOf(bytes)) return KnownFormat{Format::kScene, *scene};
  if (HasExtension(file, ".obj") || HasObjLine(bytes)) return KnownFormat{Format::kObj};
  if (is_solid) return KnownFormat{Format::kAsciiStl};
  return std::nullopt;
}

std::string Readable() {
  return HasAssimp() ? "OBJ, PLY, STL, OFF, glTF, FBX, DAE and 3DS" : "OBJ, PLY, STL and OFF";
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

/// The bytes of a file and where they are from.
struct MeshBytes {
  std::string bytes;
  std::filesystem::path file;
  bool is_on_disk{};  ///< Whether other files that it names may be read, too.
};

/// Reads a scene by assimp and takes from it the units that are not given.
PolygonSoup ReadSceneIn(const MeshBytes& source,
                        const std::string& format,
                        const std::string& shown,
                        MeshUnits& units) {
  // These assimp has turned and scaled as the file says.
  const bool has_own_units = format == "dae" || format == "3ds";
  if (has_own_units && (units.unit_m || units.y_up)) {
    throw InputError(shown + ": says itself what its unit and its upward axis are: leave out " +
                     "unit_m and up");
  }
  SceneMesh scene = ReadScene(source.bytes, format,
                              source.is_on_disk ? source.file : std::filesystem::path(), shown);
  if (!units.unit_m) units.unit_m = scene.unit_m;
  if (!units.y_up) units.y_up = scene.y_up;
  return std::move(scene.soup);
}

ImportedMesh ParseBytes(MeshBytes source, const MeshUnits& given) {
  const std::string shown = ShownPath(source.file);
  const std::optional<KnownFormat> known = FormatOf(source.bytes, source.file);
  if (!known) {
    throw InputError(shown + ": is of no known format; " + Readable() + " files can be read");
  }
  MeshUnits units = given;
  const double largest = static_cast<double>(std::numeric_limits<float>::max()) /
                         std::max(1.0, units.unit_m.value_or(1.0));
  PolygonSoup soup;
  const Format format = known->format;
  switch (format) {
    case Format::kObj: {
      std::istringstream in(std::move(source.bytes));
      soup = ObjReader(shown, largest).Read(in);
      break;
    }
    case Format::kPly:
      soup = ReadPlyMesh(shown, source.bytes, largest);
      break;
    case Format::kAsciiStl:
      soup = ReadAsciiStl(shown, source.bytes);
      break;
    case Format::kBinaryStl:
      soup = ReadBinaryStl(shown, source.bytes);
      break;
    case Format::kOff:
      soup = ReadOff(shown, source.bytes, largest);
      break;
    case Format::kScene:
      soup = ReadSceneIn(source, known->scene, shown, units);
      break;
  }
  const double unit_m = units.unit_m.value_or(1.0);
  const bool is_single =
      format == Format::kScene || format == Format::kAsciiStl || format == Format::kBinaryStl;
  if (is_single) CheckPrecision(shown, soup, unit_m);
  ImportedMesh mesh = MakeTriangles(soup, unit_m, units.y_up.value_or(false));
  mesh.has_own_up = format == Format::kScene;
  if (mesh.parts.empty()) throw InputError(shown + ": holds no triangle");
  return mesh;
}

}  // namespace

ImportedMesh ParseMesh(std::string bytes,
                       const std::filesystem::path& file,
                       const MeshUnits& units) {
  return ParseBytes({.bytes = std::move(bytes), .file = file, .is_on_disk = false}, units);
}

ImportedMesh ReadMesh(const std::filesystem::path& file, const MeshUnits& units) {
  std::ifstream in = OpenInput(file);
  std::string bytes(std::istreambuf_iterator<char>(in), {});
  return ParseBytes({.bytes = std::move(bytes), .file = file, .is_on_disk = true}, units);
}

}  // namespace railcast
