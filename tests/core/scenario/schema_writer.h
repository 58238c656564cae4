#pragma once

#include <concepts>
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
#include "core/scenario/json_writer.h"
#include "core/scenario/object_types.h"

namespace railcast {

/// Adds a rule to a schema, as far as JSON Schema can express it.
void AddRule(Json& schema, Anything);
void AddRule(Json& schema, const Limits& limits);
void AddRule(Json& schema, const NumberChoices& choices);
void AddRule(Json& schema, const AllowedNames& choices);
void AddRule(Json& schema, NonEmptyString);
void AddRule(Json& schema, OneLine);
void AddRule(Json& schema, HostAndPort);
void AddRule(Json& schema, ExistingFile);
void AddRule(Json& schema, const AtLeastElements& rule);
void AddRule(Json& schema, const EachNumber& rule);
void AddRule(Json& schema, const NonEmptyListIf& rule);

/// The archive that documents (see describe_scenario.h): makes the JSON Schema (draft 2020-12) of a
/// struct's object. The schema does not contain rules across fields.
class SchemaWriter {
 public:
  template <class T, class Rule = Anything>
  void Required(std::string_view key, T& value, const char* doc, const Rule& rule = {}) {
    Add(key, doc, SchemaOf(value, rule));
    if (key != given_by_file_) required_.push_back(std::string(key));
  }
  template <class T, class Rule = Anything>
  void Optional(std::string_view key, T& value, const char* doc, const Rule& rule = {}) {
    Json schema = SchemaOf(value, rule);
    if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string> || kIsArray<T> ||
                  NamedEnum<T>) {
      schema["default"] = JsonWriter::Write(value);
    }
    Add(key, doc, std::move(schema));
  }
  template <class T>
  void Preset(std::string_view key,
              std::optional<std::string>& file,
              const char* doc,
              const FilePreset<T>& preset) {
    Optional(key, file, doc, ExistingFile{});
    given_by_file_ = preset.gives;
  }
  // No schema rule: the resolved scenario has both keys, one of them with its default.
  void OneOfTwo(std::string_view, std::string_view) {}
  void Alternative(std::string_view key,
                   double& value,
                   const Multiple& multiple,
                   const char* doc,
                   const Limits& limits);
  template <class T>
  void RequiredLibrary(std::string_view key, std::vector<T>& values, const char* doc) {
    Add(key, doc, {{"anyOf", {FileNameSchema(), SchemaOf(values, NonEmptyList())}}});
    required_.push_back(std::string(key));
  }
  template <class T>
  void Types(std::string_view key, std::vector<T>& models, const char* doc) {
    Add(key, doc, {{"anyOf", {FileNameSchema(), SchemaOf(models, NonEmptyList())}}});
  }
  void Switches(std::string_view key,
                const std::map<std::string, bool>&,
                const char* doc,
                const std::vector<std::string>& names);
  void Ensure(const std::vector<std::string>&, bool, const std::string&) {}
  template <class T, class V>
  void Unique(std::string_view, const std::vector<T>&, std::string_view, V T::*) {}

  /// The schema of an object written in place.
  [[nodiscard]] Json PlainObject() const;
  /// The schema of an object that may name a base file with the keys that it lacks.
  [[nodiscard]] Json ObjectWithBase() const;
  /// The schema of a file with that object. @param title Name of the schema in editors.
  [[nodiscard]] Json File(const std::string& title) const;

 private:
  [[nodiscard]] static Json FileNameSchema();
  void Add(std::string_view key, const char* doc, Json schema);

  template <class T, class Rule>
  [[nodiscard]] static Json SchemaOf(T& value, const Rule& rule);
  template <class T, class Rule>
  [[nodiscard]] static Json SchemaOf(std::optional<T>&, const Rule& rule) {
    T value{};
    return SchemaOf(value, rule);
  }
  template <class T, std::size_t kCount, class Rule>
  [[nodiscard]] static Json SchemaOf(std::array<T, kCount>& values, const Rule& rule) {
    return {{"type", "array"},
            {"items", SchemaOf(values[0], rule)},
            {"minItems", kCount},
            {"maxItems", kCount}};
  }
  template <class T, class Rule>
  [[nodiscard]] static Json SchemaOf(std::vector<T>&, const Rule& rule);
  template <class... Ts>
  [[nodiscard]] static Json SchemaOf(std::variant<Ts...>&, Anything);
  template <class T>
  [[nodiscard]] static Json SchemaOfElement();

  Json properties_ = Json::object();
  std::vector<std::string> required_;
  std::string given_by_file_;           // A required key that may be left out for a file.
  std::vector<std::string> exclusive_;  // Two keys that may not both be given.
};

template <class T, class Rule>
Json SchemaWriter::SchemaOf(T& value, const Rule& rule) {
  if constexpr (std::is_same_v<T, ObjectType>) {
    // Editors offer the types that railcast has; a scenario's own table may have others.
    return {{"type", "string"}, {"minLength", 1}, {"examples", ObjectTypes().Names()}};
  } else if constexpr (std::is_class_v<T> && !std::is_same_v<T, std::string>) {
    SchemaWriter writer;
    Describe(writer, value);
    if constexpr (kIsWrittenInPlace<T>) return writer.PlainObject();
    return {{"anyOf", {FileNameSchema(), writer.ObjectWithBase()}}};
  } else {
    Json schema;
    if constexpr (std::is_same_v<T, bool>) {
      schema = {{"type", "boolean"}};
    } else if constexpr (std::integral<T>) {
      schema = {{"type", "integer"}, {"minimum", 0}, {"maximum", std::numeric_limits<T>::max()}};
    } else if constexpr (std::is_arithmetic_v<T>) {
      schema = {{"type", "number"}};
    } else {
      schema = {{"type", "string"}};
    }
    if constexpr (NamedEnum<T>) AddRule(schema, OneOf(NamesOf<T>()));
    AddRule(schema, rule);
    return schema;
  }
}

template <class T>
Json SchemaWriter::SchemaOfElement() {
  T value{};
  if constexpr (kIsArray<T> || kIsVariant<T> || kElementMayBeFile<T>) {
    return SchemaOf(value, Anything{});
  } else {
    SchemaWriter writer;
    Describe(writer, value);
    return writer.PlainObject();
  }
}

template <class T, class Rule>
Json SchemaWriter::SchemaOf(std::vector<T>&, const Rule& rule) {
  Json schema = {{"type", "array"}};
  if constexpr (std::is_same_v<T, std::string>) {
    T value;
    schema["items"] = SchemaOf(value, rule);
  } else {
    schema["items"] = SchemaOfElement<T>();
    AddRule(schema, rule);
  }
  return schema;
}

template <class... Ts>
Json SchemaWriter::SchemaOf(std::variant<Ts...>&, Anything) {
  Json alternatives = Json::array();
  const auto add = [&]<class T>(T alternative) {
    SchemaWriter writer;
    writer.properties_["type"] = {{"const", kTypeName<T>}};
    writer.required_.emplace_back("type");
    Describe(writer, alternative);
    alternatives.push_back(writer.PlainObject());
  };
  (add(Ts{}), ...);
  return {{"oneOf", alternatives}};
}

}  // namespace railcast
