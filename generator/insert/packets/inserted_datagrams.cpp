#include "generator/insert/packets/inserted_datagrams.h"

#include <algorithm>
#include <utility>

#include "core/base/text.h"

namespace railcast {

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

}  // namespace railcast
