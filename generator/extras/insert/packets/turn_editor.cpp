#include "generator/extras/insert/packets/turn_editor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

const ForeignField* FindSignal(const RecordedFrame& recorded) {
  const auto found = std::ranges::find(recorded.foreign, "signal", &ForeignField::name);
  return found == recorded.foreign.end() ? nullptr : &*found;
}

/// Whether the slot has another return than it was recorded with.
bool IsOther(const SlotEdit& edit) {
  const bool has_moved = edit.from_slot && *edit.from_slot != edit.slot;
  return edit.had_point != edit.has_point || edit.is_added || edit.is_weaker || has_moved;
}

/// What an edit says of its slot; nothing if that has no return.
std::optional<EditedReturn> ReturnOf(const SlotEdit& edit,
                                     const RecordedFrame& recorded,
                                     IntensityBytes bytes) {
  if (!edit.has_point) return std::nullopt;
  const Frame& frame = recorded.frame;
  EditedReturn edited{.range_m = frame.range_m[edit.slot]};
  if (!edit.is_added) {
    edited.from = static_cast<std::uint8_t>(edit.from_slot.value_or(edit.slot) % frame.returns);
  }
  if (!edit.is_added && !edit.is_weaker) return edited;
  edited.intensity = ByteOfIntensity(frame.intensity[edit.slot], bytes);
  const ForeignField* const signal = FindSignal(recorded);
  if (edit.is_added && signal != nullptr && std::isfinite(signal->values[edit.slot])) {
    edited.signal = signal->values[edit.slot];
  }
  return edited;
}

}  // namespace

TurnEditor::TurnEditor(const CaptureSensor& sensor, const std::string& source)
    : reader_(sensor, source), source_(source) {}

void TurnEditor::Take(const CapturedDatagram& datagram) {
  std::deque<OrderedPacket> decoded;
  reader_.Take(datagram, &turns_, &decoded);
  Hold(std::move(decoded));
}

void TurnEditor::End() {
  std::deque<OrderedPacket> decoded;
  reader_.End(&turns_, &decoded);
  Hold(std::move(decoded));
}

void TurnEditor::Hold(std::deque<OrderedPacket> decoded) {
  for (OrderedPacket& packet : decoded) packets_.push_back({std::move(packet)});
}

void TurnEditor::Skip(std::uint32_t turn) {
  for (; first_turn_ < turn && !turns_.empty(); ++first_turn_) {
    static_cast<void>(TakeEdited(turns_.front()));
    turns_.pop_front();
  }
}

void TurnEditor::EditFiring(const FiringPlace& place, const EditedReturns& returns) {
  HeldPacket& held = packets_.at(place.packet - first_packet_);
  std::vector<char>& bytes = held.packet.bytes;
  if (!held.before) held.before = bytes;
  const auto refusal =
      std::visit([&](const auto& decoder) { return decoder.Store(returns, place, bytes); },
                 reader_.sensor().decoder);
  if (refusal) {
    throw InputError(source_ + ": turn " + NumberText(first_turn_) + ": " + *refusal);
  }
}

std::vector<EditedPacket> TurnEditor::TakeEdited(const SensorTurn& turn) {
  std::uint32_t last = first_packet_;
  for (const FiringPlace& place : turn.places) last = std::max(last, place.packet);
  std::vector<EditedPacket> edited;
  for (; !packets_.empty() && first_packet_ <= last; ++first_packet_) {
    auto& [packet, before] = packets_.front();
    if (before) {
      std::visit([&](const auto& decoder) { decoder.Seal(packet.bytes); },
                 reader_.sensor().decoder);
      for (const PacketPlace& place : packet.places) {
        edited.push_back({place.datagram, place.offset, *before, packet.bytes});
      }
      before.reset();
    }
    // The last one may hold the begin of the next turn.
    if (first_packet_ == last) break;
    packets_.pop_front();
  }
  return edited;
}

std::vector<EditedPacket> TurnEditor::Edit(const InsertedFrame& inserted) {
  const Frame& frame = inserted.recorded.frame;
  Skip(frame.index);
  const SensorTurn turn = std::move(turns_.front());
  turns_.pop_front();
  Check(turn.places.size() * frame.returns == frame.num_slots(),
        "an edited frame of a capture has the slots of its turn");
  for (auto edit = inserted.edits.begin(); edit != inserted.edits.end();) {
    const std::size_t cell = edit->slot / frame.returns;
    const std::size_t row = cell / frame.columns;
    const std::size_t column = cell % frame.columns;
    EditedReturns returns;
    bool is_other = false;
    for (std::uint32_t r = 0; r < frame.returns; ++r) {
      const auto slot = static_cast<std::uint32_t>(cell * frame.returns + r);
      if (edit != inserted.edits.end() && edit->slot == slot) {
        is_other = is_other || IsOther(*edit);
        returns.at(r) = ReturnOf(*edit++, inserted.recorded, reader_.sensor().shape.intensity);
      } else if (!std::isnan(frame.range_m[slot])) {
        returns.at(r) = EditedReturn{.from = static_cast<std::uint8_t>(r)};
      }
    }
    if (is_other) EditFiring(turn.places[column * frame.rows + row], returns);
  }
  ++first_turn_;
  return TakeEdited(turn);
}

std::uint64_t TurnEditor::first_open_datagram() const {
  std::uint64_t first = reader_.first_held_datagram().value_or(reader_.num_datagrams());
  for (const auto& [packet, before] : packets_) {
    for (const PacketPlace& place : packet.places) first = std::min(first, place.datagram);
  }
  return first;
}

}  // namespace railcast
