#include "core/mesh/mesh_readers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/number_type.h"
#include "core/base/text.h"
#include "core/base/text_number.h"
#include "core/mesh/polygon_soup.h"

namespace railcast {
namespace {

struct Property {
  std::string name;
  NumberType type{};
  std::optional<NumberType> length;  ///< The type of a list's length; absent = one number.
};

struct Element {
  std::string name;
  std::uint64_t count{};
  std::vector<Property> properties;
};

enum class Encoding { kAscii, kLittleEndian, kBigEndian };

struct Header {
  Encoding encoding{};
  std::vector<Element> elements;
};

class Reader {
 public:
  Reader(const std::string& shown, std::string_view bytes, double largest)
      : shown_(shown), rest_(bytes), largest_(largest) {}

  PolygonSoup Read() {
    ReadHeader();
    RefuseSplats();
    for (const Element& element : header_.elements) {
      const bool is_read = element.name == "vertex" || element.name == "face";
      // Others have no bytes, and need not have lines.
      if (element.properties.empty() && !is_read) continue;
      // Each one has at least a byte: a count beyond that would only fill the memory.
      if (element.count > 0 && element.properties.empty()) {
        Fail("element " + ShownText(element.name) + ": has no property");
      }
      if (element.count > rest_.size()) FailShort(element);
      element.name == "vertex" ? ReadVertices(element) : ReadOthers(element);
    }
    CheckCorners();
    const bool is_blank = rest_.find_first_not_of(" \t\r\n") == std::string_view::npos;
    if (header_.encoding != Encoding::kAscii || !is_blank) {
      AddRemark({RemarkKind::kSurplusBytes, {}, rest_.size()}, soup_.remarks);
    }
    NameMaterialsByColor(colors_, soup_);
    return std::move(soup_);
  }

 private:
  [[noreturn]] void Fail(const std::string& rule) const { throw InputError(shown_ + ": " + rule); }

  [[noreturn]] void FailShort(const Element& element) const {
    Fail("ends within its " + std::to_string(element.count) + " elements " +
         ShownText(element.name));
  }

  void ReadHeader() {
    bool has_format = false;
    (void)TakeLine(rest_);  // "ply"
    for (;;) {
      const auto line = TakeLine(rest_);
      if (!line) Fail("its header has no end_header line");
      const auto words = Words(*line);
      if (words.size() == 3 && words[0] == "comment" && words[1] == "material") {
        soup_.materials.emplace_back(words[2]);
      }
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        header_.encoding = EncodingOf(words);
        has_format = true;
      } else if (words[0] == "element" && words.size() == 3) {
        const auto count = ParseNumber<std::uint32_t>(words[2]);
        if (!count) FailLine(*line);
        header_.elements.push_back({std::string(words[1]), *count, {}});
      } else if (words[0] == "property" && !header_.elements.empty()) {
        header_.elements.back().properties.push_back(PropertyOf(words, *line));
      } else {
        FailLine(*line);
      }
    }
    if (!has_format) Fail("its header has no format line");
  }

  void RefuseSplats() const {
    for (const Element& element : header_.elements) {
      if (std::ranges::find(element.properties, "f_dc_0", &Property::name) ==
          element.properties.end()) {
        continue;
      }
      Fail(
          "holds Gaussian splats, which are no surface: make a mesh of them first (got the "
          "property f_dc_0)");
    }
  }

  [[noreturn]] void FailLine(std::string_view line) const {
    Fail("its header must have lines of the PLY format (got \"" + ShownText(line) + "\")");
  }

  [[nodiscard]] Encoding EncodingOf(const std::vector<std::string_view>& words) const {
    const std::string_view name = words.size() > 1 ? words[1] : std::string_view();
    if (name == "ascii") return Encoding::kAscii;
    if (name == "binary_little_endian") return Encoding::kLittleEndian;
    if (name == "binary_big_endian") return Encoding::kBigEndian;
    Fail("format: must be ascii, binary_little_endian or binary_big_endian (got \"" +
         ShownText(name) + "\")");
  }

  [[nodiscard]] Property PropertyOf(const std::vector<std::string_view>& words,
                                    std::string_view line) const {
    const auto type_of = [&](std::string_view name) {
      const auto type = PlyTypeNamed(name);
      if (!type) FailLine(line);
      return *type;
    };
    if (words.size() == 5 && words[1] == "list") {
      return {std::string(words[4]), type_of(words[3]), type_of(words[2])};
    }
    if (words.size() != 3) FailLine(line);
    return {std::string(words[2]), type_of(words[1]), std::nullopt};
  }

  /// Which part of a vertex's colour a property is, 0 to 2; absent if it is none.
  [[nodiscard]] static std::optional<std::size_t> ColorPart(const Property& property) {
    constexpr std::array<std::string_view, 3> kParts = {"red", "green", "blue"};
    const auto* it = std::find(kParts.begin(), kParts.end(), property.name);
    if (it == kParts.end() || property.length) return std::nullopt;
    return static_cast<std::size_t>(it - kParts.begin());
  }

  void ReadVertices(const Element& element) {
    soup_.points.reserve(element.count);
    const auto num_color_parts =
        std::count_if(element.properties.begin(), element.properties.end(),
                      [](const Property& property) { return ColorPart(property).has_value(); });
    if (num_color_parts == 3) colors_.resize(element.count);
    std::array<bool, 3> found{};
    for (std::uint64_t i = 0; i < element.count; ++i) {
      BeginLine();
      Vector3 point = Vector3::Zero();
      for (const Property& property : element.properties) {
        const std::size_t num = property.length ? Length(element, *property.length) : 1;
        for (std::size_t k = 0; k < num; ++k) {
          const double value = Next(element, property.type);
          if (const auto part = ColorPart(property); part && !colors_.empty()) {
            colors_[i][*part] = ByteOf(value, property.type);
          }
          if (property.length || property.name.size() != 1) continue;
          const std::size_t axis = std::string_view("xyz").find(property.name[0]);
          if (axis >= 3) continue;
          if (!(std::abs(value) <= largest_)) {
            Fail("vertex " + std::to_string(i) + " must have three finite coordinates" +
                 Got(value));
          }
          point[static_cast<Eigen::Index>(axis)] = value;
          found[axis] = true;
        }
      }
      soup_.points.push_back(point);
    }
    if (element.count > 0 && !(found[0] && found[1] && found[2])) {
      Fail("element vertex: must have the properties x, y and z");
    }
  }

  /// A part of a colour that is given in bytes or, as a fraction, from 0 to 1.
  [[nodiscard]] static std::uint8_t ByteOf(double value, NumberType type) {
    const bool is_fraction = type == NumberType::kFloat || type == NumberType::kDouble;
    const double byte = is_fraction ? std::round(255.0 * value) : value;
    return byte >= 0.0 && byte <= 255.0 ? static_cast<std::uint8_t>(byte) : std::uint8_t{0};
  }

  /// Reads the faces, and passes over all other elements.
  void ReadOthers(const Element& element) {
    const bool is_face = element.name == "face";
    std::vector<FaceUse> uses;
    for (const Property& property : element.properties) {
      uses.push_back(is_face ? UseOfProperty(property) : FaceUse::kNone);
    }
    const bool has_corners = std::ranges::find(uses, FaceUse::kCorners) != uses.end();
    for (std::uint64_t i = 0; i < element.count; ++i) {
      BeginLine();
      std::vector<std::uint32_t> corners;
      std::uint32_t material = PolygonSoup::kUnnamed;
      for (std::size_t p = 0; p < uses.size(); ++p) {
        const Property& property = element.properties[p];
        const std::size_t num = property.length ? Length(element, *property.length) : 1;
        if (uses[p] == FaceUse::kCorners) corners.reserve(num);
        for (std::size_t k = 0; k < num; ++k) {
          const double value = Next(element, property.type);
          if (uses[p] == FaceUse::kCorners) corners.push_back(CornerOf(i, value));
          if (uses[p] == FaceUse::kMaterial) material = MaterialOfFace(i, value);
        }
      }
      if (has_corners) soup_.AddFace(std::move(corners), material);
    }
  }

  enum class FaceUse { kNone, kCorners, kMaterial };
  [[nodiscard]] FaceUse UseOfProperty(const Property& property) const {
    const std::string_view name = property.name;
    if (name == "vertex_indices" || name == "vertex_index") return FaceUse::kCorners;
    const bool is_material = name == "material_index" && !property.length;
    return is_material && !soup_.materials.empty() ? FaceUse::kMaterial : FaceUse::kNone;
  }

  [[nodiscard]] std::uint32_t CornerOf(std::uint64_t face, double value) const {
    if (!(value >= 0.0 && value < kMaxIndex && value == std::floor(value))) FailCorner(face, value);
    return static_cast<std::uint32_t>(value);
  }

  [[nodiscard]] std::uint32_t MaterialOfFace(std::uint64_t face, double value) const {
    const auto count = static_cast<double>(soup_.materials.size());
    if (!(value >= 0.0 && value < count && value == std::floor(value))) {
      Fail("face " + std::to_string(face) + " must name one of the " +
           std::to_string(soup_.materials.size()) + " materials, counted from 0" + Got(value));
    }
    return static_cast<std::uint32_t>(value);
  }

  void CheckCorners() const {
    for (std::size_t i = 0; i < soup_.faces.size(); ++i) {
      for (const std::uint32_t corner : soup_.faces[i].corners) {
        if (corner >= soup_.points.size()) FailCorner(i, corner);
      }
    }
  }

  [[noreturn]] void FailCorner(std::uint64_t face, double corner) const {
    Fail("face " + std::to_string(face) + " must name one of the " +
         std::to_string(soup_.points.size()) + " vertices, counted from 0" + Got(corner));
  }

  [[nodiscard]] std::size_t Length(const Element& element, NumberType type) {
    const double length = Next(element, type);
    if (!(length >= 0.0 && length == std::floor(length))) {
      Fail("element " + ShownText(element.name) + ": a list's length must be a whole number" +
           Got(length));
    }
    if (length > static_cast<double>(rest_.size())) FailShort(element);
    return static_cast<std::size_t>(length);
  }

  /// The next number.
  double Next(const Element& element, NumberType type) {
    if (header_.encoding == Encoding::kAscii) return NextWord(element);
    return VisitNumberType(
        type, [&](auto zero) { return static_cast<double>(NextBytes<decltype(zero)>(element)); });
  }

  /// In text, an element does not go on in the next line.
  void BeginLine() {
    if (header_.encoding != Encoding::kAscii) return;
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kAllBlanks), rest_.size()));
  }

  double NextWord(const Element& element) {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find_first_of(kAllBlanks));
    if (rest_.empty()) FailShort(element);
    if (word.empty()) {
      Fail("element " + ShownText(element.name) + ": must have all of its numbers in its line");
    }
    rest_.remove_prefix(word.size());
    const auto number = ParseTextNumber<double>(word);
    if (!number) {
      Fail("element " + ShownText(element.name) + ": must consist of numbers (got \"" +
           ShownText(word) + "\")");
    }
    return *number;
  }

  template <typename Number>
  Number NextBytes(const Element& element) {
    std::array<char, sizeof(Number)> bytes{};
    if (rest_.size() < bytes.size()) FailShort(element);
    std::copy_n(rest_.begin(), bytes.size(), bytes.begin());
    rest_.remove_prefix(bytes.size());
    if (header_.encoding == Encoding::kBigEndian) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<Number>(bytes);
  }

  static constexpr double kMaxIndex = 4294967295.0;
  static constexpr std::string_view kBlanks = " \t\r\v\f";
  static constexpr std::string_view kAllBlanks = " \t\r\v\f\n";

  const std::string& shown_;
  std::string_view rest_;
  double largest_;
  Header header_;
  PolygonSoup soup_;
  std::vector<Rgb8> colors_;  ///< Of the points; empty if the file has none.
};

}  // namespace

PolygonSoup ReadPlyMesh(const std::string& shown, std::string_view bytes, double largest) {
  return Reader(shown, bytes, largest).Read();
}

ImportedMesh ReadShippedPly(std::string_view bytes) {
  constexpr std::string_view kMaterial = "comment material ";
  constexpr std::size_t kVertexBytes = 3 * sizeof(float);
  constexpr std::size_t kFaceBytes = 8;
  std::string_view rest = bytes;
  const auto take = [&](std::string_view beginning) {
    const auto line = TakeLine(rest);
    Check(line && line->starts_with(beginning), "a shipped mesh has the header of all of them");
    return line->substr(beginning.size());
  };
  take("ply");
  take("format binary_little_endian 1.0");
  ImportedMesh mesh;
  while (rest.starts_with(kMaterial)) {
    mesh.parts.push_back(
        {.material = std::string(take(kMaterial)), .group = {}, .luminance = {}, .mesh = {}});
  }
  const auto num_vertices = ParseNumber<std::uint32_t>(take("element vertex ")).value_or(0);
  for (const char* axis : {"x", "y", "z"}) take("property float " + std::string(axis));
  const auto num_faces = ParseNumber<std::uint32_t>(take("element face ")).value_or(0);
  take("property list uchar ushort vertex_indices");
  take("property uchar material_index");
  take("end_header");
  Check(rest.size() == num_vertices * kVertexBytes + num_faces * kFaceBytes,
        "a shipped mesh has as many bytes as its header says");
  std::vector<Eigen::Vector3f> vertices(num_vertices);
  std::memcpy(static_cast<void*>(vertices.data()), rest.data(), num_vertices * kVertexBytes);
  const char* face = rest.data() + num_vertices * kVertexBytes;
  std::vector<std::uint32_t> ends(mesh.parts.size(), 0);  // Of the parts' vertices.
  mesh.num_faces = num_faces;
  for (std::uint32_t i = 0; i < num_faces; ++i, face += kFaceBytes) {
    std::array<std::uint16_t, 3> corners{};
    std::memcpy(corners.data(), face + 1, sizeof corners);
    const auto part = static_cast<std::uint8_t>(face[7]);
    mesh.parts.at(part).mesh.triangles.push_back({corners[0], corners[1], corners[2]});
    ends[part] = std::max({ends[part], corners[0] + 1U, corners[1] + 1U, corners[2] + 1U});
    const Eigen::Vector3f& first = vertices.at(corners[0]);
    mesh.area_m2 +=
        0.5 * static_cast<double>(
                  (vertices.at(corners[1]) - first).cross(vertices.at(corners[2]) - first).norm());
  }
  std::uint32_t begin = 0;
  for (std::size_t part = 0; part < ends.size(); ++part) {
    Mesh& own = mesh.parts[part].mesh;
    own.vertices.assign(vertices.begin() + begin, vertices.begin() + ends[part]);
    for (auto& triangle : own.triangles) {
      for (std::uint32_t& corner : triangle) corner -= begin;
    }
    begin = ends[part];
  }
  mesh.origin_m = Vector3::Zero();
  return mesh;
}

}  // namespace railcast
