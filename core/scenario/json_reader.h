#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/archive.h"
#include "core/scenario/json_source.h"

namespace railcast {

/// The archive that reads: fills a struct from one JSON object.
class JsonReader final : public Archive {
 public:
  JsonReader(JsonSource& source, Node object, MemberList list);

  void OneOfTwo(std::string_view key, std::string_view other) override;
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
  void Ensure(std::initializer_list<std::string_view> keys,
              bool holds,
              std::string_view rule) override;
  [[nodiscard]] bool is_reading() const override { return true; }

  /// Reports missing required keys, keys that were not described, and violations of rules across
  /// fields.
  void Finish();

 private:
  void Visit(const Key& key, const ValueRef& value) override;
  void VisitLibrary(const Key& key, const ValueRef& list) override;
  void CheckUnique(std::string_view key,
                   std::string_view of,
                   const std::vector<UniqueValue>& members) override;
  [[nodiscard]] const Node* Find(std::string_view key) const;
  [[nodiscard]] bool IsKnown(std::string_view key) const;

  struct BrokenRule {
    std::vector<std::string> keys;
    std::string rule;
  };

  JsonSource& source_;
  Node object_;
  MemberList list_;
  std::vector<std::string> keys_;  // The keys described so far.
  std::vector<std::string> missing_;
  std::vector<BrokenRule> broken_rules_;
};

/// Reads a value. If there is a fault, it is added to the source and `value` keeps its default, so
/// that reading can continue.
void ReadValue(JsonSource& source, const Node& node, const ValueRef& value, const RuleRef& rule);
template <class T, class Rule = Anything>
void ReadAs(JsonSource& source, const Node& node, T& value, const Rule& rule = {}) {
  static_assert(CanKeep<T, Rule>(), "no value of this type keeps or breaks this rule");
  ReadValue(source, node, RefTo(value), rule);
}

/// Fills a struct from the members of its object.
void ReadMembers(JsonSource& source, const Node& object, MemberList list, const ValueRef& value);
template <class T>
void ReadMembers(JsonSource& source, const Node& object, MemberList list, T& value) {
  ReadMembers(source, object, std::move(list), RefTo(value));
}

// Functions that read a JSON value into a value of a plain type. If there is a fault, they add it
// to the source and leave `value` at its default, so that reading can continue.
void ReadBool(JsonSource& source, const Node& node, bool& value);
/// @param rule Limits or none.
void ReadNumber(JsonSource& source, const Node& node, double& value, const RuleRef& rule);
/// @param rule Limits, NumberChoices or none.
void ReadWhole(JsonSource& source, const Node& node, const ValueRef& value, const RuleRef& rule);
void ReadSigned(JsonSource& source, const Node& node, std::int64_t& value);
/// @param rule One of those for texts, or none.
void ReadText(JsonSource& source, const Node& node, std::string& value, const RuleRef& rule);
/// Reads the name of an enumeration's value.
void ReadName(JsonSource& source, const Node& node, const ValueRef& value);
void ReadObjectType(JsonSource& source, const Node& node, ObjectType& value);

/// Whether the node is a list of exactly, or of at least, `count` elements.
bool CheckListOf(JsonSource& source, const Node& node, std::size_t count);
bool CheckListOfAtLeast(JsonSource& source, const Node& node, const AtLeastElements& rule);

/// Whether the elements of a list that have the right type are within the limits.
bool CheckEachNumber(JsonSource& source, const Node& list, const EachNumber& rule);

}  // namespace railcast
