#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/scenario/json_text.h"
#include "railcast/transform.h"

namespace railcast {

// Values of files of OpenLABEL 1.0 (ASAM, 2021), of which other programs wrote more than is read.

/// A place in such a file, for messages.
struct OpenLabelPlace {
  std::string file;
  std::string pointer;

  [[nodiscard]] OpenLabelPlace operator/(const std::string& key) const {
    return {file, pointer + "/" + ShownText(key)};
  }
  /// @throws InputError "FILE: /pointer: rule".
  [[noreturn]] void Fail(const std::string& rule) const;
};

/// Parses a file. @param shown Its name in messages.
/// @throws InputError if it is no JSON.
[[nodiscard]] Json ParseOpenLabel(const std::string& text, const std::string& shown);

// Each throws InputError as OpenLabelPlace::Fail() does.

[[nodiscard]] const Json& OpenLabelMember(const Json& json,
                                          const std::string& key,
                                          const OpenLabelPlace& place);

[[nodiscard]] std::string OpenLabelText(const Json& json,
                                        const std::string& key,
                                        const OpenLabelPlace& place);

/// @return `count` finite numbers.
[[nodiscard]] std::vector<double> OpenLabelNumbers(const Json& json,
                                                   std::size_t count,
                                                   const OpenLabelPlace& place);

/// A pose or a `transform_data`: a matrix, or a quaternion and a translation.
[[nodiscard]] Transform OpenLabelTransform(const Json& json, const OpenLabelPlace& place);

/// The pose that seven numbers or more say: position, then quaternion (x, y, z, w).
[[nodiscard]] Transform OpenLabelPose(const std::vector<double>& numbers,
                                      const OpenLabelPlace& place);

}  // namespace railcast
