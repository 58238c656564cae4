#include <cmath>
#include <cstdint>
#include <string>

#include "core/base/error.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/cloud/las_reader.h"
#include "core/io/cloud/text_cloud.h"
#include "core/io/recording/cloud_frame.h"
#include "tests/fuzz/fuzz_target.h"

namespace railcast {
namespace {

void CheckCloud(const Cloud& cloud) {
  for (const CloudField& column : cloud.fields) {
    std::size_t num = 0;
    VisitField(cloud, column, [&](std::size_t, auto) { ++num; });
    Check(num == cloud.num_points(), "every point has every field");
  }
}

void CheckFrame(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  Check(frame.returns >= 1 && frame.returns <= 4, "a firing has one to four slots");
  Check(recorded.is_grid || frame.rows == 1, "what is no grid has one row");
  ForEachField(frame, [&](std::string_view, std::string_view, const auto& values) {
    Check(values.size() == frame.num_slots(), "every slot has every field");
  });
  for (const ForeignField& field : recorded.foreign) {
    Check(field.values.size() == frame.num_slots(), "every slot has every foreign field");
  }
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    const bool has_point = !std::isnan(frame.x[i]);
    Check(has_point == (std::isfinite(frame.x[i]) && std::isfinite(frame.y[i]) &&
                        std::isfinite(frame.z[i]) && std::isfinite(frame.range_m[i])),
          "a point is somewhere");
    Check(static_cast<std::size_t>(frame.outcome[i]) < kOutcomeNames.size(), "an outcome is one");
    if (!recorded.is_grid) continue;
    Check(frame.ring[i] == i / frame.width() && frame.return_index[i] == i % frame.returns &&
              frame.column[i] == i % frame.width() / frame.returns,
          "a slot knows its place");
    Check(frame.return_count[i] <= frame.returns, "returns are counted");
  }
}

/// A scan of 2 x 3 firings.
ScanPattern SmallPattern() {
  ScanPattern pattern;
  pattern.rate_hz = 10.0;
  pattern.rows = 2;
  pattern.columns = 3;
  for (std::uint32_t column = 0; column < 3; ++column) {
    for (std::uint16_t row = 0; row < 2; ++row) {
      pattern.row.push_back(row);
      pattern.column.push_back(column);
      pattern.time_ns.push_back(1000 * column);
    }
  }
  return pattern;
}

CloudFile ParseCloud(char kind, const std::string& bytes) {
  if (kind == 'p' || kind == 'P') return ParsePcdFile("fuzz", bytes);
  if (kind == 'k') return ParseKittiFile("fuzz", bytes, std::nullopt);
  return ParsePlyFile("fuzz", bytes);
}

/// What was read can be written, and read again.
void CheckRewriting(char kind, const CloudFile& file) {
  OtherPoints points{file.cloud.data, {}};
  for (std::uint32_t i = 0; i < file.cloud.num_points(); ++i) {
    points.sources.push_back(i % 2 == 0 ? i : kNoSource);
  }
  const std::string bytes = Rewritten(file, points).at(0);
  std::size_t num_points = 0;
  try {
    num_points = ParseCloud(kind, bytes).cloud.num_points();
  } catch (const InputError& error) {
    Check(false, error.what());
  }
  Check(num_points == points.sources.size(), "a file that was written again has its points");
}

void ReadFile(char kind, const std::string& bytes) {
  try {
    if (kind == 'a' || kind == 't' || kind == 'T') {
      const Cloud cloud = kind == 'a'
                              ? ParseLas("fuzz", bytes)
                              : ParseTextCloud("fuzz", bytes, kind == 'T' ? "x,_,ring,y,z" : "");
      CheckCloud(cloud);
      return CheckFrame(MakeCloudFrame(cloud, "fuzz"));
    }
    const CloudFile file = ParseCloud(kind, bytes);
    const Cloud& cloud = file.cloud;
    CheckCloud(cloud);
    CheckRewriting(kind, file);
    const bool is_ours = kind == 'P' || kind == 'L';
    CheckFrame(is_ours ? MakeScanFrame(cloud, "fuzz", SmallPattern(), kind == 'P')
                       : MakeCloudFrame(cloud, "fuzz"));
  } catch (const InputError& error) {
    const std::string message = error.what();
    Check(message.starts_with("fuzz: "), "a fault names its file");
  }
}

}  // namespace
}  // namespace railcast

/// Entry point for libFuzzer. The first byte selects the format of the rest: p PCD, l PLY, k KITTI,
/// a LAS, t text, T text with chosen columns; P and L are files of a railcast sequence.
RAILCAST_FUZZ_TARGET(cloud) {
  if (size == 0) return 0;
  railcast::ReadFile(static_cast<char>(data[0]),
                     std::string(reinterpret_cast<const char*>(data) + 1, size - 1));
  return 0;
}
