#include "core/mesh/assimp_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/mesh/gltf_buffers.h"
#include "core/mesh/limited_process.h"
#include "core/mesh/mesh_format.h"
#include "core/mesh/scene_gatherer.h"

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

/// A scene's mesh as bytes, for another process of the same program.
std::string BytesOfScene(const SceneMesh& mesh) {
  const PolygonSoup& soup = mesh.soup;
  ByteWriter writer;
  writer.Put(mesh.unit_m);
  writer.Put(mesh.y_up);
  writer.Put(mesh.is_mirrored);
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

/// The mesh of BytesOfScene(); nothing if the bytes are damaged, or a face of it names what is not
/// there.
std::optional<SceneMesh> SceneOfBytes(std::string_view bytes) {
  SceneMesh mesh;
  PolygonSoup& soup = mesh.soup;
  ByteReader reader(bytes);
  reader.Get(mesh.unit_m);
  reader.Get(mesh.y_up);
  reader.Get(mesh.is_mirrored);
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

std::string_view WithoutEndBlanks(std::string_view text) {
  constexpr std::string_view kXmlBlanks = " \t\r\n";
  text.remove_prefix(std::min(text.find_first_not_of(kXmlBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kXmlBlanks) + 1);
}

/// Takes what comes before `end` off the text, with `end` itself.
std::string_view TakeThrough(std::string_view& rest, std::string_view end) {
  const std::size_t place = rest.find(end);
  const std::string_view part =
      rest.substr(0, place == std::string_view::npos ? place : place + end.size());
  rest.remove_prefix(part.size());
  return part;
}

/// Takes a tag, which begins with "<", off the text and appends it with its attributes trimmed.
void AppendTag(std::string_view& rest, std::string& plain) {
  while (!rest.empty()) {
    const std::size_t stop = std::min(rest.find_first_of(">\"'"), rest.size() - 1);
    const char found = rest[stop];
    plain += rest.substr(0, stop + 1);
    rest.remove_prefix(stop + 1);
    if (found == '>') return;
    if (found != '"' && found != '\'') continue;
    std::string_view value = TakeThrough(rest, {&found, 1});
    const bool is_closed = value.ends_with(found);
    if (is_closed) value.remove_suffix(1);
    plain += WithoutEndBlanks(value);
    if (is_closed) plain += found;
  }
}

// A DAE file as assimp understands it: in UTF-8, and without blanks at the ends of values. XML
// Schema passes over these in all values that DAE has, but assimp 5.2 takes a unit of " 0.01 " for
// 1 m, an axis of " Z_UP " for the default, y, and does not find what " #mesh " names.
std::string PlainDae(std::string bytes) {
  const std::string xml = AsUtf8(std::move(bytes));
  std::string plain;
  plain.reserve(xml.size());
  std::string_view rest = xml;
  while (!rest.empty()) {
    const std::string_view text = rest.substr(0, rest.find('<'));
    rest.remove_prefix(text.size());
    plain += WithoutEndBlanks(text);
    if (rest.starts_with("<!--")) {
      plain += TakeThrough(rest, "-->");
    } else if (rest.starts_with("<![CDATA[")) {
      plain += TakeThrough(rest, "]]>");
    } else if (rest.starts_with("<?")) {
      plain += TakeThrough(rest, "?>");
    } else {
      AppendTag(rest, plain);
    }
  }
  return plain;
}

/// By it assimp chooses its reader.
std::string ExtensionOf(MeshFormat format) {
  switch (format) {
    case MeshFormat::kGltf:
      return "gltf";
    case MeshFormat::kGlb:
      return "glb";
    case MeshFormat::kFbx:
      return "fbx";
    case MeshFormat::kDae:
      return "dae";
    default:
      return "3ds";
  }
}

/// The files of a scene, and no others: what is read is what is recorded.
class FilesInMemory final : public Assimp::IOSystem {
 public:
  FilesInMemory(const SceneSource& source, std::string name)
      : source_(source), name_(std::move(name)) {}

  bool Exists(const char* file) const override { return Find(file) != nullptr; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char*) override {
    const std::string* bytes = Find(file);
    if (bytes == nullptr) return nullptr;
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes->data()),
                                      bytes->size());
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  [[nodiscard]] const std::string* Find(std::string_view file) const {
    if (file.starts_with('/')) file.remove_prefix(1);  // Where it joins an empty folder's name.
    if (file == name_) return &source_.bytes;
    const std::string name = FileOfUri(std::string(file));
    for (const FileBeside& beside : source_.beside) {
      if (name == beside.name || name == "./" + beside.name) return &beside.bytes;
    }
    return nullptr;
  }

  const SceneSource& source_;
  std::string name_;
};

/// FBX files say what their unit is, in centimetres. assimp has turned and scaled glTF and DAE to
/// metres with y up.
void TakeUnits(const aiScene& scene, MeshFormat format, SceneMesh& mesh) {
  if (format == MeshFormat::k3ds) mesh.y_up = false;
  if (format != MeshFormat::kFbx) return;
  mesh.unit_m = 0.01;
  if (scene.mMetaData == nullptr) return;
  float unit_cm = 0.0F;
  double unit_cm_double = 0.0;
  if (scene.mMetaData->Get("UnitScaleFactor", unit_cm_double))
    unit_cm = float(unit_cm_double);
  else
    (void)scene.mMetaData->Get("UnitScaleFactor", unit_cm);
  if (unit_cm > 0.0F) mesh.unit_m = 0.01 * static_cast<double>(unit_cm);
}

/// From an FBX file's axes, which it names, to x to the right, -y to the front and z up.
Eigen::Matrix3d AxesOfFbx(const aiScene& scene, const std::string& shown) {
  struct NamedAxis {
    const char* name;
    int axis;
    int sign = 1;
  };
  std::array<NamedAxis, 3> axes = {{{"CoordAxis", 0}, {"FrontAxis", 2}, {"UpAxis", 1}}};
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  std::string text;
  for (std::size_t row = 0; row < axes.size(); ++row) {
    NamedAxis& one = axes[row];
    if (scene.mMetaData != nullptr) {
      (void)scene.mMetaData->Get(one.name, one.axis);
      (void)scene.mMetaData->Get(one.name + std::string("Sign"), one.sign);
    }
    text += (text.empty() ? "" : ", ") + std::string(one.name) + " " + std::to_string(one.sign) +
            " * " + std::to_string(one.axis);
    if (one.axis < 0 || one.axis > 2) continue;
    matrix(static_cast<Eigen::Index>(row), one.axis) = row == 1 ? -one.sign : one.sign;
  }
  if (std::abs(matrix.determinant()) != 1.0) {
    throw InputError(shown + ": its axes must be three of 0, 1 and 2 with signs 1 or -1 (got " +
                     text + ")");
  }
  return matrix;
}

/// Checks the lengths in a binary glTF file's header, as much as which assimp would allocate.
void CheckGlb(const std::string& bytes, const std::string& shown) {
  constexpr std::size_t kHeaderBytes = 20;
  const auto number_at = [&](std::size_t place) {
    std::uint32_t number = 0;
    std::memcpy(&number, bytes.data() + place, sizeof(number));
    return number;
  };
  if (bytes.size() < kHeaderBytes) throw InputError(shown + ": ends within its header");
  if (number_at(4) != 1 && number_at(4) != 2)
    throw InputError(shown + ": must be glTF of version 1 or 2" + Got(number_at(4)));
  if (number_at(12) > bytes.size() - kHeaderBytes) {
    throw InputError(shown + ": ends within its first chunk of " + std::to_string(number_at(12)) +
                     " bytes");
  }
  // assimp looks for what follows behind a multiple of 4 bytes, as the format has it.
  if (number_at(12) % 4 != 0 && number_at(12) < bytes.size() - kHeaderBytes) {
    throw InputError(shown + ": its first chunk must have a multiple of 4 bytes" +
                     Got(number_at(12)));
  }
}

/// Throws if assimp has left out triangles, as it does with those of vertices that are not there.
void CheckTriangles(const aiScene& scene, const SceneSource& source, const std::string& shown) {
  if (source.format != MeshFormat::kGltf && source.format != MeshFormat::kGlb) return;
  const auto num_stated = TrianglesOfGltf(source.bytes, scene.mNumMeshes);
  std::size_t num_read = 0;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) num_read += scene.mMeshes[i]->mNumFaces;
  if (!num_stated || num_read == *num_stated) return;
  throw InputError(shown + ": must have " + NumberText(*num_stated) +
                   " triangles of vertices that are there" + Got(num_read));
}

/// What assimp makes of a scene, in this process.
SceneMesh ImportScene(const SceneSource& source,
                      SceneGathering gathering,
                      const std::string& extension) {
  Assimp::Importer importer;
  const std::string name = "mesh." + extension;
  importer.SetIOHandler(new FilesInMemory(source, name));
  // Everything but triangles' corners and what holds them only takes time.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                              aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                  aiComponent_TEXCOORDS | aiComponent_ANIMATIONS |
                                  aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS);
  const aiScene* scene = importer.ReadFile(name, aiProcess_RemoveComponent);
  if (scene == nullptr) {
    const std::string said = importer.GetErrorString();
    if (said.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
    throw InputError(gathering.shown + ": cannot be read as " + extension + ": " + ShownText(said));
  }
  CheckTriangles(*scene, source, gathering.shown);
  if (source.format == MeshFormat::k3ds) {
    // assimp turns all of them from z up to y up, but their unit and upward axis are not known.
    gathering.file_from_scene.matrix() << 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1;
  }
  const bool has_axes = source.format == MeshFormat::kFbx && !source.keeps_axes;
  if (has_axes) gathering.file_from_scene.linear() = AxesOfFbx(*scene, gathering.shown);
  SceneMesh mesh{.soup = GatherScene(*scene, gathering)};
  if (has_axes) mesh.y_up = false;
  mesh.is_mirrored = gathering.file_from_scene.linear().determinant() < 0.0;
  TakeUnits(*scene, source.format, mesh);
  return mesh;
}

/// Far more than real files take: assimp holds some ten times the bytes of a binary file, up to
/// fifty of one in text.
ProcessLimits LimitsOf(const SceneSource& source) {
  constexpr std::uint64_t kLeastMemory_bytes = 600'000'000;
  constexpr std::uint64_t kMemoryFactor = 100;
  constexpr std::uint64_t kLeastTime_s = 60;
  constexpr std::uint64_t kBytesPerS = 500'000;
  std::uint64_t num_bytes = source.bytes.size();
  for (const FileBeside& beside : source.beside) num_bytes += beside.bytes.size();
  return {.memory_bytes = kLeastMemory_bytes + kMemoryFactor * num_bytes,
          .time_s = kLeastTime_s + num_bytes / kBytesPerS};
}

}  // namespace

bool HasAssimp() {
  return true;
}

SceneMesh ReadScene(SceneSource source, const std::string& shown) {
  if (source.format == MeshFormat::kGlb) CheckGlb(source.bytes, shown);
  std::vector<std::string> unread;
  if (source.format == MeshFormat::kGltf || source.format == MeshFormat::kGlb) {
    unread = CheckGltf(source.bytes, shown);
    MakePositionsFloats(source, shown);
  }
  const std::string extension = ExtensionOf(source.format);
  if (source.format == MeshFormat::kDae) source.bytes = PlainDae(std::move(source.bytes));
  const SceneGathering gathering{.shown = shown};
  const ProcessLimits limits = LimitsOf(source);
  ProcessEnd end =
      RunLimited(limits, [&] { return BytesOfScene(ImportScene(source, gathering, extension)); });
  switch (end.kind) {
    case ProcessEnd::Kind::kFault:
      throw InputError(end.bytes);
    case ProcessEnd::Kind::kLackMemory:
      throw InputError(shown + ": must not take more than " +
                       std::to_string(limits.memory_bytes / 1'000'000) + " MB of memory to read");
    case ProcessEnd::Kind::kLackTime:
      throw InputError(shown + ": must not take more than " + std::to_string(limits.time_s) +
                       " s to read");
    default:
      break;
  }
  std::optional<SceneMesh> mesh;
  if (end.kind == ProcessEnd::Kind::kDone) mesh = SceneOfBytes(end.bytes);
  if (!mesh) {
    throw InputError(shown + ": cannot be read as " + extension +
                     ": it is damaged or nested too deeply, and assimp broke off");
  }
  if (mesh->is_mirrored) AddRemark({RemarkKind::kAxesMirrored, {}}, mesh->soup.remarks);
  for (const std::string& name : unread) {
    AddRemark({RemarkKind::kExtensionUnread, {}, 1, Quoted(name)}, mesh->soup.remarks);
  }
  return *std::move(mesh);
}

}  // namespace railcast
