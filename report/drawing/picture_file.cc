#include "report/drawing/picture_file.h"

#include <vtkImageShrink3D.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindow.h>
#include <vtkSVGExporter.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <fstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "signals/base/error.h"
#include "signals/system/output_file.h"

namespace vibrissa::report {
namespace {

/// The line without an attribute, whose name begins with a space.
std::string without(std::string line, const std::string& attribute) {
  const std::size_t start = line.find(attribute);
  if (start == std::string::npos) return line;
  const std::size_t value = line.find('"', start), end = line.find('"', value + 1);
  return line.erase(start, end - start + 1);
}

/// Corrects the exporter's output: removes clip paths, which hide whole curves in some viewers
/// (everything is clipped already), and outlines that consist of dashes of zero length.
std::string updated(const std::string& line) {
  const std::string no_outline = " stroke-dasharray=\"0,10\"";
  const std::string unclipped = without(line, " clip-path=");
  if (unclipped.find(no_outline) == std::string::npos) return unclipped;
  std::string plain = unclipped;
  for (const char* attribute :
       {" stroke-dasharray=", " stroke-width=", " stroke-opacity=", " stroke="})
    plain = without(plain, attribute);
  return plain;
}

/// A temporary file that is removed at the end.
class PassingFile {
 public:
  explicit PassingFile(std::filesystem::path file) : file_(std::move(file)) {}
  ~PassingFile() {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
  }
  PassingFile(const PassingFile&) = delete;
  PassingFile& operator=(const PassingFile&) = delete;

  const std::filesystem::path& path() const { return file_; }

 private:
  std::filesystem::path file_;
};

}  // namespace

OpenDisplay::OpenDisplay() : window_(vtkSmartPointer<vtkRenderWindow>::New()) {
  prepare_offscreen(*window_, 1, 1);
  window_->Render();
}

OpenDisplay::~OpenDisplay() = default;

void prepare_offscreen(vtkRenderWindow& window, const int width, const int height) {
  window.SetOffScreenRendering(1);
  window.SetDPI(72);
  window.SetMultiSamples(0);
  window.SetSize(width, height);
}

void write_png(vtkRenderWindow& window, const std::filesystem::path& file) {
  window.Render();
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(&window);
  image->ReadFrontBufferOff();
  image->SetInputBufferTypeToRGB();
  vtkNew<vtkImageShrink3D> smaller;
  smaller->SetInputConnection(image->GetOutputPort());
  smaller->SetShrinkFactors(oversampling, oversampling, 1);
  smaller->AveragingOn();
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(smaller->GetOutputPort());
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  signals::write_file(file, [&](std::ostream& out) {
    out.write(reinterpret_cast<const char*>(bytes->GetPointer(0)), bytes->GetNumberOfValues());
  });
}

void write_svg(vtkRenderWindow& window, const std::filesystem::path& file, const std::string& title,
               const std::string& caption) {
  // The exporter writes only files and does not report failure.
  const PassingFile raw(file.string() + ".raw");
  vtkNew<vtkSVGExporter> exporter;
  exporter->SetRenderWindow(&window);
  exporter->SetFileName(raw.path().c_str());
  exporter->SetTitle(title.c_str());
  exporter->SetDescription(caption.c_str());
  exporter->Write();
  std::vector<std::string> lines;
  std::ifstream in(raw.path());
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  if (lines.empty() || lines.back() != "</svg>")
    throw signals::ResourceError(file.string() +
                                 ": the file cannot be written; check whether the disk is full");
  signals::write_file(file, [&](std::ostream& out) {
    for (const std::string& line : lines) out << updated(line) << '\n';
  });
}

}  // namespace vibrissa::report
