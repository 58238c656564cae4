#pragma once

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include "core/extras/packets/spinning/spinning_decoder.h"
#include "core/extras/packets/spinning/spinning_encoder.h"
#include "tests/core/extras/packets/hesai/made_packet.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/support/decoded_turns.h"
#include "tests/support/made_datagrams.h"

namespace railcast {

/// The name of the sensor's file without its extension.
inline std::string FileOf(const SpinningModel& model) {
  std::string name(model.protocol);
  std::ranges::replace(name, '-', '_');
  return name;
}

/// Returns the packets of these frames.
inline Datagrams Encoded(const SpinningModel& model,
                         const MadeScan& scan,
                         const std::vector<Frame>& frames,
                         ReturnMode mode = ReturnMode::kStrongest) {
  const auto encoder = MakeSpinningEncoder(model, scan.spec(), mode);
  Datagrams datagrams;
  for (const Frame& frame : frames) encoder->Encode(frame, datagrams);
  return datagrams;
}

/// Returns the turns in these datagrams, the last of which may be unfinished.
inline std::vector<SensorTurn> TurnsIn(const SpinningModel& model, const Datagrams& datagrams) {
  SpinningDecoder decoder(model);
  return TurnsOfPackets(decoder, PayloadTexts(datagrams));
}

/// A model and how its returns are sent.
struct SentAs {
  std::string protocol;
  ReturnMode mode{};
};

inline void PrintTo(const SentAs& sending, std::ostream* out) {
  *out << sending.protocol << " " << NameOf(sending.mode);
}

/// All models that can be sent, with one return and with two.
inline std::vector<SentAs> Sendings() {
  std::vector<SentAs> sendings;
  std::string last;
  for (const SpinningModel& model : HesaiModels()) {
    if (model.protocol == last) continue;
    last = model.protocol;
    for (const ReturnMode mode : {ReturnMode::kStrongest, ReturnMode::kDual}) {
      sendings.push_back({last, mode});
    }
  }
  return sendings;
}

}  // namespace railcast
