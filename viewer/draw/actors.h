#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <vtkActor.h>
#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include "railcast/frame.h"
#include "railcast/scene.h"
#include "viewer/composition/composition.h"
#include "viewer/draw/look.h"
#include "viewer/overlays/overlays.h"

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

/// Makes one actor of an overlay's lines.
[[nodiscard]] vtkSmartPointer<vtkActor> MakeLines(const Overlay& drawing, double width_px);

/// Makes an overlay's words, which always face the viewer.
/// @param size_px Font size.
[[nodiscard]] std::vector<vtkSmartPointer<vtkProp>> MakeWords(const Overlay& drawing,
                                                              int size_px,
                                                              const Background& background);

/// Returns the colour, darkened if both it and the background are light.
[[nodiscard]] Rgb OnBackground(const Rgb& rgb, const Background& background);

/// Returns the overlay; its light lines and words are darkened if the background is light.
[[nodiscard]] Overlay OnBackground(Overlay drawing, const Background& background);

/// Makes a line through points in pixels of the window, or the area between them.
[[nodiscard]] vtkSmartPointer<vtkActor2D> MakeShape(const std::vector<Eigen::Vector2d>& points_px,
                                                    bool is_filled,
                                                    const Rgb& rgb);

/// Makes translucent surfaces in the colours of their labels, in the axes of the parts.
[[nodiscard]] std::vector<vtkSmartPointer<vtkActor>> MakeSurfaces(const std::vector<Part>& parts,
                                                                  const LabelTable& labels);

}  // namespace railcast
