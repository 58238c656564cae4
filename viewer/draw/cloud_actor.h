#pragma once

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkUnsignedCharArray.h>

#include <memory>

#include "viewer/draw/look.h"
#include "viewer/scene/scene.h"

namespace railcast {

/// Points of one cloud in a renderer. Kept from frame to frame: setting up anew costs more than the
/// points.
class CloudActor {
 public:
  CloudActor();
  /// @param look Faint points are nearly its background.
  void Show(const PlacedCloud& cloud, const Look& look);
  [[nodiscard]] vtkActor& actor() { return *actor_; }

 private:
  std::shared_ptr<const ShownFrame> shown_;  ///< Whose positions VTK reads.
  std::vector<Rgb> colors_;                  ///< That VTK reads.
  vtkNew<vtkFloatArray> positions_;
  vtkNew<vtkUnsignedCharArray> rgb_;
  vtkNew<vtkCellArray> vertices_;
  vtkNew<vtkPolyData> data_;
  vtkNew<vtkPolyDataMapper> mapper_;
  vtkNew<vtkMatrix4x4> matrix_;
  vtkNew<vtkActor> actor_;
};

}  // namespace railcast
