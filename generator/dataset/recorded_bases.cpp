#include "generator/dataset/recorded_bases.h"

#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"

namespace railcast {
namespace {

class ReadBase final : public RecordedBase {
 public:
  explicit ReadBase(RecordedRun run)
      : run_(std::move(run)), traits_(RecordingTraits(run_.recording)) {
    for (std::uint32_t i = 0; i < run_.num_frames(); ++i) {
      frames_.push_back({run_.way.frame_times_ns[i], run_.Chainage_m(i), run_.line.faces_up.at(i)});
    }
  }

  [[nodiscard]] const RecordedRun& run() const { return run_; }
  [[nodiscard]] const ScenarioSpec& plan() const override { return run_.plan; }
  [[nodiscard]] const std::filesystem::path& recording() const override { return run_.recording; }
  [[nodiscard]] const std::vector<FramePlace>& frames() const override { return frames_; }
  [[nodiscard]] const std::string& Traits() const override { return traits_; }
  [[nodiscard]] ScenarioSpec OnLine(ScenarioSpec plan) const override {
    return OnRecordedLine(run_, std::move(plan));
  }

 private:
  RecordedRun run_;
  std::string traits_;
  std::vector<FramePlace> frames_;
};

}  // namespace

std::shared_ptr<const RecordedBase> ReadRecordedBase(const std::filesystem::path& plan_file,
                                                     const std::filesystem::path& recording) {
  return std::make_shared<const ReadBase>(ReadRecordedRun(plan_file, recording));
}

const RecordedRun& RunOf(const RecordedBase& base) {
  const auto* const read = dynamic_cast<const ReadBase*>(&base);
  Check(read != nullptr, "the generator reads the recordings of its recipes");
  return read->run();
}

}  // namespace railcast
