#include "report/picture_file.h"

#include <vtkErrorCode.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindow.h>
#include <vtkSVGExporter.h>
#include <vtkWindowToImageFilter.h>

#include <functional>
#include <system_error>

#include "signals/error.h"

namespace vibrissa::report {
namespace {

/// Lets write() make a file beside the wanted one and renames that.
void write_whole(const std::filesystem::path& file,
                 const std::function<void(const std::string&)>& write) {
  const std::filesystem::path part = file.string() + ".part";
  std::error_code error;
  std::filesystem::remove(part, error);
  write(part.string());
  if (!std::filesystem::exists(part) || std::filesystem::file_size(part, error) == 0)
    throw signals::UserError(file.string() + ": the picture cannot be written");
  std::filesystem::rename(part, file, error);
  if (error) throw signals::UserError(file.string() + ": " + error.message());
}

}  // namespace

void prepare_offscreen(vtkRenderWindow& window, const int width, const int height) {
  constexpr int samples_per_pixel = 8;
  window.SetOffScreenRendering(1);
  window.SetDPI(72);
  window.SetMultiSamples(samples_per_pixel);
  window.SetSize(width, height);
}

void write_png(vtkRenderWindow& window, const std::filesystem::path& file) {
  window.Render();
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(&window);
  image->ReadFrontBufferOff();
  image->SetInputBufferTypeToRGB();
  write_whole(file, [&](const std::string& part) {
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputConnection(image->GetOutputPort());
    writer->SetFileName(part.c_str());
    writer->Write();
    if (writer->GetErrorCode() != vtkErrorCode::NoError)
      throw signals::UserError(file.string() + ": " +
                               vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode()));
  });
}

void write_svg(vtkRenderWindow& window, const std::filesystem::path& file, const std::string& title,
               const std::string& caption) {
  write_whole(file, [&](const std::string& part) {
    vtkNew<vtkSVGExporter> exporter;
    exporter->SetRenderWindow(&window);
    exporter->SetFileName(part.c_str());
    exporter->SetTitle(title.c_str());
    exporter->SetDescription(caption.c_str());
    exporter->Write();
  });
}

}  // namespace vibrissa::report
