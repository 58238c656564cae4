#include "generator/insert/plan/pose_file.h"

#include <cmath>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/recording/sequence_lines.h"
#include "core/io/run/frame_record.h"
#include "core/io/write_file.h"
#include "generator/insert/plan/openlabel_poses.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

PoseFile ReadKittiLines(const fs::path& file) {
  const std::string text = ReadFileWhole(file);
  std::string_view rest = text;
  PoseFile poses;
  while (const auto line = TakeLine(rest)) {
    poses.world_from_sensor.push_back(
        ReadKittiPose(std::string(*line),
                      ShownPath(file) + ":" + NumberText(poses.world_from_sensor.size() + 1)));
  }
  return poses;
}

PoseFile ReadCsv(const fs::path& file) {
  const std::string text = ReadFileWhole(file);
  std::string_view rest = text;
  const auto header = TakeLine(rest);
  if (!header || std::string(*header) + "\n" != kPosesHeader) {
    throw InputError(ShownPath(file) + ":1: must be " +
                     std::string(kPosesHeader.substr(0, kPosesHeader.size() - 1)) + " (got " +
                     ShownText(std::string(header.value_or(""))) + ")");
  }
  PoseFile poses;
  for (std::size_t number = 2; const auto line = TakeLine(rest); ++number) {
    const std::string place = ShownPath(file) + ":" + NumberText(number);
    const std::string_view word = line->substr(0, line->find(','));
    const auto stamp_ns = ParseNumber<std::int64_t>(word);
    if (!stamp_ns) {
      throw InputError(place + ": stamp_ns: must be a whole number (got " +
                       ShownText(std::string(word)) + ")");
    }
    poses.world_from_sensor.push_back(ReadPoseLine(*line, *stamp_ns, place));
    poses.stamps_ns.push_back(*stamp_ns);
  }
  return poses;
}

}  // namespace

Transform ReadKittiPose(const std::string& line, const std::string& place) {
  constexpr std::size_t kNumbers = 12;
  constexpr double kRounding = 1e-3;
  const std::vector<std::string_view> words = Words(line);
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> rows = Eigen::Matrix<double, 3, 4>::Zero();
  for (std::size_t i = 0; i < words.size() && i < kNumbers; ++i) {
    const auto number = ParseNumber<double>(words[i]);
    rows.data()[i] = number.value_or(std::nan(""));
  }
  const Eigen::Matrix3d axes = rows.leftCols<3>();
  const bool is_rotation =
      (axes.transpose() * axes).isIdentity(kRounding) && axes.determinant() > 0;
  if (words.size() != kNumbers || !rows.allFinite() || !is_rotation) {
    throw InputError(place + ": must be the 12 numbers of a pose");
  }
  return MakeTransform(Eigen::Quaterniond(axes).normalized().toRotationMatrix(), rows.col(3));
}

PoseFile ReadPoseFile(const fs::path& file, const std::string& sensor) {
  if (file.extension() == ".csv") return ReadCsv(file);
  if (file.extension() == ".json") return ReadOpenLabelPoses(file, sensor);
  return ReadKittiLines(file);
}

}  // namespace railcast
