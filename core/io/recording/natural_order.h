#pragma once

#include <filesystem>
#include <vector>

namespace railcast {

/// Sorts paths of one folder by the natural order of their names: numbers by value, all other
/// characters one by one, so that 9.pcd comes before 10.pcd.
void SortNaturally(std::vector<std::filesystem::path>& paths);

}  // namespace railcast
