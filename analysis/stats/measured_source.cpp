#include "analysis/stats/measured_source.h"

#include <utility>

#include "core/base/text.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/sequence_files.h"
#include "core/io/verify/dataset_verification.h"

namespace railcast {

MeasuredSource LookAtSource(const std::filesystem::path& source) {
  MeasuredSource whole{.source = source, .recordings = SensorFoldersIn(source)};
  if (!whole.recordings.empty()) return whole;
  if (IsDataset(source)) {
    const DatasetContent content = ReadDatasetContent(source);
    whole.recordings = FinishedSequences(source, content);
    whole.kind = "data set";
    if (content.shard.is_whole()) {
      whole.overview = ReadDatasetOverview(source);
    } else {
      whole.kind = "shard " + ShardText(content.shard) + " of a data set";
    }
    return whole;
  }
  // A run of our own is checked against its hashes as a whole.
  if (!IsThere(source / kRunFile)) whole.recordings = KittiSequencesIn(source);
  if (whole.recordings.empty()) {
    whole.recordings = {source};
  } else {
    const std::size_t num = whole.recordings.size();
    whole.kind = "KITTI data set of " + NumberText(num) + (num == 1 ? " sequence" : " sequences");
  }
  return whole;
}

RecordingInfo InfoOfWhole(const MeasuredSource& whole, const RecordingInfo& first) {
  RecordingInfo info;
  info.source = whole.source;
  info.kind = whole.kind;
  info.labels = first.labels;
  info.materials = first.materials;
  info.has_kitti_labels = first.has_kitti_labels;
  info.origin = first.origin;
  if (info.origin) {
    info.origin->data_hash = whole.overview ? whole.overview->data_hash : "";
    info.origin->scenario_hash.clear();
  }
  return info;
}

}  // namespace railcast
