#include "report/drawing/picture_file.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

#include <cassert>
#include <memory>

#include "report/text/html_text.h"
#include "signals/base/error.h"
#include "signals/system/output_file.h"

namespace vibrissa::report {
namespace {

struct EndOfSurface {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
using Surface = std::unique_ptr<cairo_surface_t, EndOfSurface>;

cairo_status_t append(void* const bytes, const unsigned char* const data,
                      const unsigned int length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

void paint(cairo_surface_t* const surface, const Picture& picture) {
  const std::unique_ptr<cairo_t, void (*)(cairo_t*)> context(cairo_create(surface), cairo_destroy);
  Canvas canvas(*context, picture.width, picture.height);
  picture.paint(canvas);
  if (cairo_status(context.get()) != CAIRO_STATUS_SUCCESS)
    throw signals::ResourceError(std::string("a picture cannot be painted: ") +
                                 cairo_status_to_string(cairo_status(context.get())));
}

std::string png_of(const Picture& picture) {
  const Surface surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.width, picture.height));
  paint(surface.get(), picture);
  std::string bytes;
  cairo_surface_write_to_png_stream(surface.get(), append, &bytes);
  return bytes;
}

std::string pdf_of(const Picture& picture) {
  std::string bytes;
  const Surface surface(
      cairo_pdf_surface_create_for_stream(append, &bytes, picture.width, picture.height));
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, picture.title.c_str());
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_SUBJECT,
                                 picture.caption.c_str());
  paint(surface.get(), picture);
  cairo_surface_finish(surface.get());
  return bytes;
}

/// Cairo has no words for title and caption of an SVG file: they become its first elements.
std::string svg_of(const Picture& picture) {
  std::string bytes;
  const Surface surface(
      cairo_svg_surface_create_for_stream(append, &bytes, picture.width, picture.height));
  cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_PX);
  paint(surface.get(), picture);
  cairo_surface_finish(surface.get());
  const std::size_t begin = bytes.find('>', bytes.find("<svg"));
  assert(begin != std::string::npos);
  bytes.insert(begin + 1,
               "\n" + html_element("title", picture.title) + html_element("desc", picture.caption));
  return bytes;
}

}  // namespace

void write_picture(const Picture& picture, const std::filesystem::path& file) {
  const std::string bytes = file.extension() == ".png"   ? png_of(picture)
                            : file.extension() == ".pdf" ? pdf_of(picture)
                                                         : svg_of(picture);
  signals::write_file(file, [&](std::ostream& out) { out << bytes; });
}

}  // namespace vibrissa::report
