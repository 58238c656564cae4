#include "viewer/session/session.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "viewer/color/coloring.h"
#include "viewer/color/field_values.h"
#include "viewer/scene/status_text.h"

namespace railcast {
namespace {

void AddLine(const std::string& line, std::string& text) {
  if (line.empty()) return;
  if (!text.empty()) text += '\n';
  text += line;
}

}  // namespace

Session::Session(const std::vector<Frames*>& frames, Choices choices)
    : choices_(std::move(choices)) {
  for (Frames* const each : frames) sources_.push_back({each, Composer(each->info())});
}

bool Session::Seek(std::size_t place) {
  std::vector<std::shared_ptr<const ShownFrame>> shown;
  for (const Source& source : sources_) {
    shown.push_back(source.frames->Get(place));
    if (!shown.back()) return false;
  }
  if (shown_.empty()) {
    for (const auto& each : shown) FitChoices(*each, choices_);
  }
  shown_ = std::move(shown);
  place_ = place;
  return true;
}

std::size_t Session::LastPlace() const {
  std::size_t num_common = sources_.front().frames->num_known();
  for (const Source& source : sources_) {
    num_common = std::min(num_common, source.frames->num_known());
  }
  return num_common == 0 ? 0 : num_common - 1;
}

void Session::ColorByNext(bool forward) {
  const std::vector<std::string> fields = ColorableFields(*shown_.front()->recorded);
  auto shown = std::ranges::find(fields, choices_.color_by);
  if (shown == fields.end()) {
    shown = std::ranges::find(fields, DefaultColorField(*shown_.front()->recorded));
  }
  auto at = static_cast<std::size_t>(shown - fields.begin());
  at = (at + (forward ? 1 : fields.size() - 1)) % fields.size();
  choices_.color_by = fields[at];
  FitScale();
}

void Session::FitScale() {
  choices_.ends.reset();
  choices_.distance_ends_m.reset();
  const ShownFrame& shown = *shown_.front();
  if (std::ranges::count(ColorableFields(*shown.recorded), choices_.color_by) == 0) return;
  const FieldValues field = ValuesOf(shown, choices_.color_by);
  if (field.kind != FieldValues::Kind::kCategory) choices_.ends = railcast::FitScale(field);
}

void Session::ToggleLabel(std::uint32_t label) {
  if (choices_.labels.erase(label) == 0) choices_.labels.insert(label);
}

std::size_t Session::num_views() const {
  return choices_.layout == Layout::kDistance ? 1 : sources_.size();
}

double Session::Period_s() const {
  constexpr double kUsual_s = 0.1;
  if (shown_.empty()) return kUsual_s;
  const std::size_t other = place_ > 0 ? place_ - 1 : place_ + 1;
  const auto neighbour = sources_.front().frames->Get(other);
  if (!neighbour) return kUsual_s;
  const auto gap_ns = std::abs(shown_.front()->frame().stamp_ns - neighbour->frame().stamp_ns);
  return gap_ns > 0 ? 1e-9 * static_cast<double>(gap_ns) : kUsual_s;
}

ShownFrames Session::FramesWith(const Source& source,
                                const std::shared_ptr<const ShownFrame>& shown) const {
  ShownFrames frames = {shown};
  // Without poses nobody knows where they were.
  const std::size_t num_wanted = shown->recorded->has_pose ? choices_.num_accumulated : 1;
  for (std::size_t back = 1; back < num_wanted && back <= place_; ++back) {
    if (auto earlier = source.frames->Get(place_ - back)) frames.push_back(std::move(earlier));
  }
  return frames;
}

std::string Session::Missing() const {
  if (choices_.num_accumulated > 1 && !shown_.front()->recorded->has_pose) {
    return "frames without poses are not accumulated";
  }
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    std::string missing = sources_[i].composer.Missing(*shown_[i], choices_);
    if (!missing.empty()) return missing;
  }
  return {};
}

std::string Session::StatusOf(std::size_t index) const {
  const ShownFrame& shown = *shown_[index];
  const RecordingInfo& info = sources_[index].frames->info();
  std::string first = info.source.string();
  first += "   ";
  first += FrameText(shown);
  std::string text;
  AddLine(first, text);
  AddLine(DropoutText(*shown.recorded), text);
  AddLine(SelectionText(shown, choices_.labels, info.labels), text);
  return text;
}

Scene Session::ComposeOne(std::size_t index) {
  Source& source = sources_[index];
  const ShownFrames frames = FramesWith(source, shown_[index]);
  const std::vector<std::string> fields = ColorableFields(*shown_[index]->recorded);
  Choices choices = choices_;
  std::string fault;
  if (std::ranges::count(fields, choices.color_by) == 0) {
    fault = "has no field " + choices.color_by + " to color by";
    choices.color_by = DefaultColorField(*shown_[index]->recorded);
    choices.ends.reset();
  }
  Scene scene = source.composer.Compose(frames, choices);
  scene.status = StatusOf(index);
  AddLine(fault, scene.status);
  return scene;
}

std::vector<Scene> Session::Compose() {
  std::vector<Scene> scenes;
  if (shown_.empty()) {
    scenes.resize(num_views());
    return scenes;
  }
  if (num_views() == sources_.size()) {
    for (std::size_t i = 0; i < sources_.size(); ++i) scenes.push_back(ComposeOne(i));
    AddLine(Missing(), scenes[0].status);
    return scenes;
  }
  scenes.push_back(ComposeDistances(shown_[0], shown_[1], choices_));
  choices_.distance_ends_m = scenes[0].coloring.ends;
  for (std::size_t i = 0; i < sources_.size(); ++i) AddLine(StatusOf(i), scenes[0].status);
  AddLine(Missing(), scenes[0].status);
  return scenes;
}

}  // namespace railcast
