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
/// every value except those that are absent.
class JsonWriter {
 public:
  template <class T, class Rule = Anything>
  void Required(std::string_view key, T& value, const char* /*doc*/, const Rule& = {}) {
    object_[std::string(key)] = Write(value);
  }
  template <class T, class Rule = Anything>
  void Optional(std::string_view key, T& value, const char* /*doc*/, const Rule& = {}) {
    object_[std::string(key)] = Write(value);
  }
  template <class T, class Rule = Anything>
  void Optional(std::string_view key, std::optional<T>& value, const char* doc, const Rule& = {}) {
    if (value) Optional(key, *value, doc);
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
  [[nodiscard]] static Json Write(T& value);

 private:
  template <class... Ts>
  [[nodiscard]] static Json WriteVariant(std::variant<Ts...>& value);

  Json object_ = Json::object();
};

template <class T>
Json JsonWriter::Write(T& value) {
  if constexpr (requires { value.valueless_by_exception(); }) {
    return WriteVariant(value);
  } else if constexpr (NamedEnum<std::remove_const_t<T>> ||
                       std::is_same_v<std::remove_const_t<T>, ObjectType>) {
    return NameOf(value);
  } else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
    return value;
  } else if constexpr (requires { value.begin(); }) {
    Json list = Json::array();
    for (auto& element : value) list.push_back(Write(element));
    return list;
  } else {
    JsonWriter writer;
    Describe(writer, value);
    return std::move(writer.object_);
  }
}

template <class... Ts>
Json JsonWriter::WriteVariant(std::variant<Ts...>& value) {
  return std::visit(
      []<class T>(T& alternative) {
        Json json = {{"type", kTypeName<T>}};
        json.update(Write(alternative));
        return json;
      },
      value);
}

}  // namespace railcast
