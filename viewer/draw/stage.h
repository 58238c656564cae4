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

#include "viewer/draw/cameras.h"
#include "viewer/draw/look.h"
#include "viewer/draw/scene_view.h"
#include "viewer/scene/scene.h"

namespace railcast {

/// A window with one view, or several side by side that share a camera; on the screen or off it.
class Stage {
 public:
  /// @param size_px Width, height.
  explicit Stage(const std::array<int, 2>& size_px);

  /// Replaces all that is shown. The camera stays; the first scene places it, see UseCamera.
  void Show(std::vector<Scene> scenes, const Look& look);
  /// Draws the same scenes anew: another look, or another size of the window.
  void Redraw(const Look& look);
  /// Lines at the left foot of the first view, instead of its scene's.
  void ShowStatus(const std::string& status);
  /// Places the camera relative to the first scene's sensor: now, and anew until a scene with a
  /// cloud has been shown.
  void UseCamera(const std::string& preset);
  void UseCamera(const CameraPlace& place);
  /// Moves the camera with the world, so that what stands stays where it is on the screen.
  void MoveCamera(const Transform& new_from_old);
  /// Looks at that place from where it is, and is turned about it from then on.
  void TurnAbout(const Eigen::Vector3f& target_m);
  [[nodiscard]] CameraPlace camera_place();

  /// Marks over a view's scene.
  void ShowMarks(std::size_t view, const Drawing& marks);
  /// Words on a plate: at the right top ("facts"), below it or in the middle. Empty: none.
  enum class Plate : std::uint8_t { kFacts, kTrace, kHelp };
  void ShowPlate(Plate plate, const std::string& words);

  /// In which view a place of the window is, in pixels from its lower left corner.
  [[nodiscard]] std::size_t ViewAt(double x_px) const;
  /// The place in that view, from its own lower left corner.
  [[nodiscard]] std::array<double, 2> InView(std::size_t view, double x_px, double y_px) const;
  [[nodiscard]] SceneView& view(std::size_t index) { return *views_[index]; }
  [[nodiscard]] std::size_t num_views() const { return views_.size(); }
  [[nodiscard]] std::array<int, 2> size_px() const;
  [[nodiscard]] vtkRenderWindow& window() { return *window_; }
  /// Over all views: what belongs to the window as a whole.
  [[nodiscard]] vtkRenderer& plates_renderer() { return *plates_renderer_; }

 private:
  void SetViews(std::size_t count);
  void PlaceNow();

  vtkSmartPointer<vtkRenderWindow> window_;
  vtkSmartPointer<vtkRenderer> plates_renderer_;  ///< Over all views.
  std::vector<std::unique_ptr<SceneView>> views_;
  std::array<vtkSmartPointer<vtkTextActor>, 3> plates_;
  std::array<std::string, 3> plate_words_;
  Look look_;
  vtkSmartPointer<vtkCamera> camera_;
  std::string preset_ = "chase";
  std::optional<CameraPlace> place_;
  bool is_placed_ = false;
};

}  // namespace railcast
