#include "core/extras/insert/convert_record.h"

#include "core/extras/insert/insert_record.h"
#include "core/io/record/read_record.h"
#include "core/scenario/archive.h"

namespace railcast {

void Describe(Archive& a, ConvertRunRecord& s) {
  a.Required("version", s.version, "Version of railcast.");
  a.Required("recording", s.recording, "Path of the recording, as the command line names it.");
  a.Required("recording_xxh3", s.recording_hash,
             "Hash of the names and hashes of the recording's files.");
  a.Required("kind", s.kind, "What kind of recording it is.");
  a.Required("format", s.format, "Format of the clouds, as `--format` names it.");
  a.Required("fields", s.fields, "Fields of the points, as `--fields` names them.");
  a.Required("first_frame", s.first_frame, "Number of the first frame, in the recording.");
  a.Required("num_frames", s.num_frames, "Number of frames.");
}

void Describe(Archive& a, ConvertManifestRecord& s) {
  Describe(a, s.run);
  a.Required("lost", s.lost, "What the format has no place for, and how often.");
  a.Required("files_xxh3", s.files, "Hashes of all files but those that convert.jsonl names.");
}

void Describe(Archive& a, ConvertRecord& s) {
  a.Required("frame", s.frame.frame, "Number of the frame in the recording.");
  a.Required("stamp_ns", s.frame.stamp_ns, "Stamp of the frame.");
  a.Required("points", s.frame.counts.points, "Number of slots with a point.");
  a.Optional("lost", s.lost,
             "What of this frame the format has no place for, as in manifest.json.");
  a.Required("files", s.frame.files, "The frame's files.");
  a.Required("records_xxh3", s.frame.records_hash, "Hash of the frame's lines in the other files.");
}

ConvertRecord ReadConvertLine(std::string_view line, const std::string& place) {
  return ReadRecordLine<ConvertRecord>(line, place);
}

FrameRecord ReadLedgerLine(std::string_view ledger,
                           std::string_view line,
                           const std::string& place) {
  return ledger == kConvertFile ? ReadConvertLine(line, place).frame
                                : ReadInsertLine(line, place).frame;
}

}  // namespace railcast
