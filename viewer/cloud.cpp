#include "viewer/cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "core/base/error.h"
#include "viewer/point_file.h"

namespace railcast {
namespace {

constexpr std::array<std::string_view, 4> kScalars = {"label", "outcome", "intensity", "range_m"};

const pcl::PCLPointField* FindField(const pcl::PCLPointCloud2& points, std::string_view name) {
  for (const pcl::PCLPointField& field : points.fields) {
    if (field.name == name || field.name == "scalar_" + std::string(name)) return &field;
  }
  return nullptr;
}

template <typename T>
double Load(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double LoadNumber(const std::uint8_t* bytes, std::uint8_t type) {
  switch (type) {
    case pcl::PCLPointField::INT8:
      return Load<std::int8_t>(bytes);
    case pcl::PCLPointField::UINT8:
      return Load<std::uint8_t>(bytes);
    case pcl::PCLPointField::INT16:
      return Load<std::int16_t>(bytes);
    case pcl::PCLPointField::UINT16:
      return Load<std::uint16_t>(bytes);
    case pcl::PCLPointField::INT32:
      return Load<std::int32_t>(bytes);
    case pcl::PCLPointField::UINT32:
      return Load<std::uint32_t>(bytes);
    case pcl::PCLPointField::FLOAT32:
      return Load<float>(bytes);
    default:
      return Load<double>(bytes);
  }
}

/// One number of every point.
std::vector<double> LoadField(const pcl::PCLPointCloud2& points, const pcl::PCLPointField& field) {
  std::vector<double> values(std::size_t{points.width} * points.height);
  const std::uint8_t* bytes = points.data.data() + field.offset;
  for (double& value : values) {
    value = LoadNumber(bytes, field.datatype);
    bytes += points.point_step;
  }
  return values;
}

/// Frame files in order of their names, which are numbers of at least six digits.
std::vector<std::filesystem::path> FrameFiles(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    const std::filesystem::path extension = entry.path().extension();
    if (extension == ".pcd" || extension == ".ply") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// "000012", or "50 frames, 000000 to 000049". @pre `files` is not empty.
std::string NamesOf(const std::vector<std::filesystem::path>& files) {
  std::string first = files.front().stem().string();
  if (files.size() == 1) return first;
  return std::to_string(files.size()) + " frames, " + first + " to " + files.back().stem().string();
}

}  // namespace

Cloud MakeCloud(const pcl::PCLPointCloud2& points, const std::string& place) {
  std::array<std::vector<double>, 3> axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const pcl::PCLPointField* const field = FindField(points, name);
    if (field == nullptr) throw InputError(place + ": has no field " + name);
    axes[axis] = LoadField(points, *field);
  }
  std::map<std::string, std::vector<double>> scalars;
  for (const std::string_view name : kScalars) {
    const pcl::PCLPointField* const field = FindField(points, name);
    if (field != nullptr) scalars.emplace(name, LoadField(points, *field));
  }

  Cloud cloud;
  for (const auto& [name, values] : scalars) cloud.fields[name];
  for (std::size_t i = 0; i < axes[0].size(); ++i) {
    const std::array<double, 3> position_m = {axes[0][i], axes[1][i], axes[2][i]};
    if (!std::ranges::all_of(position_m, [](double value) { return std::isfinite(value); }))
      continue;
    for (const double value : position_m) cloud.positions_m.push_back(static_cast<float>(value));
    for (const auto& [name, values] : scalars) cloud.fields[name].push_back(values[i]);
  }
  return cloud;
}

Cloud ReadCloud(const std::filesystem::path& file) {
  return MakeCloud(ReadPointFile(file), file.string());
}

std::filesystem::path FindCloudFile(const std::filesystem::path& source,
                                    std::optional<std::uint32_t> frame) {
  if (!std::filesystem::exists(source)) {
    throw InputError(source.string() + ": no such file or directory");
  }
  if (!std::filesystem::is_directory(source)) return source;
  const std::filesystem::path directory = source / "frames";
  if (!std::filesystem::is_directory(directory)) {
    throw InputError(source.string() + ": is no sequence directory (it has no frames/)");
  }
  const std::vector<std::filesystem::path> files = FrameFiles(directory);
  if (files.empty()) throw InputError(directory.string() + ": has no .pcd or .ply file");
  if (!frame) return files.front();
  std::array<char, 16> stem{};
  std::snprintf(stem.data(), stem.size(), "%06u", *frame);
  const auto found = std::ranges::find(files, stem.data(), &std::filesystem::path::stem);
  if (found == files.end()) {
    throw InputError(directory.string() + ": has no frame " + stem.data() + " (it has " +
                     NamesOf(files) + ")");
  }
  return *found;
}

}  // namespace railcast
