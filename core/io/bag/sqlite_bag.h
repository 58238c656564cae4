#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/io/bag/bag.h"

namespace railcast::bag {

/// Whether the file begins as an SQLite database.
[[nodiscard]] bool IsSqlite(const std::filesystem::path& file);

/// Opens a database of rosbag2, of any version of its tables. If its recorder was interrupted, so
/// that a journal or a write-ahead log stands beside it, both are copied to the temporary folder
/// and read there.
/// @param name Names it in messages.
/// @throws InputError as OpenBag() does.
[[nodiscard]] std::unique_ptr<BagReader> OpenSqliteBag(const std::filesystem::path& file,
                                                       const std::string& name);

/// Makes a copy of such a database, of which messages are replaced by their ids.
/// @param copy Its file; unfinished until Finish().
[[nodiscard]] std::unique_ptr<BagCopy> CopySqliteBag(const std::filesystem::path& file,
                                                     const std::filesystem::path& copy);

/// The files beside a database in which an interrupted recorder left changes.
[[nodiscard]] std::vector<std::filesystem::path> ChangesBeside(const std::filesystem::path& file);

}  // namespace railcast::bag
