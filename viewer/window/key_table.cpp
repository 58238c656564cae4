#include "viewer/window/key_table.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

#include "viewer/window/view_window.h"

namespace railcast {
namespace {

/// The value after `value` in an enumeration of `count`.
template <typename Enum>
Enum After(Enum value, std::size_t count) {
  return static_cast<Enum>((static_cast<std::size_t>(value) + 1) % count);
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): a table.
std::span<const KeyBinding> KeyTable::Bindings() {
  constexpr std::ptrdiff_t kFar = std::numeric_limits<int>::max();
  static constexpr auto kBindings = std::to_array<KeyBinding>({
      {"space", "space", "play or pause", [](ViewWindow& w) { w.TogglePlaying(); }},
      {"Right", "right, left", "a frame on or back", [](ViewWindow& w) { w.Step(1); }},
      {"Left", "", "", [](ViewWindow& w) { w.Step(-1); }},
      {"Next", "page down, up", "ten frames on or back", [](ViewWindow& w) { w.Step(10); }},
      {"Prior", "", "", [](ViewWindow& w) { w.Step(-10); }},
      {"Home", "home, end", "first or last frame", [](ViewWindow& w) { w.Step(-kFar); }},
      {"End", "", "", [](ViewWindow& w) { w.Step(kFar); }},
      {"period", ". ,", "faster, slower",
       [](ViewWindow& w) { w.ChangeSpeed(true); }},
      {"comma", "", "", [](ViewWindow& w) { w.ChangeSpeed(false); }},
      {"c", "c C", "color by the next or previous field",
       [](ViewWindow& w) { w.session_.ColorByNext(true), w.Refresh(); }},
      {"C", "", "", [](ViewWindow& w) { w.session_.ColorByNext(false), w.Refresh(); }},
      {"m", "m", "next color map", [](ViewWindow& w) { w.NextMap(); }},
      {"f", "f", "fit the scale to this frame",
       [](ViewWindow& w) { w.session_.FitScale(), w.Refresh(); }},
      {"bracketright", "] [", "larger or smaller points",
       [](ViewWindow& w) { w.ChangePointSize(1); }},
      {"bracketleft", "", "", [](ViewWindow& w) { w.ChangePointSize(-1); }},
      {"b", "b", "next background", [](ViewWindow& w) { w.NextBackground(); }},
      {"a", "a A", "accumulate twice or half as many frames",
       [](ViewWindow& w) {
         auto& count = w.session_.choices().num_accumulated;
         count = std::min(2 * count, kMaxAccumulated);
         w.Refresh();
       }},
      {"A", "", "",
       [](ViewWindow& w) {
         auto& count = w.session_.choices().num_accumulated;
         count = std::max<std::size_t>(count / 2, 1);
         w.Refresh();
       }},
      {"n", "n", "beams that brought nothing back",
       [](ViewWindow& w) { w.Toggle(w.session_.choices().empty_beams); }},
      {"s", "s", "surfaces of the scene",
       [](ViewWindow& w) { w.Toggle(w.session_.choices().overlays.mesh); }},
      {"o", "o", "boxes of objects",
       [](ViewWindow& w) { w.Toggle(w.session_.choices().overlays.boxes); }},
      {"t", "t", "track axis with chainage",
       [](ViewWindow& w) { w.Toggle(w.session_.choices().overlays.track); }},
      {"g", "g", "structure gauge",
       [](ViewWindow& w) { w.Toggle(w.session_.choices().overlays.gauge); }},
      {"u", "u", "sensor frustum",
       [](ViewWindow& w) { w.Toggle(w.session_.choices().overlays.frustum); }},
      {"x", "x", "sensor axes", [](ViewWindow& w) { w.Toggle(w.session_.choices().overlays.axes); }},
      {"r", "r", "range rings",
       [](ViewWindow& w) { w.Toggle(w.session_.choices().overlays.rings); }},
      {"1", "1 2 3 4 5", "look from: driver, top, side, chase; see all",
       [](ViewWindow& w) { w.LookFrom(kCameraNames[0]); }},
      {"2", "", "", [](ViewWindow& w) { w.LookFrom(kCameraNames[1]); }},
      {"3", "", "", [](ViewWindow& w) { w.LookFrom(kCameraNames[2]); }},
      {"4", "", "", [](ViewWindow& w) { w.LookFrom(kCameraNames[3]); }},
      {"5", "", "", [](ViewWindow& w) { w.LookFrom(kCameraNames[4]); }},
      {"w", "w", "camera rides along or stays in the world",
       [](ViewWindow& w) { w.rides_along_ = !w.rides_along_; }},
      {"k", "k", "print the camera as options",
       [](ViewWindow& w) {
         std::printf("%s\n", CameraOptions(w.stage_.camera_place()).c_str());
         std::fflush(stdout);
       }},
      {"", "click", "all that is known of a point", nullptr},
      {"", "shift+click", "measure from the point before", nullptr},
      {"z", "z", "turn about the point", [](ViewWindow& w) { w.TurnAboutPick(); }},
      {"e", "e", "effect trace of the point", [](ViewWindow& w) { w.AskTrace(); }},
      {"l", "l", "select the point's label, or no longer (also: click in the legend)",
       [](ViewWindow& w) { w.SelectPickedLabel(); }},
      {"Escape", "escape", "forget selection and picked point",
       [](ViewWindow& w) { w.ClearSelection(); }},
      {"v", "v", "two recordings: side by side, or by distance",
       [](ViewWindow& w) {
         auto& layout = w.session_.choices().layout;
         layout = After(layout, 2);
         w.Refresh();
       }},
      {"p", "p", "save the picture", [](ViewWindow& w) { w.SaveScreenshot(); }},
      {"question", "?", "these keys", [](ViewWindow& w) { w.shows_help_ = !w.shows_help_, w.ShowRest(); }},
      {"q", "q", "quit", [](ViewWindow& w) { w.interactor_->TerminateApp(); }},
  });
  return kBindings;
}

}  // namespace railcast
