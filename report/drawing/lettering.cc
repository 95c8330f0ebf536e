#include "report/drawing/lettering.h"

#include <pango/pangocairo.h>

namespace vibrissa::report {
namespace {

/// Widths must not depend on the picture's resolution.
PangoContext* make_context() {
  PangoContext* const context = pango_font_map_create_context(pango_cairo_font_map_get_default());
  cairo_font_options_t* const options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  pango_cairo_context_set_font_options(context, options);
  cairo_font_options_destroy(options);
  return context;
}

}  // namespace

void EndOfLayout::operator()(PangoLayout* const layout) const {
  g_object_unref(layout);
}

std::unique_ptr<PangoLayout, EndOfLayout> text_layout(const std::string& text, const int size,
                                                      const bool bold) {
  static PangoContext* const context = make_context();
  std::unique_ptr<PangoLayout, EndOfLayout> layout(pango_layout_new(context));
  PangoFontDescription* const font = pango_font_description_from_string("DejaVu Sans");
  pango_font_description_set_absolute_size(font, static_cast<double>(size) * PANGO_SCALE);
  if (bold) pango_font_description_set_weight(font, PANGO_WEIGHT_BOLD);
  pango_layout_set_font_description(layout.get(), font);
  pango_font_description_free(font);
  pango_layout_set_text(layout.get(), text.data(), static_cast<int>(text.size()));
  return layout;
}

double text_width(const std::string& text, const int size, const bool bold) {
  int width = 0, height = 0;
  pango_layout_get_size(text_layout(text, size, bold).get(), &width, &height);
  return static_cast<double>(width) / PANGO_SCALE;
}

}  // namespace vibrissa::report
