#pragma once

#include <vtkRenderWindow.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/composition/composition.h"
#include "viewer/draw/cameras.h"
#include "viewer/draw/look.h"
#include "viewer/draw/pane.h"

namespace railcast {

/// A window, on or off the screen, with one view or with several side by side that share a camera.
class Stage {
 public:
  /// @param size_px Width and height.
  explicit Stage(const std::array<int, 2>& size_px);

  /// Replaces all that is shown. The camera stays, except that the first composition places it: see
  /// UseCamera().
  void Show(std::vector<Composition> compositions, const Look& look);
  /// Draws the same compositions again after a change of the look or of the window's size.
  void Redraw(const Look& look);
  /// Shows lines in the lower left corner of the first view, instead of its composition's status.
  void ShowStatus(const std::string& status);
  /// Places the camera relative to the sensor of the first composition: now, and again with every
  /// composition until one with a cloud has been shown.
  void UseCamera(const std::string& preset);
  void UseCamera(const CameraPlace& place);
  /// Moves the camera with the world, so that the standing scene stays where it is on the screen.
  void MoveCamera(const Transform& new_from_old);
  /// Turns the camera from where it is towards that place, which becomes the centre of rotation.
  void TurnAbout(const Eigen::Vector3f& target_m);
  [[nodiscard]] CameraPlace camera_place();

  /// Draws marks over a view's composition.
  void ShowMarks(std::size_t view, const Overlay& marks);
  /// Where a plate with text is: in the upper right corner, in the lower right corner, or in the
  /// middle of the window. Empty text removes the plate.
  enum class Plate : std::uint8_t { kFacts, kTrace, kHelp };
  void ShowPlate(Plate plate, const std::string& words);

  /// Returns the view at a place of the window, in pixels from its lower left corner.
  [[nodiscard]] std::size_t ViewAt(double x_px) const;
  /// Converts a place in the window to pixels from the lower left corner of that view.
  [[nodiscard]] std::array<double, 2> InView(std::size_t view, double x_px, double y_px) const;
  [[nodiscard]] Pane& view(std::size_t index) { return *views_[index]; }
  [[nodiscard]] std::size_t num_views() const { return views_.size(); }
  [[nodiscard]] std::array<int, 2> size_px() const;
  [[nodiscard]] vtkRenderWindow& window() { return *window_; }
  /// Renders above all views what belongs to the window as a whole.
  [[nodiscard]] vtkRenderer& plates_renderer() { return *plates_renderer_; }

 private:
  void SetViews(std::size_t count);
  void PlaceNow();

  vtkSmartPointer<vtkRenderWindow> window_;
  vtkSmartPointer<vtkRenderer> plates_renderer_;  ///< Drawn above all views.
  std::vector<std::unique_ptr<Pane>> views_;
  std::array<vtkSmartPointer<vtkTextActor>, 3> plates_;
  std::array<std::string, 3> plate_words_;
  Look look_;
  vtkSmartPointer<vtkCamera> camera_;
  std::string preset_ = "chase";
  std::optional<CameraPlace> place_;
  bool is_placed_ = false;
};

/// A connection to the X server, to be held for as long as anything is drawn. VTK ends the process
/// where there is no server, and a server that loses its last client may be unavailable for a
/// moment.
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
