#include "core/mesh/stl_reader.h"

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/IO/reader/STLReader.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_cursor.h"

namespace railcast {
namespace {

/// Collects the vertices and faces that OpenMesh reads, without requiring a manifold, and ignores
/// everything else.
class SoupImporter final : public OpenMesh::IO::BaseImporter {
 public:
  using VertexHandle = OpenMesh::VertexHandle;
  using FaceHandle = OpenMesh::FaceHandle;
  using HalfedgeHandle = OpenMesh::HalfedgeHandle;
  using EdgeHandle = OpenMesh::EdgeHandle;

  VertexHandle add_vertex(const OpenMesh::Vec3f& point) override {
    return add_vertex(OpenMesh::Vec3d(point));
  }
  VertexHandle add_vertex(const OpenMesh::Vec3d& point) override {
    soup_.points.emplace_back(point[0], point[1], point[2]);
    return VertexHandle(static_cast<int>(soup_.points.size()) - 1);
  }
  FaceHandle add_face(const VHandles& corners) override {
    PolygonSoup::Face face;
    for (const VertexHandle corner : corners) {
      face.corners.push_back(static_cast<std::uint32_t>(corner.idx()));
    }
    soup_.faces.push_back(std::move(face));
    return FaceHandle(static_cast<int>(soup_.faces.size()) - 1);
  }
  size_t n_vertices() const override { return soup_.points.size(); }
  size_t n_faces() const override { return soup_.faces.size(); }
  size_t n_edges() const override { return 0; }

  [[nodiscard]] PolygonSoup Take() { return std::move(soup_); }

  VertexHandle add_vertex() override { return VertexHandle(); }
  HalfedgeHandle add_edge(VertexHandle, VertexHandle) override { return HalfedgeHandle(); }
  FaceHandle add_face(HalfedgeHandle) override { return FaceHandle(); }
  void add_face_texcoords(FaceHandle, VertexHandle, const std::vector<OpenMesh::Vec2f>&) override {}
  void add_face_texcoords(FaceHandle, VertexHandle, const std::vector<OpenMesh::Vec3f>&) override {}
  void set_face_texindex(FaceHandle, int) override {}
  void set_point(VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_halfedge(VertexHandle, HalfedgeHandle) override {}
  void set_normal(VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_normal(VertexHandle, const OpenMesh::Vec3d&) override {}
  void set_color(VertexHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(VertexHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_color(VertexHandle, const OpenMesh::Vec4f&) override {}
  void set_texcoord(VertexHandle, const OpenMesh::Vec2f&) override {}
  void set_status(VertexHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_next(HalfedgeHandle, HalfedgeHandle) override {}
  void set_face(HalfedgeHandle, FaceHandle) override {}
  void request_face_texcoords2D() override {}
  void set_texcoord(HalfedgeHandle, const OpenMesh::Vec2f&) override {}
  void set_texcoord(VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_texcoord(HalfedgeHandle, const OpenMesh::Vec3f&) override {}
  void set_status(HalfedgeHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_color(EdgeHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(EdgeHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(EdgeHandle, const OpenMesh::Vec3f&) override {}
  void set_color(EdgeHandle, const OpenMesh::Vec4f&) override {}
  void set_status(EdgeHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_normal(FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_normal(FaceHandle, const OpenMesh::Vec3d&) override {}
  void set_color(FaceHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(FaceHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_color(FaceHandle, const OpenMesh::Vec4f&) override {}
  void set_status(FaceHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void add_texture_information(int, std::string) override {}

 private:
  PolygonSoup soup_;
};

/// Whether a word is a keyword, which some programs write in capitals.
bool IsStlWord(std::string_view word, std::string_view keyword) {
  return std::ranges::equal(word, keyword, {}, [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
}

/// Reads the words of an ASCII STL file, which may be spread over lines in any way.
class AsciiStlReader {
 public:
  AsciiStlReader(const std::string& shown, std::string_view text) : shown_(shown), rest_(text) {}

  PolygonSoup Read() {
    for (; const auto line = TakeLine(rest_); ++line_) {
      const auto words = Words(*line);
      // What follows is a name, which may be anything.
      if (words.empty() || IsStlWord(words[0], "solid") || IsStlWord(words[0], "endsolid"))
        continue;
      for (std::size_t i = 0; i < words.size(); ++i) {
        if (IsStlWord(words[i], "vertex")) ReadVertex(std::span(words).subspan(i + 1), *line);
        if (IsStlWord(words[i], "endloop")) EndLoop();
      }
    }
    if (!loop_.empty()) throw InputError(shown_ + ": ends within a facet");
    return std::move(soup_);
  }

 private:
  [[noreturn]] void Fail(const std::string& rule, std::string_view got) const {
    throw InputError(shown_ + ": line " + std::to_string(line_) + ": " + rule + " (got \"" +
                     ShownText(got) + "\")");
  }

  void ReadVertex(std::span<const std::string_view> words, std::string_view line) {
    Vector3 point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string_view word = axis < words.size() ? words[axis] : std::string_view();
      const auto number = ParseSignedNumber<double>(word);
      if (!number || !std::isfinite(*number)) {
        Fail("a vertex must have three finite coordinates", line);
      }
      point[static_cast<Eigen::Index>(axis)] = *number;
    }
    loop_.push_back(static_cast<std::uint32_t>(soup_.points.size()));
    soup_.points.push_back(point);
  }

  void EndLoop() {
    if (loop_.size() != 3) Fail("a facet must have three vertices", std::to_string(loop_.size()));
    soup_.AddFace(std::exchange(loop_, {}));
  }

  const std::string& shown_;
  std::string_view rest_;
  std::size_t line_ = 1;
  PolygonSoup soup_;
  std::vector<std::uint32_t> loop_;
};

}  // namespace

std::uint32_t NumBinaryTriangles(const std::string& bytes) {
  std::uint32_t num = 0;
  if (bytes.size() >= kStlHeaderBytes) std::memcpy(&num, bytes.data() + 80, sizeof(num));
  return num;
}

bool IsBinaryStl(const std::string& bytes) {
  return bytes.size() >= kStlHeaderBytes &&
         bytes.size() == kStlHeaderBytes + kStlTriangleBytes * NumBinaryTriangles(bytes);
}

PolygonSoup ReadBinaryStl(const std::string& shown, const std::string& bytes) {
  // OpenMesh looks corners up by their place, where one that is not a number equals any other.
  for (std::size_t i = 0; i < NumBinaryTriangles(bytes); ++i) {
    std::array<float, 9> corners{};
    std::memcpy(corners.data(), bytes.data() + kStlHeaderBytes + i * kStlTriangleBytes + 12, 36);
    for (const float value : corners) {
      if (!std::isfinite(value)) {
        throw InputError(shown + ": triangle " + std::to_string(i) +
                         " must have finite coordinates" + Got(value));
      }
    }
  }
  // What OpenMesh has to say about a file would be printed as it is in the file.
  omerr().disable();
  SoupImporter importer;
  std::istringstream in(bytes);
  OpenMesh::IO::Options options = OpenMesh::IO::Options::Binary;
  if (!OpenMesh::IO::STLReader().read(in, importer, options)) {
    throw InputError(shown + ": cannot be read as STL");
  }
  return importer.Take();
}

PolygonSoup ReadAsciiStl(const std::string& shown, const std::string& bytes) {
  return AsciiStlReader(shown, bytes).Read();
}

}  // namespace railcast
