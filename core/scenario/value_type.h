#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "railcast/enum_names.h"
#include "railcast/objects.h"
#include "railcast/transform.h"

namespace railcast {

class Archive;
class JsonSource;
struct Node;

/// The "type" that distinguishes a struct from other alternatives of a variant. Specialised beside
/// the declaration of the struct's description.
template <class T>
inline constexpr const char* kTypeName = nullptr;
/// Whether elements of this type in a list may be given as a file or build on one. Not possible for
/// types that have a key "file" of their own.
template <class T>
inline constexpr bool kElementMayBeFile = false;
/// Whether a struct is always written in place, since it has a key "file" of its own.
template <class T>
inline constexpr bool kIsWrittenInPlace = false;

template <class T>
inline constexpr bool kIsArray = false;
template <class T, std::size_t kCount>
inline constexpr bool kIsArray<std::array<T, kCount>> = true;
template <class T>
inline constexpr bool kIsList = false;
template <class T>
inline constexpr bool kIsList<std::vector<T>> = true;
template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;
template <class T>
inline constexpr bool kIsMap = false;
template <class T>
inline constexpr bool kIsMap<std::map<std::string, T>> = true;
/// Values by name, in their order.
template <class T>
using NamedValues = std::vector<std::pair<std::string, T>>;
template <class T>
inline constexpr bool kIsMap<NamedValues<T>> = true;
template <class T>
inline constexpr bool kIsVariant = false;
template <class... Ts>
inline constexpr bool kIsVariant<std::variant<Ts...>> = true;

struct ValueType;

/// A value of a spec: its place, and what can be done there.
struct ValueRef {
  void* place{};
  const ValueType* type{};
};

/// What an archive needs to know of a C++ type, made once for each.
struct ValueType {
  enum class Kind {
    kBool,
    kNumber,  ///< double
    kWhole,   ///< Integer that is not negative.
    kSigned,  ///< std::int64_t
    kText,    ///< std::string
    kName,    ///< Enumeration with names.
    kObjectType,
    kOptional,  ///< A container of none or one.
    kArray,     ///< std::array, or a vector or quaternion (x, y, z, w) of numbers.
    kList,
    kMap,      ///< std::map or NamedValues, of which each name is a key.
    kJson,     ///< Any value, kept as it is.
    kStruct,   ///< With a description.
    kVariant,  ///< One of several structs, which "type" distinguishes.
    kOwn,      ///< Has a ReadValue(source, node, value) of its own.
  };
  Kind kind{};

  std::uint64_t most{};  ///< For kWhole.
  std::uint64_t (*whole)(const void*){};
  void (*set_whole)(void*, std::uint64_t){};

  std::vector<std::string> (*names)(){};  ///< For kName.
  std::string (*name)(const void*){};
  void (*set_name)(void*, const std::string&){};

  const ValueType* (*of)(){};  ///< The type of the elements of kOptional, kArray, kList, kMap.
  std::size_t (*size)(const void*){};   ///< Their number; of kVariant the alternative's index.
  void (*renew)(void*, std::size_t){};  ///< Makes that many new ones, or that alternative.
  void* (*at)(void*, std::size_t){};    ///< An element, or the alternative.
  std::vector<std::string> (*keys)(const void*){};  ///< For kMap.
  void* (*member)(void*, const std::string&){};     ///< For kMap; a new one if there is none.

  void (*describe)(Archive&, void*){};  ///< For kStruct.
  void* (*make)(){};                    ///< A new value; of all kinds. NewValue owns it.
  void (*end)(void*){};
  bool is_written_in_place{};
  bool element_may_be_file{};

  struct Alternative {
    const char* name{};
    const ValueType* type{};
  };
  std::vector<Alternative> (*alternatives)(){};  ///< For kVariant.

  void (*read)(JsonSource&, const Node&, void*){};  ///< For kOwn.
};

/// A value of a type, with its defaults.
class NewValue {
 public:
  explicit NewValue(const ValueType& type) : ref_{type.make(), &type} {}
  ~NewValue() { ref_.type->end(ref_.place); }
  NewValue(const NewValue&) = delete;
  NewValue& operator=(const NewValue&) = delete;

  [[nodiscard]] const ValueRef& ref() const { return ref_; }

 private:
  ValueRef ref_;
};

template <class T>
[[nodiscard]] constexpr const ValueType* TypeOf();

template <class T>
[[nodiscard]] ValueRef RefTo(T& value) {
  return {&value, TypeOf<T>()};
}

template <class T>
concept ReadsItself = requires(JsonSource& source, const Node& node, T& value) {
  ReadValue(source, node, value);
};

template <class T>
constexpr void AddContainer(ValueType& type) {
  using Element = typename T::value_type;
  type.of = []() -> const ValueType* { return TypeOf<Element>(); };
  if constexpr (kIsOptional<T>) {
    type.kind = ValueType::Kind::kOptional;
    type.size = [](const void* place) -> std::size_t {
      return static_cast<const T*>(place)->has_value() ? 1 : 0;
    };
    type.renew = [](void* place, std::size_t size) {
      auto& value = *static_cast<T*>(place);
      value.reset();
      if (size > 0) value.emplace();
    };
    type.at = [](void* place, std::size_t) -> void* { return &**static_cast<T*>(place); };
  } else {
    type.kind = kIsArray<T> ? ValueType::Kind::kArray : ValueType::Kind::kList;
    type.element_may_be_file = kElementMayBeFile<Element>;
    type.size = [](const void* place) { return static_cast<const T*>(place)->size(); };
    type.at = [](void* place, std::size_t i) -> void* { return &(*static_cast<T*>(place))[i]; };
    if constexpr (kIsList<T>) {
      type.renew = [](void* place, std::size_t size) {
        auto& list = *static_cast<T*>(place);
        list.clear();
        list.resize(size);
      };
    }
  }
}

template <class T>
constexpr void AddMembers(ValueType& type) {
  using Value = typename T::value_type::second_type;
  type.kind = ValueType::Kind::kMap;
  type.of = []() -> const ValueType* { return TypeOf<Value>(); };
  type.keys = [](const void* place) {
    std::vector<std::string> keys;
    for (const auto& member : *static_cast<const T*>(place)) keys.push_back(member.first);
    return keys;
  };
  type.member = [](void* place, const std::string& key) -> void* {
    T& map = *static_cast<T*>(place);
    if constexpr (std::is_same_v<T, NamedValues<Value>>) {
      for (auto& member : map) {
        if (member.first == key) return &member.second;
      }
      return &map.emplace_back(key, Value()).second;
    } else {
      return &map[key];
    }
  };
}

// Numbers that follow one another in memory, a quaternion's as x, y, z, w.
template <class T, std::size_t kSize>
constexpr void AddNumbers(ValueType& type) {
  static_assert(sizeof(T) == kSize * sizeof(double));
  type.kind = ValueType::Kind::kArray;
  type.of = []() -> const ValueType* { return TypeOf<double>(); };
  type.size = [](const void*) { return kSize; };
  type.at = [](void* place, std::size_t i) -> void* {
    if constexpr (std::is_same_v<T, Eigen::Quaterniond>) {
      return static_cast<T*>(place)->coeffs().data() + i;
    } else {
      return static_cast<T*>(place)->data() + i;
    }
  };
}

template <class... Ts>
constexpr void AddAlternatives(ValueType& type, std::in_place_type_t<std::variant<Ts...>>) {
  using T = std::variant<Ts...>;
  type.kind = ValueType::Kind::kVariant;
  type.alternatives = [] {
    return std::vector<ValueType::Alternative>{{kTypeName<Ts>, TypeOf<Ts>()}...};
  };
  type.size = [](const void* place) { return static_cast<const T*>(place)->index(); };
  type.renew = [](void* place, std::size_t index) {
    static constexpr std::array<void (*)(T&), sizeof...(Ts)> kMakers = {
        [](T& value) { value.template emplace<Ts>(); }...};
    kMakers[index](*static_cast<T*>(place));
  };
  type.at = [](void* place, std::size_t) {
    return std::visit([](auto& alternative) -> void* { return &alternative; },
                      *static_cast<T*>(place));
  };
}

template <class T>
[[nodiscard]] constexpr ValueType MakeType() {
  using Kind = ValueType::Kind;
  ValueType type;
  type.make = []() -> void* { return new T(); };
  type.end = [](void* place) { delete static_cast<T*>(place); };
  if constexpr (ReadsItself<T>) {
    type.kind = Kind::kOwn;
    type.read = [](JsonSource& source, const Node& node, void* place) {
      ReadValue(source, node, *static_cast<T*>(place));
    };
  } else if constexpr (std::is_same_v<T, bool>) {
    type.kind = Kind::kBool;
  } else if constexpr (std::is_same_v<T, double>) {
    type.kind = Kind::kNumber;
  } else if constexpr (std::is_same_v<T, std::int64_t>) {
    type.kind = Kind::kSigned;
  } else if constexpr (std::integral<T>) {
    type.kind = Kind::kWhole;
    type.most = std::numeric_limits<T>::max();
    type.whole = [](const void* place) {
      return static_cast<std::uint64_t>(*static_cast<const T*>(place));
    };
    type.set_whole = [](void* place, std::uint64_t value) {
      *static_cast<T*>(place) = static_cast<T>(value);
    };
  } else if constexpr (std::is_same_v<T, std::string>) {
    type.kind = Kind::kText;
  } else if constexpr (NamedEnum<T>) {
    type.kind = Kind::kName;
    type.names = &NamesOf<T>;
    type.name = [](const void* place) {
      return std::string(NameOf(*static_cast<const T*>(place)));
    };
    type.set_name = [](void* place, const std::string& name) {
      auto& value = *static_cast<T*>(place);
      value = ValueNamed<T>(name).value_or(value);
    };
  } else if constexpr (std::is_same_v<T, ObjectType>) {
    type.kind = Kind::kObjectType;
  } else if constexpr (kIsMap<T>) {
    AddMembers<T>(type);
  } else if constexpr (kIsOptional<T> || kIsArray<T> || kIsList<T>) {
    AddContainer<T>(type);
  } else if constexpr (std::is_same_v<T, Vector3>) {
    AddNumbers<T, 3>(type);
  } else if constexpr (std::is_same_v<T, Eigen::Quaterniond>) {
    AddNumbers<T, 4>(type);
  } else if constexpr (std::is_same_v<T, nlohmann::ordered_json>) {
    type.kind = Kind::kJson;
  } else if constexpr (kIsVariant<T>) {
    AddAlternatives(type, std::in_place_type<T>);
  } else {
    type.kind = Kind::kStruct;
    type.describe = [](Archive& archive, void* place) {
      Describe(archive, *static_cast<T*>(place));
    };
    type.is_written_in_place = kIsWrittenInPlace<T>;
  }
  return type;
}

template <class T>
inline constexpr ValueType kValueType = MakeType<T>();

template <class T>
constexpr const ValueType* TypeOf() {
  return &kValueType<T>;
}

}  // namespace railcast
