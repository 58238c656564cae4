#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "analysis/extras/study/approach_record.h"
#include "analysis/extras/study/study_directory.h"
#include "core/extras/insert/convert_record.h"
#include "core/extras/insert/insert_record.h"
#include "core/extras/recipe/dataset_record.h"
#include "core/extras/recipe/dataset_report_record.h"
#include "core/extras/ros/bag/bag_lines.h"
#include "core/io/run/object_record.h"
#include "core/io/run/run_record.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/survey_record.h"
#include "core/io/run/table_records.h"
#include "core/io/write_file.h"
#include "core/scenario/archive.h"

namespace railcast {
namespace {

constexpr const char* kHead = R"(# Records: every key of the files that railcast writes

<!-- Written by RecordReference.IsWhatTheDescriptionsSay (tests/analysis/record_reference_test.cpp): do not edit. -->

[files.md](files.md), [dataset.md](dataset.md), [insert.md](insert.md), [survey.md](survey.md) and [study.md](study.md) say
what the files are for. Keys stand in this order. *Optional* keys are left out where there is no value; *or null* ones are
null. Readers take no other keys. `…[]` stands for each element of a list, `….*` for each value of an object whose keys are
names. Files that end in `.jsonl` have a record on each line; a line's last key `line_xxh3`, which is not listed here, is
the hash of the line before it, and `manifest_xxh3` at the end of a `manifest.json` or a `sensors.json` that of the file
before it. Hashes are 64-bit XXH3, as `xxhsum -H3` prints them.
)";

std::string TypeText(const ValueType& type) {
  using Kind = ValueType::Kind;
  switch (type.kind) {
    case Kind::kBool:
      return "true or false";
    case Kind::kNumber:
      return "number";
    case Kind::kWhole:
    case Kind::kSigned:
      return "whole number";
    case Kind::kText:
    case Kind::kName:
      return "text";
    case Kind::kOptional:
      return TypeText(*type.of());
    case Kind::kArray: {
      const NewValue value(type);
      return std::to_string(type.size(value.ref().place)) + " numbers";
    }
    case Kind::kList:
      return "list";
    case Kind::kJson:
      return "any";
    default:
      return "object";
  }
}

/// Adds a row for each key of a record, and those of the records in it.
class RecordRows final : public Archive {
 public:
  RecordRows(std::string prefix, std::string& rows) : prefix_(std::move(prefix)), rows_(rows) {}

  void Preset(std::string_view, std::optional<std::string>&, KeyDoc, const FilePreset&) override {}
  void Types(std::string_view, std::vector<ModelSpec>&, KeyDoc) override {}
  void Switches(std::string_view,
                std::map<std::string, bool>&,
                KeyDoc,
                const std::vector<std::string>&) override {}

 private:
  void Visit(const Key& key, const ValueRef& value) override {
    const std::string name = prefix_ + std::string(key.name);
    rows_ += "| `" + name + "` | " + TypeText(*value.type) + (key.is_nullable ? " or null" : "") +
             " | " + (key.is_required ? "" : "*Optional.* ") + key.doc.text() + " |\n";
    AddRowsOf(*value.type, name);
  }

  void AddRowsOf(const ValueType& type, const std::string& name) {
    using Kind = ValueType::Kind;
    if (type.kind == Kind::kOptional) return AddRowsOf(*type.of(), name);
    if (type.kind == Kind::kList) return AddRowsOf(*type.of(), name + "[]");
    if (type.kind == Kind::kMap) return AddRowsOf(*type.of(), name + ".*");
    if (type.kind != Kind::kStruct) return;
    const NewValue value(type);
    RecordRows rows(name + ".", rows_);
    type.describe(rows, value.ref().place);
  }

  std::string prefix_;
  std::string& rows_;
};

template <class T>
std::string TableOf(const std::string& title) {
  std::string text = "\n## " + title + "\n\n| key | value | meaning |\n|---|---|---|\n";
  T record;
  RecordRows rows("", text);
  Describe(rows, record);
  return text;
}

// After a change of a record's description, write the page anew with
//   RAILCAST_WRITE_RECORDS=1 build/release/tests/analysis/analysis_tests
//   --gtest_filter='RecordReference.*'
TEST(RecordReference, IsWhatTheDescriptionsSay) {
  const std::string text =
      kHead + TableOf<FrameRecord>("frames.jsonl") + TableOf<ObjectsRecord>("objects.jsonl") +
      TableOf<RunRecord>("run.json") + TableOf<ManifestRecord>("manifest.json") +
      TableOf<LabelsRecord>("labels.json") + TableOf<MaterialsRecord>("materials.json") +
      TableOf<BagLineRecord>("bag.jsonl") + TableOf<SensorsRecord>("sensors.json") +
      TableOf<MergedRecord>("merged/merged.jsonl") +
      TableOf<InsertRunRecord>("run.json of an insertion") + TableOf<InsertRecord>("insert.jsonl") +
      TableOf<InsertManifestRecord>("manifest.json of an insertion") +
      TableOf<ConvertRunRecord>("run.json of a conversion") +
      TableOf<ConvertRecord>("convert.jsonl") +
      TableOf<ConvertManifestRecord>("manifest.json of a conversion") +
      TableOf<SurveyRecord>("survey.json") + TableOf<DatasetRecord>("dataset.json") +
      TableOf<ScenarioRecord>("scenarios.jsonl") + TableOf<IndexRecord>("index.jsonl") +
      TableOf<DatasetReportRecord>("report.json of a data set") +
      TableOf<DatasetManifestRecord>("manifest.json of a data set") +
      TableOf<StudyRecord>("study.json") + TableOf<ApproachRecord>("approaches.jsonl") +
      TableOf<StudyManifestRecord>("manifest.json of a study");
  const std::filesystem::path file = std::filesystem::path(RAILCAST_SOURCE_DIR) / "docs/records.md";
  if (std::getenv("RAILCAST_WRITE_RECORDS") != nullptr) std::ofstream(file) << text;
  EXPECT_EQ(ReadFileWhole(file), text);
}

}  // namespace
}  // namespace railcast
