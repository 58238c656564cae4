#include "generator/insert/packets/packet_outputs.h"

#include "core/io/recording/recording_kinds.h"
#include "generator/insert/packets/bag_output.h"
#include "generator/insert/packets/capture_output.h"

namespace railcast {

std::unique_ptr<InsertedOutput> MakeCopyOutput(const std::filesystem::path& source,
                                               const std::filesystem::path& folder) {
  if (const auto capture = FindCapture(source)) return MakeCaptureOutput(*capture, folder);
  if (const auto bag = FindBag(source)) return MakeBagOutput(*bag, folder);
  return nullptr;
}

}  // namespace railcast
