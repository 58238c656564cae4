#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/extras/survey/survey_file.h"
#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/fuzz/fuzz_target.h"

namespace railcast {
namespace {

void ReadSurvey(std::string_view bytes) {
  static const TemporaryDirectory directory;
  const auto file = directory.path() / "fuzz.survey";
  WriteFileWhole(file, bytes);
  try {
    const SurveyFile survey(file);
    std::vector<SurveyTile> tiles;
    for (std::size_t i = 0; i < survey.tiles().size(); ++i) tiles.push_back(survey.Read(i));
    WriteFileWhole(file, EncodeSurvey(survey.labels(), tiles));
    const SurveyFile again(file);
    Check(again.num_surfels() == survey.num_surfels() && again.labels() == survey.labels(),
          "what is written is read");
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      const SurveyTile tile = again.Read(i);
      Check(tile.cell == tiles[i].cell && tile.wires.size() == tiles[i].wires.size(),
            "and says the same");
    }
  } catch (const InputError& error) {
    const std::string_view fault = error.what();
    Check(fault.starts_with(file.filename().string()) && fault.find('\n') == std::string_view::npos,
          "a fault is one line that names its file");
  }
}

}  // namespace
}  // namespace railcast

/// a survey as railcast-generate survey writes it.
RAILCAST_FUZZ_TARGET(survey) {
  railcast::ReadSurvey({reinterpret_cast<const char*>(data), size});
  return 0;
}
