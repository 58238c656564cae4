#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "generator/extras/import/map/rail_map.h"

namespace railcast {

/// The beginning of an XML element, while it is visited. Names have no prefix of a namespace.
struct XmlElement {
  std::string_view name;
  const char* const* attributes{};  ///< Names and values in turn, then null.
  std::uint64_t line{};

  /// The value of an attribute; null if there is none.
  [[nodiscard]] const char* ValueOf(std::string_view attribute) const;
};

/// The faults of a file in XML, with their lines.
class XmlFaults {
 public:
  void Add(std::uint64_t line, const std::string& what, std::string rule, std::string got) {
    list_.Add({"line " + std::to_string(line) + ", " + what, std::move(rule), std::move(got)});
  }
  [[nodiscard]] ErrorList& list() { return list_; }

 private:
  ErrorList list_;
};

/// Takes the elements of a map one by one.
class XmlMapReader {
 public:
  virtual ~XmlMapReader() = default;
  virtual void Begin(const XmlElement& element) = 0;
  /// @param text What stands in the element before its end and behind others in it.
  virtual void End(std::string_view name, std::string_view text, std::uint64_t line) = 0;
  /// Called once, behind the last element.
  [[nodiscard]] virtual RailMap Make() = 0;
};

// The readers that ReadXmlMap() chooses by the root element.
[[nodiscard]] std::unique_ptr<XmlMapReader> MakeOsmXmlReader(XmlFaults& faults);
[[nodiscard]] std::unique_ptr<XmlMapReader> MakeGpxReader(XmlFaults& faults);
[[nodiscard]] std::unique_ptr<XmlMapReader> MakeKmlReader(XmlFaults& faults);
[[nodiscard]] std::unique_ptr<XmlMapReader> MakeRailMlReader(XmlFaults& faults);

/// Text without blanks at its ends.
[[nodiscard]] std::string_view XmlTrimmed(std::string_view text);
/// A number with what XML schemas allow: a sign, and blanks about it.
[[nodiscard]] std::optional<double> XmlNumber(std::string_view text);
/// The place in the attributes `lon` and `lat`; absent with a fault for each that is no degrees.
[[nodiscard]] std::optional<Eigen::Vector2d> XmlPlace_deg(const XmlElement& element,
                                                          XmlFaults& faults);

}  // namespace railcast
