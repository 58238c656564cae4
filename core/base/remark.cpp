#include "railcast/remark.h"

#include <algorithm>
#include <utility>

#include "core/base/text.h"

namespace railcast {
namespace {

std::mutex receiver_mutex;
RemarkReceiver& Receiver() {
  static RemarkReceiver receiver;
  return receiver;
}

/// The cloud of a place that may name a point or line of it: "a.ply: point 3", "a.xyz: line 7".
std::string_view WithoutPoint(std::string_view place) {
  return place.substr(0, std::min(place.rfind(": point "), place.rfind(": line ")));
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): a table
const std::vector<RemarkType>& RemarkTypes() {
  using enum RemarkKind;
  static const std::vector<RemarkType> types = {
      {kPacketsLost, "packets-lost", "packet missing by the sensor's own numbers or times",
       "packets missing by the sensor's own numbers or times", true},
      {kPacketsDoubled, "packets-doubled", "packet that had come before",
       "packets that had come before", true},
      {kPacketsLate, "packets-late", "packet that came too late to be put in order",
       "packets that came too late to be put in order", true},
      {kPacketsReordered, "packets-reordered", "packet that came after a later one: put in order",
       "packets that came after later ones: put in order"},
      {kPacketsDamaged, "packets-damaged", "packet with a wrong checksum",
       "packets with a wrong checksum", true},
      {kPacketsRefused, "packets-refused", "packet of the sensor that cannot be read",
       "packets of the sensor that cannot be read", true},
      {kBlocksEmpty, "blocks-empty", "block of zeros in a packet", "blocks of zeros in packets",
       true},
      {kFragmentsMissing, "fragments-missing", "datagram that lacks IP fragments",
       "datagrams that lack IP fragments", true},
      {kFramesUnknown, "frames-unknown", "frame of the network of an unknown type or wrong length",
       "frames of the network of an unknown type or wrong length", true},
      {kOtherSenders, "other-senders", "datagram of other senders", "datagrams of other senders",
       true},
      {kDatagramsUnknown, "datagrams-unknown", "datagram of the sensor of an unknown type",
       "datagrams of the sensor of an unknown type", true},
      {kRecordingCut, "recording-cut", "recording that ends within a record",
       "recordings that end within a record", true},
      {kPointsBeyondData, "points-beyond", "point behind the number that the header states",
       "points behind the number that the header states", true},
      {kSurplusBytes, "surplus-bytes", "byte behind the data", "bytes behind the data", true},
      {kViewpointUnused, "viewpoint-unused",
       "cloud whose viewpoint is not the origin: points are taken as stored",
       "clouds whose viewpoint is not the origin: points are taken as stored"},
      {kPositionsRounded, "positions-rounded",
       "point stored in single precision far from the origin",
       "points stored in single precision far from the origin"},
      {kValuesRounded, "values-rounded", "value of a field of others rounded to single precision",
       "values of fields of others rounded to single precision"},
      {kPointsWithheld, "points-withheld", "point that its file marks as withheld",
       "points that their file marks as withheld", true},
      {kByteOrderGuessed, "byte-order-guessed",
       "cloud whose byte order was told by its values, against what it states",
       "clouds whose byte order was told by their values, against what they state"},
      {kFarReturns, "far-returns", "return beyond the sensor's range",
       "returns beyond the sensor's range"},
      {kTimesRelative, "times-relative",
       "frame whose times count from elsewhere than its stamp: only their differences are taken",
       "frames whose times count from elsewhere than their stamps: only their differences are "
       "taken"},
      {kPosesOverturned, "poses-overturned",
       "pose that turns its sensor upside down: a quaternion as w, x, y, z?",
       "poses that turn their sensor upside down: quaternions as w, x, y, z?"},
      {kPosesBridged, "poses-bridged",
       "pose between transforms that are far apart in time: the straight line between them",
       "poses between transforms that are far apart in time: the straight line between them"},
      {kPosesJumped, "poses-jumped",
       "frame between transforms that jump, as those of two vehicles do: without a pose",
       "frames between transforms that jump, as those of two vehicles do: without poses"},
      {kPosesUnknown, "poses-unknown", "topic of clouds without poses",
       "topics of clouds without poses"},
      {kTransformsLeftOut, "transforms-left-out",
       "transform to a frame of reference that has another one above it",
       "transforms to frames of reference that have others above them", true},
      {kTransformsInvalid, "transforms-invalid",
       "transform that is no position and rotation of a frame of reference in another",
       "transforms that are no position and rotation of a frame of reference in another", true},
      {kTransformsElsewhere, "transforms-elsewhere",
       "topic of transforms of another namespace than that of the clouds",
       "topics of transforms of other namespaces than that of the clouds", true},
      {kUnitsAssumed, "units-assumed", "file that does not state its unit of length: metres",
       "files that do not state their unit of length: metres"},
      {kFieldsLeftOut, "fields-left-out", "field of a cloud left out", "fields of clouds left out",
       true},
      {kFilesLeftOut, "files-left-out", "file left out", "files left out", true},
      {kMaterialFileMissing, "material-file-missing",
       "material file, or material of one, that is not there",
       "material files, or materials of them, that are not there", true},
      {kExtensionUnread, "extension-unread", "extension of the format that is not read",
       "extensions of the format that are not read", true},
      {kAxesMirrored, "axes-mirrored", "mesh with left-handed axes: mirrored",
       "meshes with left-handed axes: mirrored"},
      {kNodesMissing, "nodes-missing",
       "node that a track names and the map lacks: the track is cut there",
       "nodes that tracks name and the map lacks: the tracks are cut there", true},
      {kDeletedLeftOut, "deleted-left-out", "node, way or relation that is deleted",
       "nodes, ways and relations that are deleted", true},
      {kOutlinesLeftOut, "outlines-left-out", "platform whose outline is not in one piece",
       "platforms whose outlines are not in one piece", true},
      {kLinesLeftOut, "lines-left-out", "line that is no track", "lines that are no tracks", true},
      {kTagsUnread, "tags-unread", "tag that is not read", "tags that are not read", true},
      {kSpeedsUnread, "speeds-unread",
       "speed limit that is not understood: its track counts as without one",
       "speed limits that are not understood: their tracks count as without one", true},
      {kSpeedsChosen, "speeds-chosen", "track with several speed limits: the least is taken",
       "tracks with several speed limits each: the least are taken"},
      {kPlacesJoined, "places-joined", "node in the place of another: both are one",
       "nodes in the places of others: they are one with them"},
      {kFixesThinned, "fixes-thinned", "fix while standing that was joined with others",
       "fixes while standing that were joined with others"},
      {kHeightsUnused, "heights-unused",
       "line whose heights are not above sea level: they are ignored",
       "lines whose heights are not above sea level: they are ignored", true},
      {kHeightsMissing, "heights-missing",
       "point without a height: those of its neighbours are used",
       "points without heights: those of their neighbours are used"},
      {kHeightsVoid, "heights-void",
       "cell of an elevation model with a height that cannot be: it counts as without one",
       "cells of an elevation model with heights that cannot be: they count as without one", true},
      {kHeightsFar, "heights-far", "height more than 5 m from the fitted gradients",
       "heights more than 5 m from the fitted gradients"},
      {kPlacesFar, "places-far", "point of a track more than 5 m from the fitted line",
       "points of tracks more than 5 m from the fitted lines"},
      {kRangesDiffer, "ranges-differ",
       "point whose range_m is not its distance from the origin: both are taken as stored",
       "points whose range_m is not their distance from the origin: both are taken as stored"},
      {kRangesUnknown, "ranges-unknown",
       "cloud in which the place of its sensor is not known: without figures by range",
       "clouds in which the places of their sensors are not known: without figures by range"},
      {kLabelsMissing, "labels-missing",
       "frame without labels in a folder that has those of others",
       "frames without labels in a folder that has those of others"},
      {kClocksDiffer, "clocks-differ", "frame on another clock than the transforms: without a pose",
       "frames on another clock than the transforms: without poses"},
      {kClocksShifted, "clocks-shifted",
       "frame on another clock than the transforms: its pose is that of its time on theirs",
       "frames on another clock than the transforms: their poses are those of their times on "
       "theirs"},
      {kSpansOverlap, "spans-overlap",
       "frame that begins before the one before it ends, as one of another sensor",
       "frames that begin before the ones before them end, as those of another sensor"},
  };
  return types;
}

const RemarkType& Remark::type() const {
  return RemarkTypes().at(static_cast<std::size_t>(kind));
}

std::string Remark::Text() const {
  std::string text = NumberText(number) + " ";
  text += number == 1 ? type().one : type().several;
  if (!detail.empty()) text += ": " + detail;
  if (place.empty()) return text;
  return text + (number == 1 ? " (in " : " (the first in ") + place + ")";
}

void AddRemark(const Remark& remark, std::vector<Remark>& remarks) {
  if (remark.number == 0) return;
  const auto known = std::ranges::find(remarks, remark.kind, &Remark::kind);
  if (known == remarks.end()) {
    remarks.push_back(remark);
  } else {
    known->number += remark.number;
    // Which fields of one cloud there are is what one wants to know.
    constexpr std::size_t kLongest = 400;
    const bool is_more = remark.kind == RemarkKind::kFieldsLeftOut &&
                         WithoutPoint(remark.place) == WithoutPoint(known->place) &&
                         !remark.detail.empty() &&
                         known->detail.find(remark.detail) == std::string::npos;
    if (is_more && known->detail.size() + remark.detail.size() < kLongest) {
      known->detail += (known->detail.empty() ? "" : "; ") + remark.detail;
    }
  }
}

RemarkLog::~RemarkLog() {
  for (const Remark& remark : List()) Publish(remark);
}

void RemarkLog::Add(const Remark& remark, std::uint64_t order) {
  if (remark.number == 0) return;
  const std::lock_guard lock(mutex_);
  remarks_.insert_or_assign({remark.kind, order}, remark);
}

void RemarkLog::AddAll(const RemarkLog& other) {
  const std::scoped_lock lock(mutex_, other.mutex_);
  for (const auto& [key, remark] : other.remarks_) remarks_.insert_or_assign(key, remark);
}

std::vector<Remark> RemarkLog::List() const {
  const std::lock_guard lock(mutex_);
  std::vector<Remark> list;
  for (const auto& [key, remark] : remarks_) {
    AddRemark(remark, list);
  }
  return list;
}

void SetRemarkReceiver(RemarkReceiver receiver) {
  const std::lock_guard lock(receiver_mutex);
  Receiver() = std::move(receiver);
}

void Publish(const Remark& remark) {
  const std::lock_guard lock(receiver_mutex);
  if (Receiver()) Receiver()(remark);
}

}  // namespace railcast
