#include "generator/extras/insert/clouds/edit_cloud.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/io/cloud/cloud_file.h"
#include "core/io/content_hash.h"

namespace railcast {
std::vector<std::uint32_t> EditCloud(const RecordedFirings& firings,
                                     const InsertedFrame& inserted,
                                     const RowContext& context,
                                     std::vector<FrameFile>& files) {
  if (inserted.edits.empty()) return SlotsOfEntries(firings);
  std::optional<std::string> labels;
  if (files.size() > 1) labels = files[1].bytes;
  const CloudFile file =
      ParseCloudFile(files[0].name, files[0].bytes, labels, context.kitti_columns);
  EditedRows edited = EditRows(file.cloud, firings, inserted, context);
  std::vector<std::string> changed = Rewritten(file, edited.points);
  for (std::size_t i = 0; i < changed.size(); ++i) files[i].bytes = std::move(changed[i]);
  return std::move(edited.slots);
}

std::string SourceHash(const std::vector<FrameFile>& files) {
  std::string bytes;
  for (const FrameFile& file : files) bytes += file.bytes;
  return ContentHash(bytes);
}

}  // namespace railcast
