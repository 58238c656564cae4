#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/archive.h"
#include "core/scenario/json_text.h"

namespace railcast {

/// The archive that documents (core/scenario/descriptions.h): makes the JSON Schema (draft 2020-12)
/// of a struct's object. The schema does not contain rules across fields.
class SchemaWriter final : public Archive {
 public:
  void Preset(std::string_view key,
              std::optional<std::string>& file,
              KeyDoc doc,
              const FilePreset& preset) override;
  void Alternative(std::string_view key,
                   double& value,
                   const Multiple& multiple,
                   KeyDoc doc,
                   const Limits& limits) override;
  void Types(std::string_view key, std::vector<ModelSpec>& models, KeyDoc doc) override;
  void Switches(std::string_view key,
                std::map<std::string, bool>& switches,
                KeyDoc doc,
                const std::vector<std::string>& names) override;

  /// The schema of an object written in place.
  [[nodiscard]] Json PlainObject() const;
  /// The schema of an object that may have the keys that it lacks from a base file, or lie in one
  /// that has. It names the keys that must come from somewhere, but does not insist on them.
  [[nodiscard]] Json ObjectWithBase() const;
  /// The schema of a file with that object. @param title Name of the schema in editors.
  [[nodiscard]] Json File(const std::string& title) const;

 private:
  void Visit(const Key& key, const ValueRef& value) override;
  void VisitLibrary(const Key& key, const ValueRef& list) override;
  void Add(std::string_view key, KeyDoc doc, Json schema);
  void AddFileOrList(const Key& key, const ValueRef& list);
  [[nodiscard]] static Json SchemaOf(const ValueRef& value, const RuleRef& rule);
  [[nodiscard]] static Json SchemaOfElement(const ValueType& list);
  [[nodiscard]] static Json SchemaOfVariant(const ValueType& type);

  Json properties_ = Json::object();
  std::vector<std::string> required_;
  std::string given_by_file_;           // A required key that may be left out for a file.
  std::vector<std::string> exclusive_;  // Two keys that may not both be given.
};

}  // namespace railcast
