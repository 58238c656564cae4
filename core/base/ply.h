#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/number_type.h"

namespace railcast {

/// A property of an element of a PLY file: a number, or a list of numbers behind their count.
struct PlyProperty {
  std::string name;
  NumberType type{};
  std::optional<NumberType> length;  ///< The type of a list's count; absent = one number.
};

struct PlyElement {
  std::string name;
  std::uint32_t count{};
  std::vector<PlyProperty> properties;
};

enum class PlyEncoding : std::uint8_t { kAscii, kLittleEndian, kBigEndian };

/// Walks through a PLY file held in memory, of a cloud or a mesh: through its header, then through
/// one element after another. Throws InputErrors "shown: rule (got value)". Refers to the file's
/// bytes.
class PlyWalk {
 public:
  /// Walks through the header.
  /// @param shown Name of the file in error messages.
  /// @param on_comment Called with each line of it that is a comment or `obj_info`.
  PlyWalk(std::string shown,
          std::string_view bytes,
          const std::function<void(std::string_view line)>& on_comment);

  [[nodiscard]] PlyEncoding encoding() const { return encoding_; }
  [[nodiscard]] const std::vector<PlyElement>& elements() const { return elements_; }
  [[nodiscard]] std::string_view rest() const { return rest_; }  ///< What is still ahead.

  [[noreturn]] void Fail(const std::string& rule) const;
  [[noreturn]] void FailShort(const PlyElement& element) const;

  /// Reads an element: calls `visit(property, number, length)` for each number, where `property` is
  /// the index of its property and `length` that of its list (or 1), and `end()` behind the last
  /// one of each line or row.
  /// @pre It has properties, or a count of 0.
  template <typename Visit, typename End>
  void Read(const PlyElement& element, const Visit& visit, const End& end);

  /// Passes over an element: as many lines, or its bytes.
  /// @return Whether the file has all of it.
  [[nodiscard]] bool Skip(const PlyElement& element);

  /// Passes over bytes that are ahead.
  void SkipBytes(std::size_t num_bytes) { rest_.remove_prefix(num_bytes); }

 private:
  void ReadHeader(const std::function<void(std::string_view line)>& on_comment);
  [[nodiscard]] std::size_t Length(const PlyElement& element, NumberType type);
  double Next(const PlyElement& element, NumberType type);
  double NextWord(const PlyElement& element);
  void BeginLine();

  std::string shown_;
  std::string_view rest_;
  PlyEncoding encoding_{};
  std::vector<PlyElement> elements_;
};

template <typename Visit, typename End>
void PlyWalk::Read(const PlyElement& element, const Visit& visit, const End& end) {
  for (std::uint32_t i = 0; i < element.count; ++i) {
    BeginLine();
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      const std::size_t num = property.length ? Length(element, *property.length) : 1;
      for (std::size_t k = 0; k < num; ++k) visit(p, Next(element, property.type), num);
    }
    end();
  }
}

}  // namespace railcast
