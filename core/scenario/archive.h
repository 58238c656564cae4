#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/scenario/json_rules.h"
#include "core/scenario/value_type.h"
#include "railcast/objects.h"

namespace railcast {

/// A rule of any kind (json_rules.h), which must outlive this.
class RuleRef {
 public:
  /// Implicit, so that a rule can be given as it is.
  template <class Rule>
  requires(!std::is_same_v<Rule, RuleRef>) RuleRef(const Rule& rule) : rule_(&rule) {}

  /// The rule, or null if it is of another kind.
  template <class Rule>
  [[nodiscard]] const Rule* As() const {
    const auto* const found = std::get_if<const Rule*>(&rule_);
    return found == nullptr ? nullptr : *found;
  }

 private:
  std::variant<const Anything*,
               const Limits*,
               const NumberChoices*,
               const AllowedNames*,
               const OneLine*,
               const NonEmptyString*,
               const HostAndPort*,
               const ExistingFile*,
               const AtLeastElements*,
               const EachNumber*,
               const NonEmptyListIf*>
      rule_;
};

/// Whether a value of the type can keep a rule of that kind. Rules of texts and numbers are also
/// for each of several.
template <class T, class Rule>
[[nodiscard]] consteval bool CanKeep() {
  if constexpr (std::is_same_v<Rule, Anything>) {
    return true;
  } else if constexpr (kIsOptional<T> || kIsArray<T>) {
    return CanKeep<typename T::value_type, Rule>();
  } else if constexpr (kIsList<T>) {
    return std::is_same_v<Rule, AtLeastElements> || std::is_same_v<Rule, EachNumber> ||
           std::is_same_v<Rule, NonEmptyListIf> ||
           (std::is_same_v<typename T::value_type, std::string> &&
            CanKeep<typename T::value_type, Rule>());
  } else if constexpr (std::is_same_v<T, std::string>) {
    return std::is_same_v<Rule, AllowedNames> || std::is_same_v<Rule, OneLine> ||
           std::is_same_v<Rule, NonEmptyString> || std::is_same_v<Rule, HostAndPort> ||
           std::is_same_v<Rule, ExistingFile>;
  } else {
    return (std::is_same_v<Rule, Limits> && std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) ||
           (std::is_same_v<Rule, NumberChoices> && std::is_same_v<T, int>);
  }
}

inline constexpr Anything kAnything;

/// What the value of a key means, for schemas and pages. An empty text does not compile.
class KeyDoc {
 public:
  /// Implicit, so that a key can be described by a literal.
  template <std::size_t kSize>
  constexpr KeyDoc(const char (&text)[kSize]) : text_(text) {
    static_assert(kSize > 1, "the description of a key must say what its value means");
  }

  [[nodiscard]] constexpr const char* text() const { return text_; }

 private:
  const char* text_;
};

/// A key of an object.
struct Key {
  std::string_view name;
  KeyDoc doc;
  RuleRef rule = kAnything;
  bool is_required{};
  bool is_nullable{};  ///< Whether it is null where an optional value is absent.
};

/// The value of a member that no two elements of a list may share.
using UniqueValue = std::variant<std::string, std::uint64_t>;

/// What visits the description of a struct (descriptions.h) and does something with each of its
/// members: reads, writes, checks or documents it. A description is compiled once for all of them,
/// since values are given as places and types (value_type.h).
class Archive {
 public:
  Archive() = default;
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;
  virtual ~Archive() = default;

  /// The key must be given.
  template <class T, class Rule = Anything>
  void Required(std::string_view key, T& value, KeyDoc doc, const Rule& rule = {}) {
    static_assert(CanKeep<T, Rule>(), "no value of this type keeps or breaks this rule");
    Visit({key, doc, rule, true}, RefTo(value));
  }
  /// If the key is absent, the struct's default is kept; a std::optional stays empty.
  template <class T, class Rule = Anything>
  void Optional(std::string_view key, T& value, KeyDoc doc, const Rule& rule = {}) {
    static_assert(CanKeep<T, Rule>(), "no value of this type keeps or breaks this rule");
    Visit({key, doc, rule, false}, RefTo(value));
  }
  /// The key is left out where the value is `absent`. Returns whether it is given.
  template <class T, class Rule = Anything>
  bool OptionalUnless(
      std::string_view key, T& value, const T& absent, KeyDoc doc, const Rule& rule = {}) {
    std::optional<T> given;
    if (value != absent) given = value;
    Optional(key, given, doc, rule);
    if (given) value = *given;
    return given.has_value();
  }
  /// The key is null where there is no value.
  template <class T, class Rule = Anything>
  void Nullable(std::string_view key, std::optional<T>& value, KeyDoc doc, const Rule& rule = {}) {
    static_assert(CanKeep<T, Rule>(), "no value of this type keeps or breaks this rule");
    Visit({key, doc, rule, true, true}, RefTo(value));
  }
  /// A list, or a file that holds it under the same key.
  template <class T>
  void RequiredLibrary(std::string_view key, std::vector<T>& values, KeyDoc doc) {
    VisitLibrary({key, doc, NonEmptyList(), true}, RefTo(values));
  }
  /// No two elements of the list may agree in a member.
  template <class T, class V>
  void Unique(std::string_view key,
              const std::vector<T>& values,
              std::string_view of,
              V T::*which) {
    std::vector<UniqueValue> members;
    for (const T& value : values) members.emplace_back(value.*which);
    CheckUnique(key, of, members);
  }

  /// At most one of the two may be given; each of them replaces the other one of a base file. Must
  /// come before the descriptions of both keys.
  virtual void OneOfTwo(std::string_view /*key*/, std::string_view /*other*/) {}
  /// Another way to give the value of another key.
  virtual void Alternative(std::string_view /*key*/,
                           double& /*value*/,
                           const Multiple& /*multiple*/,
                           KeyDoc /*doc*/,
                           const Limits& /*limits*/) {}
  /// A file of another format, which gives values to keys.
  virtual void Preset(std::string_view key,
                      std::optional<std::string>& file,
                      KeyDoc doc,
                      const FilePreset& preset) = 0;
  /// A list or file like a library, which may be absent, of types that the objects described after
  /// it may have.
  virtual void Types(std::string_view key, std::vector<ModelSpec>& models, KeyDoc doc) = 0;
  /// An object of flags.
  virtual void Switches(std::string_view key,
                        std::map<std::string, bool>& switches,
                        KeyDoc doc,
                        const std::vector<std::string>& names) = 0;
  /// A rule across the fields of `keys`. The message is about the value of the first key, or about
  /// the whole object if that is "".
  virtual void Ensure(std::initializer_list<std::string_view> /*keys*/,
                      bool /*holds*/,
                      std::string_view /*rule*/) {}

  /// Whether the values are still to come.
  [[nodiscard]] virtual bool is_reading() const { return false; }

 private:
  virtual void Visit(const Key& key, const ValueRef& value) = 0;
  virtual void VisitLibrary(const Key& key, const ValueRef& list) { Visit(key, list); }
  virtual void CheckUnique(std::string_view /*key*/,
                           std::string_view /*of*/,
                           const std::vector<UniqueValue>& /*members*/) {}
};

}  // namespace railcast
