// The official conformance suite of MCAP: 416 files of all combinations of features, each with the
// records that it holds.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/input_file.h"
#include "core/extras/ros/mcap/mcap_index.h"
#include "core/extras/ros/mcap/mcap_writer.h"
#include "core/extras/ros/mcap/record_codec.h"
#include "core/extras/ros/mcap/record_scan.h"

namespace railcast::mcap {
namespace {

using nlohmann::json;

std::vector<std::filesystem::path> ConformanceFiles() {
  const std::filesystem::path folder = RAILCAST_SHARED_DATA_DIR "/mcap/conformance";
  std::vector<std::filesystem::path> files;
  if (!exists(folder)) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

json BytesJson(ByteSpan bytes) {
  json numbers = json::array();
  for (const std::byte byte : bytes) numbers.push_back(std::to_string(static_cast<int>(byte)));
  return numbers;
}

/// Makes of each field what the suite's files have for it.
class JsonMaker {
 public:
  void operator()(const std::string& name, const std::string& text) {
    const bool is_bytes = name == "data";
    fields_[name] = is_bytes ? BytesJson(std::as_bytes(std::span(text))) : json(text);
  }
  void operator()(const std::string& name, ByteSpan bytes) { fields_[name] = BytesJson(bytes); }
  void operator()(const std::string& name, const CountedBytes& counted) {
    fields_[name] = BytesJson(counted.bytes);
  }
  void operator()(const std::string& name, std::unsigned_integral auto number) {
    fields_[name] = std::to_string(number);
  }
  template <typename Key, typename Value>
  void operator()(const std::string& name, const std::map<Key, Value>& map) {
    json object = json::object();
    for (const auto& [key, value] : map) {
      if constexpr (std::integral<Key>) {
        object[std::to_string(key)] = std::to_string(value);
      } else {
        object[key] = value;
      }
    }
    fields_[name] = object;
  }

  [[nodiscard]] json Made(const std::string& type) {
    fields_.erase("crc");  // That of an attachment, which the suite leaves out.
    json fields = json::array();
    for (const auto& [name, value] : fields_) fields.push_back({name, value});
    return {{"type", type}, {"fields", fields}};
  }

 private:
  std::map<std::string, json> fields_;
};

template <typename Record>
void AddRecord(const std::string& type, ByteSpan content, json& records) {
  const auto record = ReadRecord<Record>(content);
  JsonMaker maker;
  VisitFields(record, maker);
  records.push_back(maker.Made(type));
}

void AddAny(McapOpcode opcode, ByteSpan content, json& records) {
  switch (opcode) {
    case McapOpcode::kHeader:
      return AddRecord<McapHeader>("Header", content, records);
    case McapOpcode::kFooter:
      return AddRecord<McapFooter>("Footer", content, records);
    case McapOpcode::kSchema:
      return AddRecord<McapSchema>("Schema", content, records);
    case McapOpcode::kChannel:
      return AddRecord<McapChannel>("Channel", content, records);
    case McapOpcode::kMessage:
      return AddRecord<McapMessage>("Message", content, records);
    case McapOpcode::kChunk: {
      Bytes storage;
      RecordCursor cursor(RecordsOfChunk(content, storage));
      while (const auto record = cursor.Next()) AddAny(record->opcode, record->content, records);
      return;
    }
    case McapOpcode::kMessageIndex:
      return;  // The suite leaves them out.
    case McapOpcode::kChunkIndex:
      return AddRecord<McapChunkIndex>("ChunkIndex", content, records);
    case McapOpcode::kAttachment:
      return AddRecord<McapAttachment>("Attachment", content, records);
    case McapOpcode::kAttachmentIndex:
      return AddRecord<McapAttachmentIndex>("AttachmentIndex", content, records);
    case McapOpcode::kStatistics:
      return AddRecord<McapStatistics>("Statistics", content, records);
    case McapOpcode::kMetadata:
      return AddRecord<McapMetadata>("Metadata", content, records);
    case McapOpcode::kMetadataIndex:
      return AddRecord<McapMetadataIndex>("MetadataIndex", content, records);
    case McapOpcode::kSummaryOffset:
      return AddRecord<McapSummaryOffset>("SummaryOffset", content, records);
    case McapOpcode::kDataEnd:
      return AddRecord<McapDataEnd>("DataEnd", content, records);
  }
}

/// Takes each field from what the suite's files have for it.
class JsonTaker {
 public:
  explicit JsonTaker(const json& record) {
    for (const json& field : record.at("fields")) fields_[field.at(0)] = field.at(1);
  }
  void operator()(const std::string& name, std::string& text) {
    if (name == "data") {
      for (const json& number : fields_.at(name)) text += static_cast<char>(ByteOf(number));
    } else {
      text = fields_.at(name);
    }
  }
  void operator()(const std::string& name, ByteSpan& bytes) { bytes = Kept(name); }
  void operator()(const std::string& name, CountedBytes& counted) { counted.bytes = Kept(name); }
  template <std::unsigned_integral Number>
  void operator()(const std::string& name, Number& number) {
    const auto field = fields_.find(name);
    if (field != fields_.end()) {
      number = static_cast<Number>(std::stoull(field->second.get<std::string>()));
    }
  }
  void operator()(const std::string& name, std::map<std::string, std::string>& map) {
    map = fields_.at(name).get<std::map<std::string, std::string>>();
  }

 private:
  static std::byte ByteOf(const json& number) {
    return static_cast<std::byte>(std::stoi(number.get<std::string>()));
  }
  ByteSpan Kept(const std::string& name) {
    for (const json& number : fields_.at(name)) kept_.push_back(ByteOf(number));
    return kept_;
  }

  std::map<std::string, json> fields_;
  Bytes kept_;
};

template <typename Record>
void WriteRecord(const json& record, McapWriter& writer) {
  JsonTaker taker(record);
  Record made;
  VisitFields(made, taker);
  writer.Write(made);
}

void WriteAny(const json& record, McapWriter& writer) {
  const std::string type = record.at("type");
  if (type == "Schema") WriteRecord<McapSchema>(record, writer);
  if (type == "Channel") WriteRecord<McapChannel>(record, writer);
  if (type == "Message") WriteRecord<McapMessage>(record, writer);
  if (type == "Attachment") WriteRecord<McapAttachment>(record, writer);
  if (type == "Metadata") WriteRecord<McapMetadata>(record, writer);
}

McapFeatures FeaturesOf(const std::vector<std::string>& names) {
  const auto has = [&](const char* name) { return std::ranges::find(names, name) != names.end(); };
  return {.has_chunks = has("ch"),
          .has_message_indexes = has("mx"),
          .has_chunk_indexes = has("chx"),
          .has_statistics = has("st"),
          .repeats_schemas = has("rsh"),
          .repeats_channels = has("rch"),
          .has_attachment_indexes = has("ax"),
          .has_metadata_indexes = has("mdx"),
          .has_summary_offsets = has("sum")};
}

std::string WrittenFrom(const json& variant, const std::vector<std::string>& features) {
  std::string bytes;
  const auto sink = [&](ByteSpan more) {
    bytes.append(reinterpret_cast<const char*>(more.data()), more.size());
  };
  McapWriter writer(sink, {"", ""}, McapCompression::kNone, FeaturesOf(features));
  for (const json& record : variant.at("records")) {
    if (record.at("type") == "DataEnd") break;
    WriteAny(record, writer);
  }
  writer.Finish();
  return bytes;
}

class McapConformance : public testing::Test {
 protected:
  void SetUp() override {
    if (files_.empty()) GTEST_SKIP() << "the conformance suite is not there";
    ASSERT_EQ(files_.size(), 416U);
  }

  const std::vector<std::filesystem::path> files_ = ConformanceFiles();
};

TEST_F(McapConformance, ReadsTheRecordsOfEveryFile) {
  for (std::filesystem::path file : files_) {
    SCOPED_TRACE(file);
    const json variant = json::parse(ReadFileWhole(file));
    const ByteFile bytes(file.replace_extension(".mcap"), "file");
    json records = json::array();
    RecordScan scan(bytes);
    while (const auto place = scan.Next()) {
      AddAny(place->opcode, ContentOf(bytes, *place), records);
    }
    EXPECT_TRUE(scan.is_complete());
    EXPECT_EQ(records, variant.at("records"));
  }
}

// Surplus bytes at the end of records are for readers to skip; the writer makes none.
TEST_F(McapConformance, WritesTheBytesOfEveryFileWithoutPadding) {
  std::size_t num_written = 0;
  for (std::filesystem::path file : files_) {
    SCOPED_TRACE(file);
    const json variant = json::parse(ReadFileWhole(file));
    const auto features =
        variant.at("meta").at("variant").at("features").get<std::vector<std::string>>();
    if (std::ranges::find(features, "pad") != features.end()) continue;
    EXPECT_TRUE(WrittenFrom(variant, features) == ReadFileWhole(file.replace_extension(".mcap")));
    ++num_written;
  }
  EXPECT_EQ(num_written, 208U);
}

TEST_F(McapConformance, FindsTheSameInSummariesAsInTheFileItself) {
  std::size_t num_complete = 0;
  for (std::filesystem::path file : files_) {
    SCOPED_TRACE(file);
    const ByteFile bytes(file.replace_extension(".mcap"), "file");
    const McapIndex read = ReadIndex(bytes);
    const McapIndex scanned = ScanWhole(bytes, bytes.size()).index;
    EXPECT_EQ(read.schemas, scanned.schemas);
    EXPECT_EQ(read.channels, scanned.channels);
    EXPECT_EQ(read.chunks.size(), scanned.chunks.size());
    EXPECT_EQ(read.attachments.size(), scanned.attachments.size());
    EXPECT_EQ(read.statistics.message_count, scanned.statistics.message_count);
    if (read.loose.empty()) ++num_complete;
  }
  EXPECT_GT(num_complete, 0U);
}

}  // namespace
}  // namespace railcast::mcap
