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

#include "viewer/composition/composition.h"
#include "viewer/draw/look.h"

namespace railcast {

/// The points of one cloud in a renderer. It is kept from frame to frame, because setting it up
/// costs more than drawing the points.
class CloudActor {
 public:
  CloudActor();
  /// @param look Its background colour is mixed into faint points.
  void Show(const PlacedCloud& cloud, const Look& look);
  [[nodiscard]] vtkActor& actor() { return *actor_; }

 private:
  std::shared_ptr<const ShownFrame> shown_;  ///< Holds the positions that VTK reads.
  std::vector<Rgb> colors_;                  ///< Holds the colours that VTK reads.
  vtkNew<vtkFloatArray> positions_;
  vtkNew<vtkUnsignedCharArray> rgb_;
  vtkNew<vtkCellArray> vertices_;
  vtkNew<vtkPolyData> data_;
  vtkNew<vtkPolyDataMapper> mapper_;
  vtkNew<vtkMatrix4x4> matrix_;
  vtkNew<vtkActor> actor_;
};

}  // namespace railcast
