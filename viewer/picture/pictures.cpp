#include "viewer/picture/pictures.h"

#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <array>
#include <cstdio>
#include <system_error>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/write_file.h"

namespace railcast {

void WritePicture(vtkRenderWindow& window, const std::filesystem::path& file) {
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(&window);
  image->ReadFrontBufferOff();
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(image->GetOutputPort());
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* const bytes = writer->GetResult();
  const auto size = static_cast<std::size_t>(bytes->GetNumberOfTuples());
  WriteNamedFile(file, {reinterpret_cast<const char*>(bytes->GetPointer(0)), size});
}

PictureFolder::PictureFolder(const std::filesystem::path& directory) : directory_(directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw FileError(directory, error.value());
  if (!std::filesystem::is_empty(directory, error) || error) {
    throw InputError(ShownPath(directory) + ": must be empty or not be there yet");
  }
}

void PictureFolder::Add(vtkRenderWindow& window) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06zu.png", num_pictures_);
  WritePicture(window, directory_ / name.data());
  ++num_pictures_;
}

}  // namespace railcast
