#include "generator/import/structures/structure_json.h"

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/scenario/describe_structures.h"
#include "core/scenario/json_writer.h"

namespace railcast {
namespace {

/// An archive (describe_scenario.h) that writes what differs from the defaults.
class ShortWriter {
 public:
  explicit ShortWriter(Json defaults) : defaults_(std::move(defaults)) {}

  template <class T>
  [[nodiscard]] static Json Write(T value) {
    T standard;
    ShortWriter writer(JsonWriter::Write(standard));
    Describe(writer, value);
    return std::move(writer.object_);
  }

  template <class T, class Rule = Anything>
  void Required(std::string_view key, T& value, const char* /*doc*/, const Rule& = {}) {
    object_[std::string(key)] = JsonWriter::Write(value);
  }
  template <class T, class Rule = Anything>
  void Optional(std::string_view key, T& value, const char* /*doc*/, const Rule& = {}) {
    const std::string name(key);
    Json json = JsonWriter::Write(value);
    if (!defaults_.contains(name) || defaults_[name] != json) object_[name] = std::move(json);
  }
  template <class Rule = Anything>
  void Optional(std::string_view key,
                std::optional<PlatformRoofSpec>& value,
                const char* /*doc*/,
                const Rule& = {}) {
    if (value) object_[std::string(key)] = Write(*value);
  }
  template <class T, class Rule = Anything>
  void Optional(std::string_view key, std::optional<T>& value, const char* doc, const Rule& = {}) {
    if (value) Optional(key, *value, doc);
  }

  // Rules do not concern a writer.
  void OneOfTwo(std::string_view, std::string_view) {}
  void Ensure(const std::vector<std::string>&, bool, const std::string&) {}

 private:
  Json defaults_;
  Json object_ = Json::object();
};

}  // namespace

nlohmann::ordered_json JsonOf(const StructureSpec& structure) {
  return std::visit(
      []<class T>(const T& spec) {
        nlohmann::ordered_json json = {{"type", kTypeName<T>}};
        json.update(ShortWriter::Write(spec));
        return json;
      },
      structure);
}

}  // namespace railcast
