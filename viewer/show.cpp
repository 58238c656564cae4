#include <X11/Xlib.h>
#include <vtkCallbackCommand.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <exception>
#include <functional>

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

namespace {

struct Updates {
  const std::function<bool()>& update;
  std::exception_ptr fault;  ///< No exception may pass VTK's event loop.
};

void UpdateWindow(vtkObject* caller, unsigned long, void* data, void*) {
  auto& interactor = *static_cast<vtkRenderWindowInteractor*>(caller);
  auto& updates = *static_cast<Updates*>(data);
  try {
    if (updates.update()) interactor.Render();
  } catch (...) {
    updates.fault = std::current_exception();
    interactor.TerminateApp();
  }
}

}  // namespace

void ShowWindow(vtkRenderWindow& window, const std::function<bool()>& update) {
  constexpr unsigned long kPeriod_ms = 33;
  vtkNew<vtkRenderWindowInteractor> interactor;
  vtkNew<vtkInteractorStyleTrackballCamera> style;
  interactor->SetInteractorStyle(style);
  interactor->SetRenderWindow(&window);
  interactor->Initialize();
  Updates updates{update, nullptr};
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(&UpdateWindow);
  command->SetClientData(&updates);
  interactor->AddObserver(vtkCommand::TimerEvent, command);
  interactor->CreateRepeatingTimer(kPeriod_ms);
  window.Render();
  interactor->Start();
  if (updates.fault) std::rethrow_exception(updates.fault);
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
