#include "generator/insert/packets/insertion.h"

#include <utility>

#include "generator/insert/firing_finder.h"
#include "generator/insert/insert_plan.h"
#include "generator/insert/inserter.h"

namespace railcast {
namespace {

class Insertion {
 public:
  Insertion(const std::filesystem::path& plan, const std::filesystem::path& recording)
      : plan_(ReadInsertPlan(plan, recording)),
        finder_(OpenRecording(recording)->info(), plan_.scenario.lidar.scan, false),
        inserter_(plan_, 0) {}

  /// @param place Of the frame in the recording, whatever number it has.
  [[nodiscard]] InsertedFrame Into(RecordedFrame recorded, std::uint32_t place) {
    return inserter_.Insert(finder_.Find(std::move(recorded)), place);
  }

 private:
  InsertPlan plan_;
  FiringFinder finder_;
  Inserter inserter_;
};

class InsertedRecording : public Recording {
 public:
  InsertedRecording(std::unique_ptr<Recording> recording,
                    const std::filesystem::path& plan,
                    const std::filesystem::path& source)
      : recording_(std::move(recording)), insertion_(plan, source) {}

  [[nodiscard]] const RecordingInfo& info() const override { return recording_->info(); }

  [[nodiscard]] std::optional<FrameReader> Next() override {
    auto read = recording_->Next();
    if (!read) return std::nullopt;
    return [read = std::move(*read), place = next_++, this] {
      return insertion_.Into(read(), place).recorded;
    };
  }

 private:
  std::unique_ptr<Recording> recording_;
  Insertion insertion_;
  std::uint32_t next_ = 0;
};

}  // namespace

InsertIntoFrame MakeInsertion(const std::filesystem::path& plan,
                              const std::filesystem::path& recording) {
  const auto insertion = std::make_shared<Insertion>(plan, recording);
  return [insertion](RecordedFrame recorded) {
    const std::uint32_t place = recorded.frame.index;
    return insertion->Into(std::move(recorded), place);
  };
}

std::unique_ptr<Recording> WithInsertion(std::unique_ptr<Recording> recording,
                                         const std::filesystem::path& plan,
                                         const std::filesystem::path& source) {
  return std::make_unique<InsertedRecording>(std::move(recording), plan, source);
}

}  // namespace railcast
