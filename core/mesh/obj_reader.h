#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/mesh/line_faults.h"
#include "core/mesh/polygon_soup.h"

namespace railcast {

/// The names in the `mtllib` lines of an OBJ file, in their order. A line may name several files,
/// or one with blanks in its name: it gives the whole rest of the line and, if there are several,
/// each word of it.
[[nodiscard]] std::vector<std::string> MaterialLibrariesOf(const std::string& obj);

/// Reads from a Wavefront MTL file the luminance of each material's diffuse colour (`Kd`), if it
/// has one and no picture (`map_Kd`) changes it, and adds it to `luminances`. A material that
/// another file has described already keeps that.
///
/// The format's description calls Kd a reflectivity, so it is taken to be linear.
/// @param shown Name of the file in error messages.
/// @throws InputError "shown: line N: rule (got value)" for each Kd line with a fault.
void ReadMtl(const std::string& shown,
             const std::string& bytes,
             std::map<std::string, double>& luminances);

/// Reads a Wavefront OBJ file: `v` and `f` lines, with negative indices and continued lines; the
/// names of `usemtl`, and of `g` or else `o`. Normals, texture coordinates, lines and points are
/// passed over, as are faces of fewer than three different corners in a row (which occur in
/// well-known files).
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

}  // namespace railcast
