#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/mesh/polygon_soup.h"

namespace railcast {

/// The faults of a mesh file in text, which are reported together.
class LineFaults {
 public:
  /// @param shown Name of the file in error messages.
  explicit LineFaults(std::string shown) : shown_(std::move(shown)) {}

  /// Reads a line or anything else by `read`, which may throw an InputError, and keeps that.
  /// Returns whether it threw none.
  /// @throws InputError with all faults kept as soon as they are too many to list.
  template <typename Read>
  bool Try(const Read& read) {
    constexpr std::size_t kMostFaults = 19;  // With the line below, as many as an error shows.
    try {
      read();
      return true;
    } catch (const InputError& error) {
      for (const Fault& fault : error.faults()) faults_.Add(fault);
    }
    if (faults_.size() >= kMostFaults) {
      faults_.AddLine(shown_ + ": goes on; this many faults are listed at most");
      faults_.ThrowIfAny();
    }
    return false;
  }

  /// @throws InputError with all faults kept, if there are any.
  void ThrowIfAny() const { faults_.ThrowIfAny(); }

 private:
  std::string shown_;
  ErrorList faults_;
};

/// The `mtllib` lines of an OBJ file, in their order. A line may name several files, or one with
/// blanks in its name, with or without a backslash before each or quotes: each gives the whole rest
/// of the line and, if there are several, each word of it.
[[nodiscard]] std::vector<std::vector<std::string>> MaterialLibrariesOf(const std::string& obj);

/// Reads from a Wavefront MTL file the luminance of each material's diffuse colour (`Kd`), if it
/// has one and no picture (`map_Kd`) changes it, and adds all of its materials to `luminances`. A
/// material that another file has described already keeps that.
///
/// The format's description calls Kd a reflectivity, so it is taken to be linear.
/// @param shown Name of the file in error messages.
/// @throws InputError "shown: line N: rule (got value)" for each Kd line with a fault.
void ReadMtl(const std::string& shown,
             const std::string& bytes,
             std::map<std::string, std::optional<double>>& luminances);

/// Reads a Wavefront OBJ file: `v` and `f` lines, with negative indices and continued lines; the
/// names of `usemtl`, and of `g` or else `o`. Normals, texture coordinates, lines and points are
/// passed over, as are faces of which fewer than three corners in a row are different (which occur
/// in well-known files). Other lines are remarks.
///
/// It is railcast's own because OpenMesh gives coordinates of OBJ files in single precision, leaves
/// out corners that a face names twice, and passes over what it does not understand.
class ObjReader {
 public:
  /// @param shown Name of the file in error messages.
  /// @param largest Largest coordinate that is finite in float32, also after conversion to metres.
  ObjReader(std::string shown, double largest);

  /// @throws InputError "shown: line N: rule (got value)" for each line with a fault.
  [[nodiscard]] PolygonSoup Read(std::istream& in);

 private:
  bool ReadLogicalLine(std::istream& in, std::string& line);
  void ReadKeyword(std::string_view keyword, std::string_view rest);
  void ReadVertex(std::string_view rest);
  void ReadFace(std::string_view rest);
  [[nodiscard]] int VertexOf(std::string_view corner);
  [[noreturn]] void FailIndex(std::string_view index) const;
  [[noreturn]] void Fail(const std::string& rule, std::string_view got) const;

  std::string shown_;
  double largest_;
  LineFaults faults_;
  PolygonSoup soup_;
  NameIndices materials_{soup_.materials};
  NameIndices groups_{soup_.groups};
  std::uint32_t material_ = PolygonSoup::kUnnamed;
  std::uint32_t group_ = PolygonSoup::kUnnamed;
  int line_ = 1;
  int next_line_ = 1;
  int highest_index_ = 0;
  int highest_index_line_ = 0;
};

/// Lengths in binary STL files.
inline constexpr std::size_t kStlHeaderBytes = 84;
inline constexpr std::size_t kStlTriangleBytes = 50;

/// Reads STL files held in `bytes`. Corners at one place are one point in binary files.
///
/// It is railcast's own because OpenMesh passes over text whose lines it does not expect; a
/// binary file is a list of triangles.
/// @param shown Name of the file in error messages.
/// @throws InputError "shown: rule (got value)" if the file is damaged or ends early.
[[nodiscard]] PolygonSoup ReadAsciiStl(const std::string& shown, const std::string& bytes);
[[nodiscard]] PolygonSoup ReadBinaryStl(const std::string& shown, const std::string& bytes);

/// Whether `bytes` are a binary STL file: its length follows from its number of triangles, but for
/// blanks and line ends behind the last. ASCII files begin with "solid", but so do some binary
/// ones.
[[nodiscard]] bool IsBinaryStl(const std::string& bytes);

/// How many triangles a binary STL file has by its header; 0 if it ends within that.
[[nodiscard]] std::uint32_t NumBinaryTriangles(const std::string& bytes);

/// Whether a file begins like an OFF file: with OFF, or with letters for what its vertices have
/// besides (as in COFF), after comments.
[[nodiscard]] bool IsOff(std::string_view bytes);

/// Reads an ASCII OFF file held in `bytes`: a line for each vertex, of which the first three
/// numbers count, and a line for each face, which may go on with its colour.
///
/// It is railcast's own because OpenMesh takes a face's colour for the next face.
/// @param shown Name of the file in error messages.
/// @param largest Largest coordinate that is allowed.
/// @throws InputError "shown: line N: rule (got value)" for each line with a fault, and if the file
///   ends early.
[[nodiscard]] PolygonSoup ReadOff(const std::string& shown, std::string_view bytes, double largest);

/// Reads the polygons of a PLY file held in `bytes`: ASCII or binary, in either byte order, with
/// coordinates of any type, and faces as `vertex_indices` or `vertex_index`. Lines of the header
/// `comment material NAME` name the materials that the property `material_index` of faces counts
/// from 0. All else is passed over.
///
/// It is railcast's own because OpenMesh reads double coordinates of binary files as 0.
/// @param shown Name of the file in error messages.
/// @param largest Largest coordinate that is allowed.
/// @throws InputError "shown: rule (got value)" if the file is damaged or ends early.
[[nodiscard]] PolygonSoup ReadPlyMesh(const std::string& shown,
                                      std::string_view bytes,
                                      double largest);

/// Reads a PLY file of scenarios/models as it is, about its own origin, by a shorter way: it is
/// binary, its vertices are floats in the order of the parts, and its faces are triangles of 16-bit
/// corners with a `material_index`.
[[nodiscard]] ImportedMesh ReadShippedPly(std::string_view bytes);

}  // namespace railcast
