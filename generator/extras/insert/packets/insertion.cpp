#include "generator/extras/insert/packets/insertion.h"

#include <algorithm>
#include <utility>

#include "core/base/text.h"
#include "generator/extras/insert/firing_finder.h"
#include "generator/extras/insert/insert_plan.h"
#include "generator/extras/insert/inserter.h"

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

InsertedDatagrams::InsertedDatagrams(const DatagramPlace& place, InsertIntoFrame insert)
    : insert_(std::move(insert)),
      frames_(OpenDatagrams(place)),
      datagrams_(place.open()),
      editor_(FindSensor(place), ShownPath(place.source)) {}

void InsertedDatagrams::TakeDatagram() {
  auto datagram = datagrams_->Next();
  if (!datagram) {
    is_at_end_ = true;
    return editor_.End();
  }
  editor_.Take(*datagram);
  HeldDatagram& held = held_.emplace_back();
  held.payload.assign(datagram->payload.begin(), datagram->payload.end());
  held.captured = *datagram;
}

void InsertedDatagrams::EditTurn() {
  const auto read = frames_->Next();
  if (!read) {
    has_turns_ = false;
    return;
  }
  const InsertedFrame inserted = insert_((*read)());
  while (!editor_.Has(inserted.recorded.frame.index)) TakeDatagram();
  for (const EditedPacket& packet : editor_.Edit(inserted)) {
    std::ranges::copy(packet.after, held_.at(packet.datagram - first_held_).payload.begin() +
                                        static_cast<std::ptrdiff_t>(packet.offset));
  }
}

std::optional<CapturedDatagram> InsertedDatagrams::Next() {
  while (has_turns_ && (held_.empty() || first_held_ >= editor_.first_open_datagram())) EditTurn();
  if (held_.empty() && !is_at_end_) TakeDatagram();
  if (held_.empty()) return std::nullopt;
  last_ = std::move(held_.front());
  held_.pop_front();
  ++first_held_;
  CapturedDatagram datagram = last_.captured;
  datagram.payload = last_.payload;
  datagram.pieces = {};
  return datagram;
}

DatagramPlace PlaceOfInserted(const DatagramPlace& place, const InsertIntoFrame& insert) {
  DatagramPlace inserted = place;
  inserted.open = [place, insert] { return std::make_unique<InsertedDatagrams>(place, insert); };
  return inserted;
}

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
