#include <X11/Xlib.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include "core/base/error.h"
#include "core/io/write_file.h"
#include "viewer/view.h"

namespace railcast {

void WriteScreenshot(vtkRenderWindow& window, const std::filesystem::path& file) {
  window.SetOffScreenRendering(true);
  window.Render();
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(&window);
  image->ReadFrontBufferOff();
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(image->GetOutputPort());
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* const bytes = writer->GetResult();
  const auto size = static_cast<std::size_t>(bytes->GetNumberOfTuples());
  WriteFileWhole(file, {reinterpret_cast<const char*>(bytes->GetPointer(0)), size});
}

void ShowWindow(vtkRenderWindow& window) {
  vtkNew<vtkRenderWindowInteractor> interactor;
  vtkNew<vtkInteractorStyleTrackballCamera> style;
  interactor->SetInteractorStyle(style);
  interactor->SetRenderWindow(&window);
  window.Render();
  interactor->Start();
}

DisplayConnection::DisplayConnection() : display_(XOpenDisplay(nullptr)) {
  if (display_ == nullptr) {
    throw InputError(
        "no display: on a machine without one, run xvfb-run -a -s -noreset railcast-view ...");
  }
}

DisplayConnection::~DisplayConnection() {
  XCloseDisplay(static_cast<Display*>(display_));
}

}  // namespace railcast
