#include "core/io/run/survey_record.h"

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/strict_json.h"
#include "core/io/write_file.h"

namespace railcast {

std::map<std::string, std::string> ReadSurveyRecord(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kSurveyRecordFile;
  const std::string place = ShownPath(file);
  std::string line = ReadFileWhole(file);
  if (line.ends_with('\n')) line.pop_back();
  if (const std::string fault = LineHashFault(line); !fault.empty()) {
    throw InputError(place + ": " + fault);
  }
  return ReadRecordedJson<StrictJson>(line, place, [](const StrictJson& json) {
    std::map<std::string, std::string> hashes;
    for (const auto& [name, hash] : json.at("files_xxh3").items())
      hashes[name] = hash.get<std::string>();
    return hashes;
  });
}

void CheckSurveyFile(const std::filesystem::path& file, const std::string& hash) {
  if (!exists(file.parent_path() / kSurveyRecordFile)) return;
  const auto hashes = ReadSurveyRecord(file.parent_path());
  const auto said = hashes.find(file.filename().string());
  if (said == hashes.end() || said->second == hash) return;
  throw InputError({Fault{ShownPath(file),
                          "must have the hash " + ShownText(said->second) + ", as " +
                              std::string(kSurveyRecordFile) + " says",
                          hash}});
}

}  // namespace railcast
