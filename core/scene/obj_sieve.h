#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <string_view>

namespace railcast {

/// Copies the `v` lines of a file, and the `f` lines of three different vertices or more, after a
/// check that OpenMesh will read each of them as it is meant. Of `f` each vertex is copied once, as
/// OpenMesh would take it, counted from the file's first. What OpenMesh gets holds no material, so
/// that its shared reader keeps no state, opens no other file and has nothing to print.
class ObjSieve {
 public:
  /// @param shown What messages call the file.
  /// @param largest Coordinate that is finite in float32, also in metres.
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
