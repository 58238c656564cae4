#include "tests/core/scenario/schema_writer.h"

namespace railcast {

void AddRule(Json& /*schema*/, Anything) {}

void AddRule(Json& schema, const Limits& limits) {
  if (limits.above) schema["exclusiveMinimum"] = *limits.above;
  if (limits.at_least) schema["minimum"] = *limits.at_least;
  if (limits.at_most) schema["maximum"] = *limits.at_most;
}

void AddRule(Json& schema, const NumberChoices& choices) {
  schema["enum"] = choices.numbers;
}

void AddRule(Json& schema, const AllowedNames& choices) {
  schema["enum"] = choices.names;
}

void AddRule(Json& schema, NonEmptyString) {
  schema["minLength"] = 1;
  AddRule(schema, OneLine());
}

void AddRule(Json& schema, OneLine) {
  schema["pattern"] = "^[^\\u0000-\\u001f\\u007f]*$";
}

void AddRule(Json& schema, HostAndPort) {
  schema["pattern"] = "^.+:[0-9]+$";
}

void AddRule(Json& schema, ExistingFile) {
  schema["minLength"] = 1;
}

void AddRule(Json& schema, const AtLeastElements& rule) {
  if (rule.count > 0) schema["minItems"] = rule.count;
}

void AddRule(Json& /*schema*/, const NonEmptyListIf& /*rule*/) {}

void AddRule(Json& schema, const EachNumber& rule) {
  AddRule(schema, AtLeastElements{rule.at_least});
  Json& element = schema["items"];
  const bool is_object = element["type"] == "object";
  AddRule(is_object ? element["properties"][rule.key] : element["items"], rule.limits);
}

void SchemaWriter::Alternative(std::string_view key,
                               double& value,
                               const Multiple& multiple,
                               const char* doc,
                               const Limits& limits) {
  Add(key, doc, SchemaOf(value, limits));
  exclusive_ = {std::string(key), multiple.of_key};
}

void SchemaWriter::Switches(std::string_view key,
                            const std::map<std::string, bool>& /*switches*/,
                            const char* doc,
                            const std::vector<std::string>& names) {
  SchemaWriter writer;
  bool value = false;
  for (const std::string& name : names) writer.Add(name, doc, SchemaOf(value, Anything{}));
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
  properties.update(schema["properties"]);
  schema["properties"] = properties;
  if (!required_.empty()) {
    schema.erase("required");
    schema["anyOf"] = {{{"required", {"file"}}}, {{"required", required_}}};
  }
  return schema;
}

Json SchemaWriter::File(const std::string& title) const {
  SchemaWriter file = *this;
  file.properties_ = {{"$schema", {{"type", "string"}}}, {"version", {{"const", 1}}}};
  file.properties_.update(properties_);
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
  schema.update(file.ObjectWithBase());
  schema["required"] = {"version"};
  return schema;
}

Json SchemaWriter::FileNameSchema() {
  return {{"type", "string"}, {"minLength", 1}, {"description", "A file that holds it."}};
}

void SchemaWriter::Add(std::string_view key, const char* doc, Json schema) {
  schema["description"] = doc;
  properties_[std::string(key)] = std::move(schema);
}

}  // namespace railcast
