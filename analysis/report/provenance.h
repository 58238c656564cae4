#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analysis/report/report.h"
#include "core/detect/detect_spec.h"
#include "core/io/recording/recording.h"

namespace railcast {

// What a report says of where it and its figures come from.

using Facts = std::vector<std::pair<std::string, std::string>>;

/// The minute in UTC: "2023-11-14 22:13 UTC". The environment's SOURCE_DATE_EPOCH, seconds since
/// 1970, stands for the clock where it is set, so that a report can be made again to the byte.
/// @throws InputError "SOURCE_DATE_EPOCH: rule (got value)" if it is none.
[[nodiscard]] std::string ReportDate();

/// The program that makes the report, and the date. @param version ProgramVersion().
/// @throws InputError as ReportDate() does.
[[nodiscard]] Facts MakerFacts(const std::string& version);

/// Hash of the data and of the scenario, weather and maker of our sequences among the sources. What
/// several have in common is said once.
[[nodiscard]] Facts OriginFacts(const std::vector<RecordingInfo>& sources);

/// "rain 12 mm/h, wetness 0.5", or "clear".
[[nodiscard]] std::string WeatherText(const WeatherSpec& weather);

/// Both, after the facts that are there.
void AddProvenance(const std::vector<RecordingInfo>& sources,
                   const std::string& version,
                   Report& report);

}  // namespace railcast
