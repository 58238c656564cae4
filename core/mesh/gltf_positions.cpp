#include <algorithm>
#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/number_type.h"
#include "core/base/text.h"
#include "core/mesh/gltf_buffers.h"
#include "railcast/transform.h"

namespace railcast {
namespace {

using nlohmann::json;

constexpr int kFloatType = 5126;
constexpr const char* kBodyName = "railcast/body";  // No file beside another has such a name.
constexpr const char* kPositionsName = "railcast/positions";

/// A number that says how many, or where; `other` if it is not there or is none.
std::size_t SizeIn(const json& object, const char* key, std::size_t other) {
  const json& value = ValueIn(object, key);
  return value.is_number_unsigned() ? value.get<std::size_t>() : other;
}

std::string BytesOfBase64(std::string_view text) {
  using namespace boost::archive::iterators;
  using Bytes = transform_width<binary_from_base64<std::string_view::const_iterator>, 8, 6>;
  text = text.substr(0, text.find('='));
  text.remove_suffix(text.size() % 4 == 1 ? 1 : 0);
  const std::size_t num_bytes = text.size() * 6 / 8;
  std::string bytes(num_bytes, '\0');
  std::copy_n(Bytes(text.begin()), num_bytes, bytes.begin());
  return bytes;
}

/// What an accessor holds: so many elements, each of so many numbers of a type.
struct Elements {
  NumberType type{};
  std::size_t num_parts = 1;
  std::size_t count = 0;
};

class PositionWriter {
 public:
  PositionWriter(json& gltf, SceneSource& source, const std::string& shown)
      : gltf_(gltf), source_(source), shown_(shown) {}

  /// Gives each primitive of a mesh positions of its own.
  void Write(json& mesh, const std::vector<double>& weights) {
    for (json& primitive : mesh["primitives"]) {
      if (ValueIn(ValueIn(primitive, "attributes"), "POSITION").is_null()) continue;
      json& position = primitive["attributes"]["POSITION"];
      const json& targets = ValueIn(primitive, "targets");
      const auto key = std::pair(json::array({position, targets}).dump(), weights);
      const auto known = accessors_.find(key);
      const std::size_t accessor =
          known == accessors_.end() ? WriteAccessor(primitive, weights) : known->second;
      accessors_.insert({key, accessor});
      position = accessor;
      primitive.erase("targets");
    }
    mesh.erase("weights");
  }

  /// Puts what was written beside the file.
  void Finish() {
    gltf_["buffers"].push_back({{"uri", kPositionsName}, {"byteLength", written_.size()}});
    source_.beside.push_back({kPositionsName, std::move(written_)});
  }

 private:
  [[noreturn]] void Fail(const std::string& rule) const { throw InputError(shown_ + ": " + rule); }

  std::size_t WriteAccessor(const json& primitive, const std::vector<double>& weights) {
    constexpr std::size_t kMostBytes = 600'000'000;
    if (ValueIn(primitive, "extensions").contains("KHR_draco_mesh_compression")) {
      Fail(
          "positions of KHR_draco_mesh_compression must be floats and have no weights of morph "
          "targets");
    }
    const json& targets = ValueIn(primitive, "targets");
    if (!weights.empty() && weights.size() != targets.size()) {
      Fail("weights: must be one for each morph target (got " + NumberText(weights.size()) +
           " for " + NumberText(targets.size()) + ")");
    }
    const json base = primitive["attributes"]["POSITION"];
    const json& accessor = ValueIn(gltf_["accessors"], base);
    // The elements of the base are within its buffer, so that there are not too many of them.
    if (ValueIn(accessor, "bufferView").is_null())
      Fail("accessors/" + base.dump() + ": must have a bufferView");
    std::vector<Vector3> points;
    AddPositions(base, 1.0, points);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const json& target = ValueIn(targets[i], "POSITION");
      if (weights[i] != 0.0 && !target.is_null()) AddPositions(target, weights[i], points);
    }
    const std::size_t num_bytes = 3 * sizeof(float) * points.size();
    if (written_.size() + num_bytes > kMostBytes)
      Fail("positions must not be more than " + NumberText(kMostBytes / 1'000'000) + " MB");
    gltf_["bufferViews"].push_back({{"buffer", gltf_["buffers"].size()},
                                    {"byteOffset", written_.size()},
                                    {"byteLength", num_bytes}});
    gltf_["accessors"].push_back({{"bufferView", gltf_["bufferViews"].size() - 1},
                                  {"componentType", kFloatType},
                                  {"type", "VEC3"},
                                  {"count", points.size()}});
    for (const Vector3& point : points) {
      for (const double coordinate : point) {
        const auto number = static_cast<float>(coordinate);
        written_.append(reinterpret_cast<const char*>(&number), sizeof(number));
      }
    }
    return gltf_["accessors"].size() - 1;
  }

  /// Adds the weighted positions of an accessor, of which there must be as many as points if there
  /// are any of these.
  void AddPositions(const json& index, double weight, std::vector<Vector3>& points) {
    const json& accessor = ValueIn(gltf_["accessors"], index);
    const std::string place = "accessors/" + ShownText(index.dump());
    const std::size_t count = SizeIn(accessor, "count", 0);
    if (!points.empty() && count != points.size()) {
      Fail(place + "/count: must be " + NumberText(points.size()) + Got(count));
    }
    const Elements elements{TypeIn(accessor, place), 3, count};
    const bool is_normalised =
        ValueIn(accessor, "normalized") == true && elements.type != NumberType::kFloat;
    std::vector<Vector3> values(points.size(), Vector3::Zero());
    const auto take = [&](std::vector<double> numbers) {
      std::vector<Vector3> taken;
      for (std::size_t i = 0; i < numbers.size(); i += 3)
        taken.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
      return taken;
    };
    if (!ValueIn(accessor, "bufferView").is_null())
      values = take(NumbersIn(accessor, elements, is_normalised, place));
    const json& sparse = ValueIn(accessor, "sparse");
    if (!sparse.is_null()) {
      const std::size_t num = SizeIn(sparse, "count", 0);
      const json& at = ValueIn(sparse, "indices");
      const auto indices = NumbersIn(at, {TypeIn(at, place), 1, num}, false, place);
      const auto others =
          take(NumbersIn(ValueIn(sparse, "values"), {elements.type, 3, num}, is_normalised, place));
      for (std::size_t i = 0; i < num; ++i) {
        if (indices[i] < 0.0 || indices[i] >= static_cast<double>(values.size()))
          Fail(place + "/sparse: must name elements that are there" + Got(indices[i]));
        values[static_cast<std::size_t>(indices[i])] = others[i];
      }
    }
    points.resize(values.size(), Vector3::Zero());
    for (std::size_t i = 0; i < points.size(); ++i) points[i] += weight * values[i];
  }

  [[nodiscard]] NumberType TypeIn(const json& object, const std::string& place) const {
    const std::size_t type = SizeIn(object, "componentType", 0);
    const bool is_known = (type >= 5120 && type <= 5123) || type == 5125 || type == kFloatType;
    if (!is_known) Fail(place + "/componentType: must be 5120 to 5123, 5125 or 5126" + Got(type));
    return NumberType(type - 5119);
  }

  /// The numbers of an accessor or of a part of a sparse one.
  std::vector<double> NumbersIn(const json& object,
                                const Elements& elements,
                                bool is_normalised,
                                const std::string& place) {
    const json& view = ValueIn(gltf_["bufferViews"], ValueIn(object, "bufferView"));
    const std::string_view bytes = BytesOfBuffer(ValueIn(view, "buffer"), place);
    return VisitNumberType(elements.type, [&](auto zero) {
      using Number = decltype(zero);
      const auto largest = static_cast<double>(std::numeric_limits<Number>::max());
      const std::size_t size = elements.num_parts * sizeof(Number);
      const std::size_t stride = SizeIn(view, "byteStride", size);
      const std::size_t view_begin = std::min(SizeIn(view, "byteOffset", 0), bytes.size());
      const std::string_view part =
          bytes.substr(view_begin, SizeIn(view, "byteLength", bytes.size()));
      const std::size_t begin = std::min(SizeIn(object, "byteOffset", 0), part.size());
      const std::size_t room = part.size() - begin;
      const std::size_t most = room < size || stride == 0 ? 0 : (room - size) / stride + 1;
      if (elements.count > most)
        Fail(place + ": must lie within its bufferView, which holds " + NumberText(most) +
             " elements" + Got(elements.count));
      std::vector<double> numbers;
      numbers.reserve(elements.count * elements.num_parts);
      for (std::size_t i = 0; i < elements.count; ++i) {
        for (std::size_t k = 0; k < elements.num_parts; ++k) {
          const auto number = static_cast<double>(
              LoadAt<Number>(part.data() + begin + i * stride + k * sizeof(Number)));
          numbers.push_back(is_normalised ? std::max(number / largest, -1.0) : number);
        }
      }
      return numbers;
    });
  }

  std::string_view BytesOfBuffer(const json& index, const std::string& place) {
    const json& buffer = ValueIn(gltf_["buffers"], index);
    const json& uri = ValueIn(buffer, "uri");
    if (!uri.is_string()) Fail(place + ": must name a buffer that the file has");
    const auto name = uri.get<std::string>();
    constexpr std::string_view kBegin = ";base64,";
    if (name.starts_with("data:") && name.find(kBegin) != std::string::npos) {
      const auto [known, is_new] = decoded_.try_emplace(index.dump());
      if (is_new) {
        const std::string_view text = name;
        known->second = BytesOfBase64(text.substr(text.find(kBegin) + kBegin.size()));
      }
      return known->second;
    }
    for (const FileBeside& beside : source_.beside)
      if (beside.name == FileOfUri(name)) return beside.bytes;
    Fail(place + ": must name a buffer that the file has (got " + Quoted(name) + ")");
  }

  json& gltf_;
  SceneSource& source_;
  const std::string& shown_;
  std::string written_;
  std::map<std::pair<std::string, std::vector<double>>, std::size_t> accessors_;
  std::map<std::string, std::string> decoded_;  ///< Buffers within the file.
};

/// The weights of a node's morph targets; none if they move nothing.
std::vector<double> WeightsOf(const json& node, const json& mesh, const std::string& shown) {
  const json& own = ValueIn(node, "weights");
  std::vector<double> weights;
  for (const json& weight : own.is_null() ? ValueIn(mesh, "weights") : own) {
    if (!weight.is_number())
      throw InputError(shown + ": weights: must be numbers (got " + ShownText(weight.dump()) + ")");
    weights.push_back(weight.get<double>());
  }
  const bool is_any = std::ranges::any_of(weights, [](double weight) { return weight != 0.0; });
  return is_any ? weights : std::vector<double>();
}

bool HasWholePositions(const json& gltf, const json& mesh) {
  return std::ranges::any_of(ValueIn(mesh, "primitives"), [&](const json& primitive) {
    const json& index = ValueIn(ValueIn(primitive, "attributes"), "POSITION");
    const json& type = ValueIn(ValueIn(ValueIn(gltf, "accessors"), index), "componentType");
    return type.is_number() && type != kFloatType;
  });
}

/// Gives the body of a binary file a name, as text has it.
void NameBody(json& gltf, SceneSource& source) {
  const std::string& bytes = source.bytes;
  const std::size_t body = 28 + std::size_t{LoadAt<std::uint32_t>(bytes.data() + 12)};
  json& buffers = gltf["buffers"];
  const bool has_body = body <= bytes.size() && bytes.compare(body - 4, 4, "BIN\0", 4) == 0;
  if (has_body && buffers.is_array() && !buffers.empty() && buffers[0].is_object() &&
      !buffers[0].contains("uri")) {
    buffers[0]["uri"] = kBodyName;
    source.beside.push_back({kBodyName, bytes.substr(body)});
  }
  source.format = MeshFormat::kGltf;
}

}  // namespace

void MakePositionsFloats(SceneSource& source, const std::string& shown) {
  json gltf = JsonOfGltf(source.bytes);
  const json meshes = ValueIn(gltf, "meshes");
  const auto is_moved = [&](const json& node) {
    const json& mesh = ValueIn(meshes, ValueIn(node, "mesh"));
    return HasWholePositions(gltf, mesh) || !WeightsOf(node, mesh, shown).empty();
  };
  for (const char* list : {"meshes", "nodes", "accessors", "bufferViews", "buffers"}) {
    if (!ValueIn(gltf, list).is_array()) return;
  }
  if (std::ranges::none_of(gltf["nodes"], is_moved)) return;
  if (source.format == MeshFormat::kGlb) NameBody(gltf, source);
  PositionWriter writer(gltf, source, shown);
  // The meshes as they stand in each pose; the first pose takes the mesh's own place.
  std::map<std::size_t, std::map<std::vector<double>, std::size_t>> posed;
  for (json& node : gltf["nodes"]) {
    const json& index = ValueIn(node, "mesh");
    const json& mesh = ValueIn(meshes, index);
    if (!mesh.is_object() || !ValueIn(mesh, "primitives").is_array()) continue;
    const std::vector<double> weights = WeightsOf(node, mesh, shown);
    auto& poses = posed[index.get<std::size_t>()];
    const bool is_first = poses.empty();
    const std::size_t next = is_first ? index.get<std::size_t>() : gltf["meshes"].size();
    const auto [pose, is_new] = poses.try_emplace(weights, next);
    if (is_new) {
      json moved = mesh;
      if (!weights.empty() || HasWholePositions(gltf, mesh)) writer.Write(moved, weights);
      if (is_first)
        gltf["meshes"][next] = std::move(moved);
      else
        gltf["meshes"].push_back(std::move(moved));
    }
    node["mesh"] = pose->second;
    node.erase("weights");
  }
  writer.Finish();
  source.bytes = gltf.dump();
}

}  // namespace railcast
