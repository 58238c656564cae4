#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/recording/tf_poses.h"
#include "railcast/io/recording.h"

namespace railcast {

// A topic may carry the clouds or packets of several sensors, each with a frame_id or a channel of
// its own: its series.

/// Whether the last message that a bag returned is of a series, or of any, as ReadHeaders() says.
/// @param series A frame_id, or "frame_id#channel"; empty: any.
/// @throws InputError "rule" if the message is damaged.
[[nodiscard]] bool IsOfSeries(const bag::BagReader& bag,
                              const bag::BagMessage& message,
                              const std::string& series);

/// Returns the next message of a series, as IsOfSeries(); nothing at the end.
/// @throws InputError likewise.
[[nodiscard]] std::optional<bag::BagMessage> NextOfSeries(bag::BagReader& bag,
                                                          const std::string& series);

/// Goes through the messages of a topic, and returns what those of a series say of themselves.
/// Messages of one frame_id are one series, unless they come in several channels at the same time.
/// Those that have neither points nor a frame_id belong to any.
/// @param bag Its selection of topics is changed.
/// @param place Names it in messages: "run.mcap: ".
/// @param series Empty: the only one.
/// @throws InputError "run.mcap: /points: rule" that lists the series if there is no such one, or
///   if several are there and none is chosen.
[[nodiscard]] CloudHeaders ReadHeaders(bag::BagReader& bag,
                                       std::size_t topic,
                                       const std::string& place,
                                       const std::string& series);

/// Tells if frames of a recording begin before those before them have ended. Thread-safe.
class OverlapCheck {
 public:
  explicit OverlapCheck(std::shared_ptr<RemarkLog> remarks) : remarks_(std::move(remarks)) {}

  /// Takes a frame, in any order.
  void Take(const RecordedFrame& recorded);

 private:
  struct Span {
    std::int64_t begin_ns{}, duration_ns{};
    std::string name;
    int num_compared{};  ///< How many neighbours were compared.
  };
  using Spans = std::map<std::uint32_t, Span>;

  void Compare(Spans::iterator before, Spans::iterator after);

  std::shared_ptr<RemarkLog> remarks_;
  std::mutex mutex_;
  Spans spans_;  ///< By index, of frames of which a neighbour is still to come.
};

}  // namespace railcast
