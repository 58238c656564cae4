#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/lidar.h"

namespace railcast {

/// The channels of a sensor in the order of its packets, and their cycle: the pattern of
/// scenarios/sensors/NAME.json, a copy of which is part of the program.
/// @param name One that core/io/CMakeLists.txt lists.
[[nodiscard]] SpinningSpec SensorTable(std::string_view name);

/// A sensor that SensorTable() knows.
struct SensorTableName {
  std::string file;     ///< "vlp16".
  std::string product;  ///< "VLP-16".
};
[[nodiscard]] std::vector<SensorTableName> SensorTableNames();

/// The whole text of the file of a sensor that calls itself so: "VLP-16". Absent if the program
/// holds none.
[[nodiscard]] std::optional<std::string_view> SensorFileOf(std::string_view product);

}  // namespace railcast
