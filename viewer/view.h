#pragma once

#include <vtkRenderWindow.h>
#include <vtkSmartPointer.h>

#include <array>
#include <filesystem>
#include <functional>
#include <string>

#include "viewer/cloud.h"
#include "viewer/coloring.h"

namespace railcast {

/// From where --camera looks: "driver" from the sensor, "chase" from above and behind it, both
/// forward (+x); "side" from the right; "top" from above, forward up.
inline constexpr std::array<const char*, 4> kCameras = {"driver", "side", "top", "chase"};

struct ViewSpec {
  std::array<int, 2> size_px{1280, 720};  ///< Width, height.
  std::string camera = "chase";           ///< One of kCameras.
  std::string caption;                    ///< Shown in a corner.
};

/// A window with the cloud, its legend or scale and its caption, not yet shown.
[[nodiscard]] vtkSmartPointer<vtkRenderWindow> MakeView(const Cloud& cloud,
                                                        const Coloring& coloring,
                                                        const ViewSpec& spec);

/// Puts another cloud, legend and caption into a window of MakeView. The camera stays.
void ReplaceCloud(vtkRenderWindow& window,
                  const Cloud& cloud,
                  const Coloring& coloring,
                  const ViewSpec& spec);

/// Renders out of sight and writes a PNG.
/// @throws InputError if the file cannot be written.
void WriteScreenshot(vtkRenderWindow& window, const std::filesystem::path& file);

/// Shows the window until the user closes it.
void ShowWindow(vtkRenderWindow& window);

/// Likewise, and calls `update` some 30 times a second; draws anew where it says that it changed
/// the window.
/// @throws What `update` throws; the window is closed then.
void ShowWindow(vtkRenderWindow& window, const std::function<bool()>& update);

/// A connection to the X server, to be held for as long as anything is drawn: VTK ends the process
/// where there is no server, and a server that loses its last client may be away for a moment.
class DisplayConnection {
 public:
  /// @throws InputError if there is no display.
  DisplayConnection();
  ~DisplayConnection();
  DisplayConnection(const DisplayConnection&) = delete;
  DisplayConnection& operator=(const DisplayConnection&) = delete;

 private:
  void* display_;
};

}  // namespace railcast
