#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/io/cloud/cloud.h"
#include "railcast/frame.h"

namespace railcast {

/// Whether a file's name ends in .las, in any case.
[[nodiscard]] bool IsLasFile(const std::filesystem::path& file);

/// Reads a file of LAS 1.0 to 1.4, with points of the formats 0 to 10 (ASPRS, LAS 1.4 R15): x, y, z
/// as float64, m; intensity, return_index (from 0), return_count, label (the class), gps_time (s),
/// scan_angle (degrees), user_data, point_source_id and flags (bits as in format 6). Points that
/// are marked as withheld are left out. That, other fields and what stands behind the points are
/// remarks.
/// @throws InputError "file: place: rule (got value)" if it is damaged or compressed (LAZ), or if
///   its coordinates are stated to be in degrees or feet.
[[nodiscard]] Cloud ReadLas(const std::filesystem::path& file);

/// The overload for a file held in `bytes`, which errors call `file`.
[[nodiscard]] Cloud ParseLas(const std::string& file, std::string_view bytes);

/// The classes that ASPRS defines (LAS 1.4 R15, tables 9 and 17).
[[nodiscard]] const LabelTable& AsprsLabels();

/// What scenarios call what such a class is ("tree" for "high_vegetation"); empty if they do not
/// know it. Other names stay as they are.
[[nodiscard]] std::string_view ScenarioLabelOf(std::string_view asprs_name);

}  // namespace railcast
