#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/certify/certificate.h"
#include "railcast/io/recording.h"
#include "railcast/outcome.h"

namespace railcast {

/// What became of a slot that is not as it was recorded.
struct SlotEdit {
  std::uint32_t slot{};
  /// The recorded slot whose return is here now: this one if its return is merely weaker, another
  /// one of the same firing if it moved. Absent if the slot has no return, or one that was added.
  std::optional<std::uint32_t> from_slot;
  /// Whether its intensity is not the recorded one; of weather, only its power changes. The
  /// position of a recorded return never changes.
  bool is_weaker = false;
  /// Whether the slot had a return when it was recorded, ...
  bool had_point = false;
  /// ... whether it has one now, ...
  bool has_point = false;
  /// ... and whether that one was not recorded.
  bool is_added = false;
  /// Whether most light of an added return comes from a recorded surface, beside which something
  /// new returned within the pulse: its label, instance and material are the recorded ones.
  bool is_merged = false;
  /// What the recorded return of this slot met if it is not in any slot now: kBelowThreshold if too
  /// little of it is left, or nothing; kNoFurtherEcho if the sensor reports others of its firing;
  /// kRainAbsorbed or kCoverBlocked. kReturned otherwise.
  Outcome lost_to = Outcome::kReturned;
  /// Instance of the object that has hidden it; 0 = none, such as fog.
  std::uint32_t hidden_by = 0;
};

/// A recorded frame with objects and weather in it.
struct InsertedFrame {
  /// The frame as the sensor would have recorded it, with the shape of the recorded one. Slots
  /// without an edit are as recorded. Returns that were added have every field that the recording
  /// has, intensities on the recording's own scale, and label, instance, outcome and true range
  /// besides. All returns of a firing say how many it has.
  RecordedFrame recorded;
  std::vector<SlotEdit> edits;  ///< By slot.
  /// The objects with their boxes, in order of the plan, visible or not.
  std::vector<RecordedObject> objects;
  /// If it was asked for; labels are the plan's.
  std::optional<FrameCertificate> certificate{};
};

}  // namespace railcast
