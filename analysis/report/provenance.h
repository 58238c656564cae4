#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/report/report.h"
#include "railcast/effects.h"
#include "railcast/io/recording.h"

namespace railcast {

// Facts on the origin of a report and its figures.

using Facts = std::vector<std::pair<std::string, std::string>>;

/// Date and minute in UTC: "2023-11-14 22:13 UTC". If the environment variable SOURCE_DATE_EPOCH is
/// set (seconds since 1970), it replaces the clock, so that a report can be reproduced byte by
/// byte.
/// @throws InputError "SOURCE_DATE_EPOCH: rule (got value)" if it is invalid.
[[nodiscard]] std::string ReportDate();

/// The program that makes the report, and the date.
/// @param version ProgramVersion().
/// @throws InputError as ReportDate() does.
[[nodiscard]] Facts MakerFacts(const std::string& version);

/// What the sources say of themselves, each text once, in the order of their first places: "a; b".
/// Of more than 20 texts the rest is counted. Empty if no source says anything.
/// @param text_of Returns an empty text if the source says nothing.
[[nodiscard]] std::string DifferentTexts(
    const std::vector<RecordingInfo>& sources,
    const std::function<std::string(const RecordingInfo&)>& text_of);

/// The remarks of the sources' readers, source by source.
[[nodiscard]] std::vector<Remark> RemarksOf(const std::vector<RecordingInfo>& sources);

/// Data hash, remarks, scenario, weather and maker of those sources that are railcast sequences.
/// Facts that several sources share are stated once.
[[nodiscard]] Facts OriginFacts(const std::vector<RecordingInfo>& sources);

/// "rain 12 mm/h, wetness 0.5", or "clear".
[[nodiscard]] std::string WeatherText(const WeatherSpec& weather);

/// Appends OriginFacts() and MakerFacts() to the report's facts.
void AddProvenance(const std::vector<RecordingInfo>& sources,
                   const std::string& version,
                   Report& report);

/// Returns the processor's name as Linux gives it, "Intel(R) Xeon(R) CPU @ 2.20GHz"; "unknown"
/// where it gives none, as on ARM.
[[nodiscard]] std::string ProcessorName();

}  // namespace railcast
