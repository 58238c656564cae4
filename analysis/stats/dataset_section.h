#pragma once

#include <string>

#include "analysis/report/report.h"
#include "analysis/stats/dataset_overview.h"

namespace railcast {

/// The section of a data set: balance of its classes, objects by type, distance and occlusion,
/// weathers, parts, bases and sensors.
/// @param suffix Follows the keys of section, charts and tables; "" for the first data set of a
///   report, "_2" for the second.
[[nodiscard]] Section MakeDatasetSection(const DatasetOverview& overview,
                                         const std::string& suffix);

}  // namespace railcast
