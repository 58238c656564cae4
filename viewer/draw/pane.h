#pragma once

#include <vtkNew.h>
#include <vtkProp.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/composition/coloring.h"
#include "viewer/composition/composition.h"
#include "viewer/draw/actors.h"
#include "viewer/draw/look.h"
#include "viewer/frames/camera_picture.h"

namespace railcast {

/// The legend of a view: a list of categories in the upper left corner, or a scale at the right
/// edge.
struct Legend {
  std::vector<vtkSmartPointer<vtkProp>> props;
  /// The line of one category, for clicks: from the left edge to right_px, in pixels from the
  /// view's lower left corner.
  struct Line {
    double value{};
    double bottom_px{};
    double top_px{};
    double right_px{};
  };
  std::vector<Line> lines;

  /// Returns the line at a place.
  /// @param place_px In the view, from its lower left corner.
  [[nodiscard]] std::optional<Line> LineAt(const std::array<double, 2>& place_px) const;
};

/// Makes a legend. It lists at most 24 categories, those with the most points; a last line counts
/// the others.
/// @param size_px Size of the view.
/// @param beam_kinds Categories of empty beams, listed below those of the points.
[[nodiscard]] Legend MakeLegend(const Coloring& coloring,
                                const std::vector<Category>& beam_kinds,
                                const std::array<int, 2>& size_px,
                                const Background& background);

/// A camera's image in the upper right corner of a view, with its title below.
struct Inset {
  std::vector<vtkSmartPointer<vtkProp>> props;
  /// The image's lower left and upper right corner, in pixels from the view's lower left one.
  std::array<double, 2> from_px{};
  std::array<double, 2> to_px{};

  [[nodiscard]] bool Holds(const std::array<double, 2>& place_px) const {
    return place_px[0] >= from_px[0] && place_px[0] < to_px[0] && place_px[1] >= from_px[1] &&
           place_px[1] < to_px[1];
  }
};

/// Makes an inset that takes up to two fifths of the view's width and height.
/// @param size_px Size of the view.
/// @param has_scale Whether room is left for the legend's scale at the right edge.
[[nodiscard]] Inset MakeInset(const CameraPicture& picture,
                              const std::array<int, 2>& size_px,
                              bool has_scale,
                              const Background& background);

/// One composition in a part of a window.
class Pane {
 public:
  /// @param left, right The part of the window's width that it takes, in [0, 1].
  Pane(double left, double right);

  /// Replaces what is shown; the camera stays.
  /// @param window_px Size of the whole window.
  void Show(std::shared_ptr<const Composition> composition,
            const Look& look,
            const std::array<int, 2>& window_px);
  /// Shows lines of text in the lower left corner.
  void ShowStatus(const std::string& status, const Look& look);
  /// Draws marks over the composition: picked points, a measured line.
  void ShowMarks(const Overlay& marks, const Look& look);

  [[nodiscard]] const std::shared_ptr<const Composition>& shared_composition() const {
    return composition_;
  }
  [[nodiscard]] const Composition& composition() const { return *composition_; }
  [[nodiscard]] vtkRenderer& renderer() { return *renderer_; }
  /// Whether a place is covered by the camera's image.
  /// @param place_px In the view, from its lower left corner.
  [[nodiscard]] bool IsInInset(const std::array<double, 2>& place_px) const {
    return inset_.Holds(place_px);
  }
  [[nodiscard]] const Legend& legend() const { return legend_; }
  [[nodiscard]] bool Contains(double x_share) const { return x_share >= left_ && x_share < right_; }
  /// Returns the view's size in pixels.
  [[nodiscard]] std::array<int, 2> SizeIn(const std::array<int, 2>& window_px) const;
  [[nodiscard]] double left() const { return left_; }

 private:
  void ShowClouds(const Look& look);
  void ShowSurfaces();

  double left_, right_;
  std::shared_ptr<const Composition> composition_;
  vtkNew<vtkRenderer> renderer_;
  std::vector<std::unique_ptr<CloudActor>> clouds_;
  Legend legend_;
  Inset inset_;
  std::vector<vtkSmartPointer<vtkProp>> fleeting_;  ///< Props made anew for each composition.
  vtkSmartPointer<vtkProp> status_;
  std::vector<vtkSmartPointer<vtkProp>> marks_;
  /// Surfaces that stay from one composition to the next are kept, and only their transform
  /// changes.
  std::map<std::shared_ptr<const std::vector<Part>>, std::vector<vtkSmartPointer<vtkActor>>>
      surfaces_;
  int height_px_{};
};

}  // namespace railcast
