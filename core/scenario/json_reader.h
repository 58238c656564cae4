#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/input_file.h"
#include "core/scenario/json_values.h"

namespace railcast {

/// The archive that reads (see describe_scenario.h): fills a struct from one JSON object.
class JsonReader {
 public:
  JsonReader(JsonSource& source, Node object, MemberList list);

  template <class T, class Rule = Anything>
  void Required(std::string_view key, T& value, const char* doc, const Rule& rule = {});
  template <class T, class Rule = Anything>
  void Optional(std::string_view key, T& value, const char* doc, const Rule& rule = {});

  void OneOfTwo(std::string_view key, std::string_view other);
  template <class T>
  void Preset(std::string_view key,
              std::optional<std::string>& file,
              const char* doc,
              const FilePreset<T>& preset);
  void Alternative(std::string_view key,
                   double& value,
                   const Multiple& multiple,
                   const char* doc,
                   const Limits& limits);
  template <class T>
  void RequiredLibrary(std::string_view key, std::vector<T>& values, const char* doc);
  template <class T>
  void Types(std::string_view key, std::vector<T>& models, const char* doc);
  void Switches(std::string_view key,
                std::map<std::string, bool>& switches,
                const char* doc,
                const std::vector<std::string>& names);

  void Ensure(const std::vector<std::string>& keys, bool holds, const std::string& rule);
  template <class T, class V>
  void Unique(std::string_view key, const std::vector<T>& values, std::string_view of, V T::*which);

  /// Reports missing required keys, keys that were not described, and violations of rules across
  /// fields.
  void Finish();

 private:
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

/// Fills a struct from the members of its object.
template <class T>
void ReadMembers(JsonSource& source, const Node& object, MemberList list, T& value) {
  JsonReader reader(source, object, std::move(list));
  Describe(reader, value);
  reader.Finish();
}

template <class T, std::size_t kCount, class Rule>
void ReadValue(JsonSource& source,
               const Node& node,
               std::array<T, kCount>& values,
               const Rule& rule) {
  if (!CheckListOf(source, node, kCount)) return;
  for (std::size_t i = 0; i < kCount; ++i) ReadValue(source, node.Child(i), values[i], rule);
}

template <class T, class Rule>
void ReadValue(JsonSource& source, const Node& node, std::optional<T>& value, const Rule& rule) {
  T given{};
  ReadValue(source, node, given, rule);
  value = std::move(given);
}

template <class Rule>
void ReadValue(JsonSource& source,
               const Node& node,
               std::vector<std::string>& values,
               const Rule& rule) {
  if (!CheckListOfAtLeast(source, node, {})) return;
  values.assign(node.json->size(), {});
  for (std::size_t i = 0; i < values.size(); ++i) ReadValue(source, node.Child(i), values[i], rule);
}

template <class T>
void ReadValue(JsonSource& source, const Node& node, std::vector<T>& values, Anything) {
  ReadValue(source, node, values, AtLeastElements{0});
}

template <class T>
void ReadValue(JsonSource& source,
               const Node& node,
               std::vector<T>& values,
               const AtLeastElements& rule) {
  if (!CheckListOfAtLeast(source, node, rule)) return;
  values.assign(node.json->size(), {});
  for (std::size_t i = 0; i < values.size(); ++i) ReadElement(source, node.Child(i), values[i]);
}

template <class T>
void ReadValue(JsonSource& source,
               const Node& node,
               std::vector<T>& values,
               const EachNumber& rule) {
  ReadValue(source, node, values, AtLeastElements{rule.at_least});
  if (node.json->is_array() && !CheckEachNumber(source, node, rule)) values.clear();
}

template <class T>
void ReadValue(JsonSource& source,
               const Node& node,
               std::vector<T>& values,
               const NonEmptyListIf& rule) {
  ReadValue(source, node, values, AtLeastElements{rule.applies ? 1U : 0U, rule.instead});
}

/// Reads an element of a list. Elements are written in place; only few types may be given as a
/// file.
template <class T>
void ReadElement(JsonSource& source, const Node& node, T& value) {
  if constexpr (kIsArray<T> || kIsVariant<T> || kElementMayBeFile<T>) {
    ReadValue(source, node, value, Anything{});
  } else if (auto list = source.PlainMembers(node)) {
    ReadMembers(source, node, std::move(*list), value);
  }
}

/// Reads one of several structs, which "type" distinguishes. It is written in place, because a type
/// may have a key "file" of its own.
template <class... Ts>
void ReadValue(JsonSource& source, const Node& node, std::variant<Ts...>& value, Anything) {
  const auto list = source.PlainMembers(node);
  if (!list) return;
  if (!node.json->contains("type")) return source.Missing(node, "type");
  std::string type;
  const std::vector<std::string> names{kTypeName<Ts>...};
  ReadValue(source, node.Child("type"), type, OneOf(names));
  const auto read_if = [&]<class T>(T alternative) {
    if (type != kTypeName<T>) return;
    JsonReader reader(source, node, *list);
    reader.Required("type", type, "", Anything{});
    Describe(reader, alternative);
    reader.Finish();
    value = std::move(alternative);
  };
  (read_if(Ts{}), ...);
}

/// Reads a struct with a description. Unless it is written in place, its object may be given as a
/// file, or name a base file with the keys that it lacks.
template <class T>
requires(std::is_aggregate_v<T> &&
         !kIsArray<T>) void ReadValue(JsonSource& source, const Node& node, T& value, Anything) {
  auto list = kIsWrittenInPlace<T> ? source.PlainMembers(node) : source.Members(node);
  if (list) ReadMembers(source, node, std::move(*list), value);
}

template <class T, class Rule>
void JsonReader::Required(std::string_view key, T& value, const char* doc, const Rule& rule) {
  if (Find(key) == nullptr && list_.is_complete) missing_.emplace_back(key);
  Optional(key, value, doc, rule);
}

template <class T, class Rule>
void JsonReader::Optional(std::string_view key, T& value, const char* /*doc*/, const Rule& rule) {
  keys_.emplace_back(key);
  if (const Node* node = Find(key)) ReadValue(source_, *node, value, rule);
}

template <class T>
void JsonReader::Preset(std::string_view key,
                        std::optional<std::string>& file,
                        const char* doc,
                        const FilePreset<T>& preset) {
  std::string name;
  Optional(key, name, doc, ExistingFile{});
  const Node* const node = Find(key);
  if (node == nullptr) return;
  file = name;
  ErrorList faults;
  if (!name.empty()) {
    static_cast<void>(Attempt("", faults, [&] {
      const std::string text = ReadFileWhole(name);
      AtPlace(name + ": ", [&] { preset.use(text, preset.value); });
      return true;
    }));
  }
  for (const Fault& fault : faults.faults()) {
    source_.errors().Add(source_.sources().Locate(fault, node->resolved_pointer));
  }
  if (!name.empty() && faults.empty()) return;
  source_.unknown().Add(object_.resolved_pointer + PointerStep(preset.gives));
}

template <class T>
void JsonReader::RequiredLibrary(std::string_view key, std::vector<T>& values, const char* doc) {
  const Node* node = Find(key);
  if (node == nullptr || !node->json->is_string())
    return Required(key, values, doc, NonEmptyList());
  keys_.emplace_back(key);
  // In the file the list has the same key as in this object.
  const auto root = source_.FileRoot(*node, object_.resolved_pointer);
  if (!root || !source_.CheckRoot(*root)) return;
  JsonReader reader(source_, *root, source_.PlainMembers(*root).value());
  reader.Required(key, values, doc, NonEmptyList());
  reader.Finish();
  source_.sources().Add(node->resolved_pointer, root->file->shown, PointerStep(key));
}

template <class T>
void JsonReader::Types(std::string_view key, std::vector<T>& models, const char* doc) {
  const Node* node = Find(key);
  if (node == nullptr) {
    keys_.emplace_back(key);
    return;
  }
  const std::string list = node->resolved_pointer;
  RequiredLibrary(key, models, doc);
  Unique(key, models, "name", &T::name);
  for (std::size_t i = 0; i < models.size(); ++i) {
    const std::string place = list + "/" + std::to_string(i);
    if (!source_.unknown().IsKnown(place)) continue;  // Nor are objects that are one.
    if (!source_.types().Find(models[i].name)) {
      source_.types().Add(models[i], i);
      continue;
    }
    source_.errors().Add({source_.sources().Place(place + "/name"),
                          "must not be the name of a type that railcast has",
                          ValueText(models[i].name)});
    source_.unknown().Add(place + "/name");
  }
}

template <class T, class V>
void JsonReader::Unique(std::string_view key,
                        const std::vector<T>& values,
                        std::string_view of,
                        V T::*which) {
  const std::string list = object_.resolved_pointer + PointerStep(key) + "/";
  const auto place = [&](std::size_t i) { return list + std::to_string(i) + PointerStep(of); };
  std::set<V> seen;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!source_.unknown().IsKnown(place(i))) continue;
    const V& value = values[i].*which;
    if (seen.insert(value).second) continue;
    source_.errors().Add({source_.sources().Place(place(i)), "must be unique", ValueText(value)});
    source_.unknown().Add(place(i));
  }
}

}  // namespace railcast
