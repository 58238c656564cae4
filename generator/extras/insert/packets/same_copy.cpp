#include "generator/extras/insert/packets/same_copy.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/input_file.h"
#include "core/extras/packets/recording/capture_recording.h"
#include "core/extras/ros/recording/bag_recording.h"
#include "core/io/write_file.h"
#include "generator/extras/insert/packets/packet_outputs.h"

namespace railcast {
namespace {

std::vector<std::uint32_t> SlotsWithPoint(const Frame& frame) {
  std::vector<std::uint32_t> slots;
  for (std::uint32_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!std::isnan(frame.x[slot])) slots.push_back(slot);
  }
  return slots;
}

class SameCopy : public RecordingOutput {
 public:
  SameCopy(std::filesystem::path source, std::filesystem::path folder)
      : source_(std::move(source)), folder_(std::move(folder)) {}
  ~SameCopy() override {
    if (copy_ != nullptr && !is_finished_) RemoveUnfinished();
  }
  SameCopy(const SameCopy&) = delete;
  SameCopy& operator=(const SameCopy&) = delete;

  [[nodiscard]] std::uint32_t Begin(std::uint32_t /*num_done*/) override {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) throw FileError(folder_, error.value());
    copy_ = MakeCopyOutput(source_, folder_);
    return 0;
  }

  [[nodiscard]] WrittenFrame Encode(const RecordedFirings& /*firings*/,
                                    const InsertedFrame& /*inserted*/,
                                    std::uint32_t /*frame*/) const override {
    WrittenFrame written;
    written.has_slots = false;
    return written;
  }

  void Write(const RecordedFirings& firings,
             const InsertedFrame& inserted,
             WrittenFrame& output) override {
    auto slots = copy_->Write(firings, inserted);
    output.slots = slots ? std::move(*slots) : SlotsWithPoint(inserted.recorded.frame);
  }
  void Finish() override {
    copy_->Finish();
    is_finished_ = true;
  }
  [[nodiscard]] std::vector<std::string> WholeFiles() const override {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
      if (!entry.is_regular_file()) continue;
      names.push_back(entry.path().lexically_relative(folder_).generic_string());
    }
    std::ranges::sort(names);
    return names;
  }

 private:
  // A copy is begun anew when its run goes on.
  void RemoveUnfinished() {
    copy_.reset();
    std::error_code error;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_, error)) {
      if (entry.path().extension() == kUnfinishedSuffix) files.push_back(entry.path());
    }
    for (const std::filesystem::path& file : files) std::filesystem::remove(file, error);
  }

  std::filesystem::path source_;
  std::filesystem::path folder_;
  std::unique_ptr<InsertedOutput> copy_;
  bool is_finished_ = false;
};

}  // namespace

std::unique_ptr<RecordingOutput> MakeSameCopy(const RecordingInfo& info,
                                              const std::filesystem::path& folder) {
  // A folder of clouds or a sequence may hold a bag, too.
  if (!info.kind.starts_with("capture of ") && info.kind != "bag of ROS 2") return nullptr;
  if (!FindCapture(info.source)) {
    const auto bag = FindBag(info.source);
    // Something put into one is named by its folder.
    if (!bag) return nullptr;
    CheckCanEdit(*bag);
  }
  return std::make_unique<SameCopy>(info.source, folder);
}

}  // namespace railcast
