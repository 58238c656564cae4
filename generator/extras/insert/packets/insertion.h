#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/extras/packets/recording/capture_recording.h"
#include "generator/extras/insert/inserted_frame.h"
#include "generator/extras/insert/packets/turn_editor.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Puts objects and weather into a frame of a recording. One caller at a time.
using InsertIntoFrame = std::function<InsertedFrame(RecordedFrame recorded)>;

/// The datagrams of a capture or of a bag's packets as they would have been with objects and
/// weather in the sensor's frames. A datagram is returned when its turn has been read to its end.
class InsertedDatagrams final : public DatagramSource {
 public:
  /// @param insert Called for one frame after another.
  /// @throws InputError as OpenDatagrams().
  InsertedDatagrams(const DatagramPlace& place, InsertIntoFrame insert);

  [[nodiscard]] std::optional<CapturedDatagram> Next() override;
  [[nodiscard]] std::vector<Remark> remarks() const override { return datagrams_->remarks(); }

 private:
  struct HeldDatagram {
    std::vector<char> payload;
    CapturedDatagram captured;
  };

  void EditTurn();
  void TakeDatagram();

  InsertIntoFrame insert_;
  std::unique_ptr<Recording> frames_;
  std::unique_ptr<DatagramSource> datagrams_;
  TurnEditor editor_;
  std::deque<HeldDatagram> held_;
  std::uint64_t first_held_{};  ///< Number of their first.
  bool has_turns_ = true;
  bool is_at_end_ = false;  ///< Whether the datagrams have ended.
  HeldDatagram last_;       ///< What Next() returned.
};

/// The place of these datagrams.
[[nodiscard]] DatagramPlace PlaceOfInserted(const DatagramPlace& place,
                                            const InsertIntoFrame& insert);

/// Reads what a plan puts into a recording whose frames are numbered from 0, as those of packets.
/// @param recording As OpenRecording() takes it.
/// @throws InputError as ReadInsertPlan() and Inserter do; the result as FiringFinder does.
[[nodiscard]] InsertIntoFrame MakeInsertion(const std::filesystem::path& plan,
                                            const std::filesystem::path& recording);

/// The recording with what a plan puts into its frames, for readers that take them one by one.
/// @param recording Of which nothing was read yet. @param source As OpenRecording() took it.
[[nodiscard]] std::unique_ptr<Recording> WithInsertion(std::unique_ptr<Recording> recording,
                                                       const std::filesystem::path& plan,
                                                       const std::filesystem::path& source);

}  // namespace railcast
