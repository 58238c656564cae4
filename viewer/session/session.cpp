#include "viewer/session/session.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "viewer/composition/coloring.h"
#include "viewer/composition/composer.h"
#include "viewer/composition/status_text.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {
namespace {

void AddLine(const std::string& line, std::string& text) {
  if (line.empty()) return;
  if (!text.empty()) text += '\n';
  text += line;
}

}  // namespace

std::shared_ptr<const ShownFrame> Session::Source::Get(std::size_t place) const {
  const std::ptrdiff_t own = static_cast<std::ptrdiff_t>(place) + offset;
  return own < 0 ? nullptr : frames->Get(static_cast<std::size_t>(own));
}

std::shared_ptr<const CameraPicture> Session::Source::Picture(std::size_t place,
                                                              PictureKind kind) const {
  const std::ptrdiff_t own = static_cast<std::ptrdiff_t>(place) + offset;
  return own < 0 ? nullptr : frames->Picture(static_cast<std::size_t>(own), kind);
}

Session::Session(const std::vector<Frames*>& frames, Choices choices)
    : choices_(std::move(choices)) {
  for (Frames* const each : frames) {
    sources_.push_back({.frames = each, .composer = Composer(each->info())});
  }
  PairSources();
}

void Session::PairSources() {
  // Frames into which something was put have the numbers of the recording's.
  const auto is_numbered = [this](const Source& source) {
    const std::string& kind = source.frames->info().kind;
    const bool is_counted = kind == "sequence" || kind == "directory of point clouds" ||
                            kind.starts_with("capture") || kind.starts_with("bag");
    return is_counted && kind == sources_.front().frames->info().kind && source.frames->Get(0);
  };
  if (sources_.size() < 2 || !std::ranges::all_of(sources_, is_numbered)) return;
  const auto first_number = [](const Source& source) {
    return static_cast<std::ptrdiff_t>(source.frames->Get(0)->frame().index);
  };
  for (Source& source : sources_) source.offset = first_number(sources_[0]) - first_number(source);
}

void Session::FitToAll(const std::vector<std::shared_ptr<const ShownFrame>>& shown) {
  const auto has_it = [this](const auto& each) {
    return std::ranges::count(ColorableFields(*each->recorded), choices_.color_by) > 0;
  };
  if (choices_.color_by.empty()) {
    choices_.color_by = DefaultColorField(*shown.front()->recorded);
    if (!std::ranges::all_of(shown, has_it)) choices_.color_by = "height";
  }
  // A source that lacks what was asked for shows another field, and says so.
  if (std::ranges::none_of(shown, has_it)) FitChoices(*shown.front(), choices_);
  for (const auto& each : shown) {
    if (has_it(each)) FitChoices(*each, choices_);
  }
}

bool Session::Seek(std::size_t place) {
  std::vector<std::shared_ptr<const ShownFrame>> shown;
  for (const Source& source : sources_) {
    shown.push_back(source.Get(place));
    if (!shown.back()) return false;
  }
  if (shown_.empty()) FitToAll(shown);
  shown_ = std::move(shown);
  place_ = place;
  return true;
}

std::size_t Session::FirstPlace() const {
  std::ptrdiff_t first = 0;
  for (const Source& source : sources_) {
    const auto own = static_cast<std::ptrdiff_t>(source.frames->first_known());
    first = std::max(first, own - source.offset);
  }
  return static_cast<std::size_t>(first);
}

std::size_t Session::LastPlace() const {
  std::ptrdiff_t num_common = std::numeric_limits<std::ptrdiff_t>::max();
  for (const Source& source : sources_) {
    const auto own = static_cast<std::ptrdiff_t>(source.frames->num_known());
    num_common = std::min(num_common, own - source.offset);
  }
  return num_common <= 0 ? 0 : static_cast<std::size_t>(num_common - 1);
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

void Session::ShowNextPicture() {
  const auto shown = static_cast<std::size_t>(choices_.picture.value_or(PictureKind::kColor));
  choices_.picture = static_cast<PictureKind>((shown + 1) % kPictureKindNames.size());
}

void Session::ToggleLabel(std::uint32_t label) {
  if (choices_.labels.erase(label) == 0) choices_.labels.insert(label);
}

std::size_t Session::num_views() const {
  return choices_.layout == Layout::kBeside ? sources_.size() : 1;
}

double Session::Period_s() const {
  constexpr double kUsual_s = 0.1;
  if (shown_.empty()) return kUsual_s;
  try {
    const auto neighbour = sources_.front().Get(place_ > 0 ? place_ - 1 : place_ + 1);
    if (!neighbour) return kUsual_s;
    const auto gap_ns = std::abs(shown_.front()->frame().stamp_ns - neighbour->frame().stamp_ns);
    return gap_ns > 0 ? 1e-9 * static_cast<double>(gap_ns) : kUsual_s;
  } catch (const InputError&) {
    return kUsual_s;  // Asking for that frame reports why it cannot be read.
  }
}

ShownFrames Session::FramesWith(const Source& source,
                                const std::shared_ptr<const ShownFrame>& shown) const {
  ShownFrames frames = {shown};
  // Without poses it is not known where the earlier frames were.
  const std::size_t num_wanted = shown->recorded->has_pose ? choices_.num_accumulated : 1;
  for (std::size_t back = 1; back < num_wanted && back <= place_; ++back) {
    try {
      if (auto earlier = source.Get(place_ - back)) frames.push_back(std::move(earlier));
    } catch (const InputError&) {
      continue;  // Frames that cannot be read are left out; the status counts the rest.
    }
  }
  return frames;
}

bool Session::HasPicture() const {
  return std::ranges::any_of(sources_, [this](const Source& source) {
    try {
      return source.Picture(place_, *choices_.picture) != nullptr;
    } catch (const InputError&) {
      return true;  // Composing says why it cannot be read.
    }
  });
}

void Session::AddPicture(const Source& source, Composition& composition) const {
  try {
    composition.picture = source.Picture(place_, choices_.picture.value_or(PictureKind::kColor));
  } catch (const InputError& error) {
    composition.picture_fault = error.what();
    AddLine(composition.picture_fault, composition.status);
  }
}

std::string Session::Missing() const {
  if (choices_.num_accumulated > 1 && !shown_.front()->recorded->has_pose) {
    return "frames without poses are not accumulated";
  }
  if (choices_.num_accumulated > 1 && num_views() < sources_.size()) {
    return "distances and changes are of single frames: they are not accumulated";
  }
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    std::string missing = sources_[i].composer.Missing(*shown_[i], choices_);
    if (!missing.empty()) return missing;
  }
  if (choices_.picture.value_or(PictureKind::kOff) != PictureKind::kOff && !HasPicture()) {
    return sources_.front().frames->PictureNeeds();
  }
  return {};
}

std::string Session::StatusOf(std::size_t index, const Composition& composition) const {
  const ShownFrame& shown = *shown_[index];
  const RecordingInfo& info = sources_[index].frames->info();
  std::string first = ShownPath(info.source);
  first += "   ";
  first += FrameText(shown);
  std::string text;
  AddLine(first, text);
  if (num_views() == sources_.size()) AddLine(AccumulatedText(composition), text);
  AddLine(DropoutText(*shown.recorded), text);
  AddLine(SelectionText(shown, choices_.labels, info.labels), text);
  return text;
}

Choices Session::ChoicesFor(Source& source, const ShownFrame& shown, std::string& fault) {
  const std::vector<std::string> fields = ColorableFields(*shown.recorded);
  if (std::ranges::count(fields, choices_.color_by) > 0) return choices_;
  fault = "has no field " + choices_.color_by + " to color by";
  Choices choices = choices_;
  if (std::ranges::count(fields, source.fallback.color_by) == 0) {
    source.fallback.color_by = DefaultColorField(*shown.recorded);
    source.fallback.ends.reset();
    FitChoices(shown, source.fallback);
  }
  choices.color_by = source.fallback.color_by;
  choices.ends = source.fallback.ends;
  return choices;
}

Composition Session::ComposeOne(std::size_t index) {
  Source& source = sources_[index];
  std::string fault;
  const Choices choices = ChoicesFor(source, *shown_[index], fault);
  Composition composition = source.composer.Compose(FramesWith(source, shown_[index]), choices);
  composition.status = StatusOf(index, composition);
  AddLine(fault, composition.status);
  AddPicture(source, composition);
  return composition;
}

Composition Session::ComposePoints() {
  if (choices_.layout == Layout::kChanges) return ComposeChanges(shown_[0], shown_[1], choices_);
  Composition distances = ComposeDistances(shown_[0], shown_[1], choices_);
  choices_.distance_ends_m = distances.coloring.ends;
  return distances;
}

Composition Session::ComposeBoth() {
  Composition points = ComposePoints();
  // Overlays are those of the source in whose axes the points are drawn.
  const std::size_t main = points.clouds[0].source;
  std::string fault;
  Composition composition = sources_[main].composer.Compose(
      {shown_[main]}, ChoicesFor(sources_[main], *shown_[main], fault));
  composition.clouds = std::move(points.clouds);
  composition.coloring = std::move(points.coloring);
  for (std::size_t i = 0; i < sources_.size(); ++i)
    AddLine(StatusOf(i, composition), composition.status);
  AddPicture(sources_[0], composition);
  return composition;
}

std::vector<Composition> Session::Compose() {
  std::vector<Composition> compositions;
  if (shown_.empty()) {
    compositions.resize(num_views());
    return compositions;
  }
  if (num_views() == sources_.size()) {
    for (std::size_t i = 0; i < sources_.size(); ++i) compositions.push_back(ComposeOne(i));
  } else {
    compositions.push_back(ComposeBoth());
  }
  AddLine(Missing(), compositions[0].status);
  return compositions;
}

}  // namespace railcast
