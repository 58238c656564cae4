#include "core/mesh/soup_bytes.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

namespace railcast {
namespace {

class ByteWriter {
 public:
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void Put(const T& value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value)); }
  template <typename T>
  requires std::is_arithmetic_v<T>
  void Put(const std::vector<T>& values) {
    Put(std::uint64_t{values.size()});
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  void Put(const std::vector<std::string>& texts) {
    Put(std::uint64_t{texts.size()});
    for (const std::string& text : texts) {
      Put(std::uint64_t{text.size()});
      bytes_ += text;
    }
  }

  [[nodiscard]] std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads what ByteWriter wrote; once something is not there, everything is empty.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void Get(T& value) {
    const std::string_view part = TakeBytes(sizeof(value));
    if (!is_damaged_) std::memcpy(&value, part.data(), sizeof(value));
  }
  template <typename T>
  requires std::is_arithmetic_v<T>
  void Get(std::vector<T>& values) {
    const std::string_view part = TakeBytes(Count(sizeof(T)) * sizeof(T));
    values.resize(part.size() / sizeof(T));
    if (!part.empty()) std::memcpy(values.data(), part.data(), part.size());
  }
  void Get(std::vector<std::string>& texts) {
    const std::uint64_t num = Count(sizeof(std::uint64_t));
    for (std::uint64_t i = 0; i < num && !is_damaged_; ++i) texts.emplace_back(TakeBytes(Count(1)));
  }

  /// Whether all was there, and nothing else.
  [[nodiscard]] bool is_whole() const { return !is_damaged_ && rest_.empty(); }
  [[nodiscard]] bool is_damaged() const { return is_damaged_; }

  /// A number of elements, each of at least so many bytes; 0 if there cannot be as many.
  [[nodiscard]] std::uint64_t Count(std::size_t least_bytes) {
    std::uint64_t num = 0;
    Get(num);
    if (num <= rest_.size() / least_bytes) return num;
    is_damaged_ = true;
    return 0;
  }

 private:
  std::string_view TakeBytes(std::size_t num) {
    if (num > rest_.size()) is_damaged_ = true;
    if (is_damaged_) return {};
    const std::string_view part = rest_.substr(0, num);
    rest_.remove_prefix(num);
    return part;
  }

  std::string_view rest_;
  bool is_damaged_ = false;
};

/// NaN stands for a luminance that is not known.
std::vector<double> NumbersOf(const std::vector<std::optional<double>>& values) {
  std::vector<double> numbers;
  for (const auto& value : values) {
    numbers.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return numbers;
}

bool NamesWhatIsThere(const PolygonSoup& soup) {
  const auto is_name = [](std::uint32_t index, const std::vector<std::string>& names) {
    return index == PolygonSoup::kUnnamed || index < names.size();
  };
  return std::ranges::all_of(soup.faces, [&](const PolygonSoup::Face& face) {
    return face.corners.size() >= 3 && is_name(face.material, soup.materials) &&
           is_name(face.group, soup.groups) &&
           std::ranges::all_of(face.corners,
                               [&](std::uint32_t corner) { return corner < soup.points.size(); });
  });
}

}  // namespace

std::string BytesOfScene(const SceneMesh& mesh) {
  const PolygonSoup& soup = mesh.soup;
  ByteWriter writer;
  writer.Put(mesh.unit_m);
  writer.Put(mesh.y_up);
  writer.Put(soup.materials);
  writer.Put(NumbersOf(soup.luminances));
  writer.Put(soup.groups);
  writer.Put(std::uint64_t{soup.num_cornerless});
  writer.Put(std::uint64_t{soup.points.size()});
  for (const Vector3& point : soup.points) {
    for (const double coordinate : point) writer.Put(coordinate);
  }
  writer.Put(std::uint64_t{soup.faces.size()});
  for (const PolygonSoup::Face& face : soup.faces) {
    writer.Put(face.corners);
    writer.Put(face.material);
    writer.Put(face.group);
  }
  return writer.Take();
}

std::optional<SceneMesh> SceneOfBytes(std::string_view bytes) {
  SceneMesh mesh;
  PolygonSoup& soup = mesh.soup;
  ByteReader reader(bytes);
  reader.Get(mesh.unit_m);
  reader.Get(mesh.y_up);
  reader.Get(soup.materials);
  std::vector<double> luminances;
  reader.Get(luminances);
  for (const double value : luminances) {
    soup.luminances.push_back(value >= 0.0 ? std::optional(value) : std::nullopt);
  }
  reader.Get(soup.groups);
  std::uint64_t num_cornerless = 0;
  reader.Get(num_cornerless);
  soup.num_cornerless = num_cornerless;
  soup.points.resize(reader.Count(sizeof(double[3])));
  for (Vector3& point : soup.points) {
    for (double& coordinate : point) reader.Get(coordinate);
  }
  const std::uint64_t num_faces = reader.Count(sizeof(std::uint64_t) + 2 * sizeof(std::uint32_t));
  for (std::uint64_t i = 0; i < num_faces && !reader.is_damaged(); ++i) {
    PolygonSoup::Face& face = soup.faces.emplace_back();
    reader.Get(face.corners);
    reader.Get(face.material);
    reader.Get(face.group);
  }
  if (!reader.is_whole() || !NamesWhatIsThere(soup)) return std::nullopt;
  return mesh;
}

}  // namespace railcast
