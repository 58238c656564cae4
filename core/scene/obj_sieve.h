#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <string_view>

namespace railcast {

/// Checks an OBJ file and copies from it only what OpenMesh will read as intended: the `v` lines,
/// and the `f` lines with three or more different vertices. Each vertex of a face is copied once,
/// as OpenMesh would read it, with its index counted from the start of the file. The copy has no
/// materials, so that OpenMesh's shared reader keeps no state, opens no other file and prints
/// nothing.
class ObjSieve {
 public:
  /// @param shown Name of the file in error messages.
  /// @param largest Largest coordinate that is finite in float32, also after conversion to metres.
  ObjSieve(std::string shown, double largest);

  /// @throws InputError "shown: line N: rule (got value)".
  [[nodiscard]] std::string Sift(std::istream& in);

  [[nodiscard]] std::size_t num_vertices() const { return static_cast<std::size_t>(num_vertices_); }
  [[nodiscard]] std::size_t num_faces() const { return num_faces_; }

 private:
  bool ReadLogicalLine(std::istream& in, std::string& line);
  void SiftVertex(std::string_view rest);
  void SiftFace(std::string_view rest);
  [[nodiscard]] int VertexOf(std::string_view corner);
  [[noreturn]] void FailIndex(std::string_view index) const;
  [[noreturn]] void Fail(const std::string& rule, std::string_view got) const;

  std::string shown_;
  double largest_;
  std::string sifted_;
  int line_ = 1;
  int next_line_ = 1;
  int num_vertices_ = 0;
  std::size_t num_faces_ = 0;
  int highest_index_ = 0;
  int highest_index_line_ = 0;
};

}  // namespace railcast
