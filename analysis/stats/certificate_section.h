#pragma once

#include <optional>
#include <vector>

#include "analysis/report/report.h"
#include "core/certify/certified_figures.h"
#include "railcast/io/recording.h"

namespace railcast {

/// The numerical error of recordings that railcast made, or put something into, and certified, over
/// all of their frames: that of the manifest, or of several recordings the figures of all together,
/// without objects and tolerances, which are of single runs. Recordings without a certificate, and
/// unfinished ones, have no part in it; absent if none is left.
/// @throws InputError with one line if a file cannot be read or is none of railcast's.
[[nodiscard]] std::optional<RunCertificate> CertificateOf(
    const std::vector<RecordingInfo>& sources);

/// The section about it: missed and false echoes, errors of range and power, by class, range and
/// object, and what the rungs beside would have given.
[[nodiscard]] Section MakeCertificateSection(const RunCertificate& certificate);

/// Its key figures.
void AddCertificateHeadlines(const RunCertificate& certificate, Report& report);

}  // namespace railcast
