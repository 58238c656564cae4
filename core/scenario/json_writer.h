#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/scenario/json_rules.h"
#include "core/scenario/json_text.h"
#include "railcast/enum_names.h"
#include "railcast/objects.h"

namespace railcast {

/// The archive that writes (see describe_scenario.h): makes a JSON object from a struct. It writes
/// every value except those that are absent or, if the text shall be short, those that a reader
/// would assume anyway.
class JsonWriter {
 public:
  template <class T, class Rule = Anything>
  void Required(std::string_view key, T& value, const char* /*doc*/, const Rule& = {}) {
    object_[std::string(key)] = Written(value, AssumedOf(key));
  }
  template <class T, class Rule = Anything>
  void Optional(std::string_view key, T& value, const char* /*doc*/, const Rule& = {}) {
    const Json* const assumed = AssumedOf(key);
    if (assumed != nullptr && *assumed == Write(value)) return;
    object_[std::string(key)] = Written(value, assumed);
  }
  template <class T, class Rule = Anything>
  void Optional(std::string_view key, std::optional<T>& value, const char* doc, const Rule& = {}) {
    if (value) Optional(key, *value, doc);
  }
  template <class T>
  void Preset(std::string_view key,
              std::optional<std::string>& file,
              const char* doc,
              const FilePreset<T>&) {
    Optional(key, file, doc);
  }
  template <class T>
  void RequiredLibrary(std::string_view key, std::vector<T>& values, const char* doc) {
    Required(key, values, doc);
  }
  template <class T>
  void Types(std::string_view key, std::vector<T>& models, const char* doc) {
    if (!models.empty()) Required(key, models, doc);
  }
  void Switches(std::string_view key,
                const std::map<std::string, bool>& switches,
                const char* /*doc*/,
                const std::vector<std::string>& /*names*/) {
    object_[std::string(key)] = switches;
  }

  // The writer ignores alternative keys and rules.
  void OneOfTwo(std::string_view, std::string_view) {}
  void Alternative(std::string_view, double, const Multiple&, const char*, const Limits&) {}
  void Ensure(const std::vector<std::string>&, bool, const std::string&) {}
  template <class T, class V>
  void Unique(std::string_view, const std::vector<T>&, std::string_view, V T::*) {}

  template <class T>
  [[nodiscard]] static Json Write(T& value) {
    return JsonWriter().Written(value, nullptr);
  }
  /// As Write(), but without the optional keys that have their defaults.
  template <class T>
  [[nodiscard]] static Json WriteShort(T& value) {
    JsonWriter writer;
    writer.is_short_ = true;
    return writer.Written(value, nullptr);
  }

 private:
  /// @param assumed What a reader starts from; null = the type's defaults.
  template <class T>
  [[nodiscard]] Json Written(T& value, const Json* assumed) const;
  [[nodiscard]] const Json* AssumedOf(std::string_view key) const {
    const auto it = assumed_.find(std::string(key));
    return it == assumed_.end() ? nullptr : &*it;
  }

  bool is_short_ = false;
  Json assumed_ = Json::object();  // The keys that a reader knows; none if the text is not short.
  Json object_ = Json::object();
};

template <class T>
Json JsonWriter::Written(T& value, const Json* assumed) const {
  using Plain = std::remove_const_t<T>;
  if constexpr (kIsVariant<Plain>) {
    return std::visit(
        [&]<class Alternative>(Alternative& alternative) {
          Json json = {{"type", kTypeName<std::remove_const_t<Alternative>>}};
          json.update(Written(alternative, nullptr));
          return json;
        },
        value);
  } else if constexpr (NamedEnum<Plain> || std::is_same_v<Plain, ObjectType>) {
    return NameOf(value);
  } else if constexpr (std::is_arithmetic_v<Plain> || std::is_same_v<Plain, std::string>) {
    return value;
  } else if constexpr (requires { value.begin(); }) {
    Json list = Json::array();
    for (auto& element : value) list.push_back(Written(element, nullptr));
    return list;
  } else {
    JsonWriter writer;
    writer.is_short_ = is_short_;
    if (is_short_) {
      Plain standard{};
      writer.assumed_ = assumed != nullptr ? *assumed : Write(standard);
    }
    Describe(writer, value);
    return std::move(writer.object_);
  }
}

}  // namespace railcast
