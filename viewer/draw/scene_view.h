#pragma once

#include <vtkNew.h>
#include <vtkProp.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "viewer/draw/cloud_actor.h"
#include "viewer/draw/legend.h"
#include "viewer/draw/look.h"
#include "viewer/scene/scene.h"

namespace railcast {

/// One scene in a part of a window.
class SceneView {
 public:
  /// @param left, right Its part of the window's width, in [0, 1].
  SceneView(double left, double right);

  /// Replaces what is shown. The camera stays.
  /// @param window_px Size of the whole window.
  void Show(std::shared_ptr<const Scene> scene,
            const Look& look,
            const std::array<int, 2>& window_px);
  /// Lines for people at the left foot.
  void ShowStatus(const std::string& status, const Look& look);
  /// Draws marks over the scene: picked points, a measured line.
  void ShowMarks(const Drawing& marks, const Look& look);

  [[nodiscard]] const std::shared_ptr<const Scene>& shared_scene() const { return scene_; }
  [[nodiscard]] const Scene& scene() const { return *scene_; }
  [[nodiscard]] vtkRenderer& renderer() { return *renderer_; }
  [[nodiscard]] const Legend& legend() const { return legend_; }
  [[nodiscard]] bool Contains(double x_share) const { return x_share >= left_ && x_share < right_; }
  /// In pixels.
  [[nodiscard]] std::array<int, 2> SizeIn(const std::array<int, 2>& window_px) const;
  [[nodiscard]] double left() const { return left_; }

 private:
  void ShowClouds(const Look& look);
  void ShowSurfaces();

  double left_, right_;
  std::shared_ptr<const Scene> scene_;
  vtkNew<vtkRenderer> renderer_;
  std::vector<std::unique_ptr<CloudActor>> clouds_;
  Legend legend_;
  std::vector<vtkSmartPointer<vtkProp>> fleeting_;  ///< Made anew with each scene.
  vtkSmartPointer<vtkProp> status_;
  std::vector<vtkSmartPointer<vtkProp>> marks_;
  /// Of surfaces that stay from scene to scene only their place changes.
  std::map<std::shared_ptr<const std::vector<Part>>, std::vector<vtkSmartPointer<vtkActor>>>
      surfaces_;
  int height_px_{};
};

}  // namespace railcast
