#include "tests/core/scenario/schema_writer.h"

#include <utility>

#include "core/scenario/descriptions.h"
#include "core/scenario/json_writer.h"
#include "core/scenario/object_types.h"

namespace railcast {
namespace {

constexpr const char* kOneLinePattern = "^[^\\u0000-\\u001f\\u007f]*$";

void AddLimits(Json& schema, const Limits& limits) {
  if (limits.above) schema["exclusiveMinimum"] = *limits.above;
  if (limits.at_least) schema["minimum"] = *limits.at_least;
  if (limits.at_most) schema["maximum"] = *limits.at_most;
}

void AddLeastCount(Json& schema, std::size_t count) {
  if (count > 0) schema["minItems"] = count;
}

void AddEachNumber(Json& schema, const EachNumber& rule) {
  AddLeastCount(schema, rule.at_least);
  Json& element = schema["items"];
  const bool is_object = element["type"] == "object";
  AddLimits(is_object ? element["properties"][rule.key] : element["items"], rule.limits);
}

// Adds a rule to a schema, as far as JSON Schema can express it.
void AddRule(Json& schema, const RuleRef& rule) {
  if (const auto* const limits = rule.As<Limits>()) AddLimits(schema, *limits);
  if (const auto* const choices = rule.As<NumberChoices>()) schema["enum"] = choices->numbers;
  if (const auto* const choices = rule.As<AllowedNames>()) schema["enum"] = choices->names;
  const bool is_filled = rule.As<NonEmptyString>() != nullptr;
  if (is_filled || rule.As<ExistingFile>() != nullptr) schema["minLength"] = 1;
  if (is_filled || rule.As<OneLine>() != nullptr) schema["pattern"] = kOneLinePattern;
  if (rule.As<HostAndPort>() != nullptr) schema["pattern"] = "^.+:[0-9]+$";
  if (const auto* const least = rule.As<AtLeastElements>()) AddLeastCount(schema, least->count);
  if (const auto* const each = rule.As<EachNumber>()) AddEachNumber(schema, *each);
}

Json FileNameSchema() {
  return {{"type", "string"}, {"minLength", 1}, {"description", "A file that holds it."}};
}

Json SchemaOfPlain(const ValueType& type) {
  using Kind = ValueType::Kind;
  switch (type.kind) {
    case Kind::kBool:
      return {{"type", "boolean"}};
    case Kind::kWhole:
      return {{"type", "integer"}, {"minimum", 0}, {"maximum", type.most}};
    case Kind::kNumber:
      return {{"type", "number"}};
    default:
      return {{"type", "string"}};
  }
}

bool HasDefault(const ValueType& type) {
  using Kind = ValueType::Kind;
  switch (type.kind) {
    case Kind::kBool:
    case Kind::kWhole:
    case Kind::kNumber:
    case Kind::kText:
    case Kind::kName:
    case Kind::kArray:
      return true;
    default:
      return false;
  }
}

}  // namespace

void SchemaWriter::Visit(const Key& key, const ValueRef& value) {
  Json schema = SchemaOf(value, key.rule);
  if (!key.is_required && HasDefault(*value.type)) schema["default"] = JsonWriter::Write(value);
  Add(key.name, key.doc, std::move(schema));
  if (key.is_required && key.name != given_by_file_) required_.emplace_back(key.name);
}

void SchemaWriter::Preset(std::string_view key,
                          std::optional<std::string>& file,
                          KeyDoc doc,
                          const FilePreset& preset) {
  Optional(key, file, doc, ExistingFile{});
  given_by_file_ = preset.gives;
}

void SchemaWriter::Alternative(std::string_view key,
                               double& value,
                               const Multiple& multiple,
                               KeyDoc doc,
                               const Limits& limits) {
  Add(key, doc, SchemaOf(RefTo(value), limits));
  exclusive_ = {std::string(key), multiple.of_key};
}

void SchemaWriter::VisitLibrary(const Key& key, const ValueRef& list) {
  AddFileOrList(key, list);
  required_.emplace_back(key.name);
}

void SchemaWriter::Types(std::string_view key, std::vector<ModelSpec>& models, KeyDoc doc) {
  AddFileOrList({key, doc, NonEmptyList(), false}, RefTo(models));
}

void SchemaWriter::AddFileOrList(const Key& key, const ValueRef& list) {
  Add(key.name, key.doc, {{"anyOf", {FileNameSchema(), SchemaOf(list, key.rule)}}});
}

void SchemaWriter::Switches(std::string_view key,
                            std::map<std::string, bool>& /*switches*/,
                            KeyDoc doc,
                            const std::vector<std::string>& names) {
  SchemaWriter writer;
  for (const std::string& name : names) writer.Add(name, doc, {{"type", "boolean"}});
  properties_[std::string(key)] = {{"anyOf", {FileNameSchema(), writer.ObjectWithBase()}}};
}

Json SchemaWriter::PlainObject() const {
  Json schema = {{"type", "object"}, {"properties", properties_}};
  if (!required_.empty()) schema["required"] = required_;
  if (!exclusive_.empty()) schema["not"] = {{"required", exclusive_}};
  schema["additionalProperties"] = false;
  return schema;
}

Json SchemaWriter::ObjectWithBase() const {
  Json schema = PlainObject();
  Json properties = {{"file", FileNameSchema()}};
  properties["file"]["description"] = "Has the keys that are not given here.";
  properties["version"] = {{"const", 1},
                           {"description", "As in a file that this was copied from."}};
  properties.update(schema["properties"]);
  schema["properties"] = properties;
  if (!required_.empty()) {
    schema.erase("required");
    // Anything will do: a file below the object that this one lies in may have them.
    schema["anyOf"] = {Json::object(), {{"required", required_}}};
  }
  return schema;
}

Json SchemaWriter::File(const std::string& title) const {
  SchemaWriter file;
  file.properties_ = {{"$schema", {{"type", "string"}}}, {"version", {{"const", 1}}}};
  file.properties_.update(properties_);
  file.required_ = required_;
  file.exclusive_ = exclusive_;
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
  schema.update(file.ObjectWithBase());
  if (!required_.empty()) schema["anyOf"][0] = {{"required", {"file"}}};
  schema["required"] = {"version"};
  return schema;
}

void SchemaWriter::Add(std::string_view key, KeyDoc doc, Json schema) {
  schema["description"] = doc.text();
  properties_[std::string(key)] = std::move(schema);
}

Json SchemaWriter::SchemaOf(const ValueRef& value, const RuleRef& rule) {
  using Kind = ValueType::Kind;
  const ValueType& type = *value.type;
  switch (type.kind) {
    case Kind::kObjectType:
      // Editors offer the types that railcast has; a scenario's own table may have others.
      return {{"type", "string"}, {"minLength", 1}, {"examples", ObjectTypes().Names()}};
    case Kind::kOptional: {
      return SchemaOf(NewValue(*type.of()).ref(), rule);
    }
    case Kind::kArray: {
      const std::size_t size = type.size(value.place);
      return {{"type", "array"},
              {"items", SchemaOf({type.at(value.place, 0), type.of()}, rule)},
              {"minItems", size},
              {"maxItems", size}};
    }
    case Kind::kList: {
      Json schema = {{"type", "array"}};
      if (type.of()->kind == Kind::kText) {
        schema["items"] = SchemaOf(NewValue(*type.of()).ref(), rule);
      } else {
        schema["items"] = SchemaOfElement(type);
        AddRule(schema, rule);
      }
      return schema;
    }
    case Kind::kVariant:
      return SchemaOfVariant(type);
    case Kind::kStruct: {
      SchemaWriter writer;
      type.describe(writer, value.place);
      if (type.is_written_in_place) return writer.PlainObject();
      return {{"anyOf", {FileNameSchema(), writer.ObjectWithBase()}}};
    }
    default: {
      Json schema = SchemaOfPlain(type);
      if (type.kind == Kind::kName) AddRule(schema, OneOf(type.names()));
      AddRule(schema, rule);
      return schema;
    }
  }
}

Json SchemaWriter::SchemaOfElement(const ValueType& list) {
  const ValueType& type = *list.of();
  const NewValue value(type);
  if (type.kind != ValueType::Kind::kStruct || list.element_may_be_file) {
    return SchemaOf(value.ref(), kAnything);
  }
  SchemaWriter writer;
  type.describe(writer, value.ref().place);
  return writer.PlainObject();
}

Json SchemaWriter::SchemaOfVariant(const ValueType& type) {
  Json alternatives = Json::array();
  for (const auto& [name, alternative] : type.alternatives()) {
    SchemaWriter writer;
    writer.properties_["type"] = {{"const", name}};
    writer.required_.emplace_back("type");
    alternative->describe(writer, NewValue(*alternative).ref().place);
    alternatives.push_back(writer.PlainObject());
  }
  return {{"oneOf", alternatives}};
}

}  // namespace railcast
