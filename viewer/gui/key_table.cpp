#include "viewer/gui/gui.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

namespace railcast {
namespace {

/// Returns the value after `value` in an enumeration of `count`, cyclically.
template <typename Enum>
Enum After(Enum value, std::size_t count) {
  return static_cast<Enum>((static_cast<std::size_t>(value) + 1) % count);
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): a table.
std::span<const KeyBinding> KeyTable::Bindings() {
  constexpr std::ptrdiff_t kFar = std::numeric_limits<int>::max();
  static constexpr auto kBindings = std::to_array<KeyBinding>({
      {"space", "space", "play or pause", [](Gui& w) { w.TogglePlaying(); }},
      {"Right", "right, left", "next or previous frame", [](Gui& w) { w.Step(1); }},
      {"Left", "", "", [](Gui& w) { w.Step(-1); }},
      {"Next", "page down, up", "ten frames forward or back", [](Gui& w) { w.Step(10); }},
      {"Prior", "", "", [](Gui& w) { w.Step(-10); }},
      {"Home", "home, end", "first or last frame", [](Gui& w) { w.Step(-kFar); }},
      {"End", "", "", [](Gui& w) { w.Step(kFar); }},
      {"period", ". ,", "faster, slower",
       [](Gui& w) { w.ChangeSpeed(true); }},
      {"comma", "", "", [](Gui& w) { w.ChangeSpeed(false); }},
      {"c", "c C", "color by the next or previous field",
       [](Gui& w) { w.session_.ColorByNext(true), w.Refresh(); }},
      {"C", "", "", [](Gui& w) { w.session_.ColorByNext(false), w.Refresh(); }},
      {"m", "m", "next color map", [](Gui& w) { w.NextMap(); }},
      {"f", "f", "fit the scale to this frame",
       [](Gui& w) { w.session_.FitScale(), w.Refresh(); }},
      {"bracketright", "] [", "larger or smaller points",
       [](Gui& w) { w.ChangePointSize(1); }},
      {"bracketleft", "", "", [](Gui& w) { w.ChangePointSize(-1); }},
      {"b", "b", "next background", [](Gui& w) { w.NextBackground(); }},
      {"a", "a A", "accumulate twice or half as many frames",
       [](Gui& w) {
         auto& count = w.session_.choices().num_accumulated;
         count = std::min(2 * count, kMaxAccumulated);
         w.Refresh();
       }},
      {"A", "", "",
       [](Gui& w) {
         auto& count = w.session_.choices().num_accumulated;
         count = std::max<std::size_t>(count / 2, 1);
         w.Refresh();
       }},
      {"n", "n", "beams that brought nothing back",
       [](Gui& w) { w.Toggle(w.session_.choices().empty_beams); }},
      {"i", "i", "camera's image: color, label, depth or none",
       [](Gui& w) { w.session_.ShowNextPicture(), w.Refresh(); }},
      {"s", "s", "surfaces of the scene",
       [](Gui& w) { w.Toggle(w.session_.choices().overlays.mesh); }},
      {"o", "o", "boxes of objects",
       [](Gui& w) { w.Toggle(w.session_.choices().overlays.boxes); }},
      {"t", "t", "track axis with chainage",
       [](Gui& w) { w.Toggle(w.session_.choices().overlays.track); }},
      {"g", "g", "clear space of the track",
       [](Gui& w) { w.Toggle(w.session_.choices().overlays.gauge); }},
      {"u", "u", "sensor frustum",
       [](Gui& w) { w.Toggle(w.session_.choices().overlays.frustum); }},
      {"x", "x", "sensor axes", [](Gui& w) { w.Toggle(w.session_.choices().overlays.axes); }},
      {"r", "r", "range rings",
       [](Gui& w) { w.Toggle(w.session_.choices().overlays.rings); }},
      {"1", "1 2 3 4 5", "look from: driver, top, side, chase; see all",
       [](Gui& w) { w.LookFrom(kCameraNames[0]); }},
      {"2", "", "", [](Gui& w) { w.LookFrom(kCameraNames[1]); }},
      {"3", "", "", [](Gui& w) { w.LookFrom(kCameraNames[2]); }},
      {"4", "", "", [](Gui& w) { w.LookFrom(kCameraNames[3]); }},
      {"5", "", "", [](Gui& w) { w.LookFrom(kCameraNames[4]); }},
      {"w", "w", "camera rides along or stays in the world",
       [](Gui& w) { w.rides_along_ = !w.rides_along_; }},
      {"k", "k", "print the camera as options",
       [](Gui& w) {
         std::printf("%s\n", CameraOptions(w.stage_.camera_place()).c_str());
         std::fflush(stdout);
       }},
      {"", "click", "all that is known of a point", nullptr},
      {"", "shift+click", "measure from the point before", nullptr},
      {"z", "z", "turn the camera about the point", [](Gui& w) { w.TurnAboutPick(); }},
      {"e", "e", "effect trace of the point", [](Gui& w) { w.AskTrace(); }},
      {"l", "l", "select or deselect the point's label (also: click in the legend)",
       [](Gui& w) { w.SelectPickedLabel(); }},
      {"Escape", "escape", "clear the selection and the picked point",
       [](Gui& w) { w.ClearSelection(); }},
      {"v", "v", "two recordings: side by side, by distance, or by what changed",
       [](Gui& w) {
         auto& layout = w.session_.choices().layout;
         layout = After(layout, kLayoutNames.size());
         w.Refresh();
       }},
      {"p", "p", "save the picture", [](Gui& w) { w.SaveScreenshot(); }},
      {"question", "?", "these keys", [](Gui& w) { w.shows_help_ = !w.shows_help_, w.ShowRest(); }},
      {"q", "q", "quit", [](Gui& w) { w.interactor_->TerminateApp(); }},
  });
  return kBindings;
}

}  // namespace railcast
