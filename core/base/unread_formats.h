#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace railcast {

// Formats of other people's data that are known, but not read.

/// What a file is by its name or its first bytes, and how to convert it: "is a bag of ROS 1, which
/// is not read: ...". Empty if the file is of no such format, or cannot be opened.
/// @param is_named Whether the user named the file, and not the folder that it is in: then a .txt
///   or .csv file is a cloud, unless it has as many numbers a line as poses have.
[[nodiscard]] std::string AdviceOnFile(const std::filesystem::path& file, bool is_named = true);

/// What a type of messages is, and how to convert it: "is compressed: ...".
/// @param encoding The messages' encoding: "cdr", "ros1", "protobuf", ...
[[nodiscard]] std::string_view AdviceOnType(std::string_view type, std::string_view encoding);

}  // namespace railcast
