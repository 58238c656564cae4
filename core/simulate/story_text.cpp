#include "core/simulate/story_text.h"

#include <cmath>
#include <iomanip>
#include <sstream>
#include <vector>

namespace railcast {
namespace {

std::string LabelName(const LabelTable& labels, std::uint32_t id) {
  const Label* label = labels.Find(id);
  return label == nullptr ? std::to_string(id) : label->name;
}

// Writes missing values (NaN) as a dash.
void WriteValue(float value, int width, std::ostream& text) {
  text << std::setw(width);
  if (std::isnan(value)) {
    text << "-";
  } else {
    text << static_cast<double>(value);
  }
}

void WriteSteps(const std::vector<FiringStory::Step>& steps, std::ostream& text) {
  text << std::left << std::setw(18) << "after" << std::setw(17) << "outcome" << std::right
       << std::setw(14) << "true_range_m" << std::setw(15) << "cos_incidence" << std::setw(12)
       << "intensity" << std::setw(13) << "power_ratio" << std::setw(12) << "range_m\n";
  for (const FiringStory::Step& step : steps) {
    const std::string added =
        step.num_added_echoes > 0 ? " +" + std::to_string(step.num_added_echoes) : "";
    text << std::left << std::setw(18) << step.effect + added << std::setw(17)
         << OutcomeName(step.outcome) << std::right;
    WriteValue(step.true_range_m, 14, text);
    WriteValue(step.cos_incidence, 15, text);
    WriteValue(step.intensity, 12, text);
    WriteValue(step.power_ratio, 13, text);
    WriteValue(step.range_m, 11, text);
    text << "\n";
  }
}

void WriteEchoes(const std::vector<FiringStory::Echo>& echoes,
                 const LabelTable& labels,
                 std::ostream& text) {
  text << std::left << std::setw(18) << "echo" << std::setw(17) << "outcome" << std::right
       << std::setw(14) << "true_range_m" << std::setw(15) << "share" << std::setw(25)
       << "power_ratio" << std::setw(11) << "range_m"
       << "  slot\n";
  for (const FiringStory::Echo& echo : echoes) {
    text << std::left << std::setw(18)
         << (echo.label == 0 ? "nothing" : LabelName(labels, echo.label)) << std::setw(17)
         << OutcomeName(echo.outcome) << std::right;
    WriteValue(echo.true_range_m, 14, text);
    WriteValue(echo.footprint_share, 15, text);
    WriteValue(echo.power_ratio, 25, text);
    WriteValue(echo.range_m, 11, text);
    text << "  " << (echo.slot ? std::to_string(*echo.slot) : "none") << "\n";
  }
}

}  // namespace

std::string StoryText(std::uint32_t frame,
                      const FiringStory& story,
                      const LabelTable& labels,
                      const MaterialLibrary& materials) {
  std::ostringstream text;
  text << "frame " << frame << " firing " << story.firing << " at " << story.time_ns << " ns, slot "
       << story.slot << "\n"
       << "from world " << std::fixed << std::setprecision(3) << story.origin_world.transpose()
       << " along sensor " << std::setprecision(6) << story.direction_sensor.transpose() << "\n"
       << std::defaultfloat;
  if (story.label == 0) {
    text << "hits nothing\n";
  } else {
    text << "hits " << LabelName(labels, story.label) << ", instance " << story.instance
         << ", material " << materials.materials().at(story.material).name << " (reflectivity "
         << static_cast<double>(story.reflectivity) << ")\n";
  }
  WriteSteps(story.steps, text);
  if (story.echoes.size() > 1) WriteEchoes(story.echoes, labels, text);
  return text.str();
}

}  // namespace railcast
