#include "report/text/html_text.h"

#include <nlohmann/json.hpp>

namespace vibrissa::report {
namespace {

const char* entity(const char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return nullptr;
  }
}

const char* json_escape(const char c) {
  switch (c) {
    case '<':
      return "\\u003c";
    case '>':
      return "\\u003e";
    case '&':
      return "\\u0026";
    default:
      return nullptr;
  }
}

std::string replaced(const std::string_view text, const char* (*substitute)(char)) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    if (const char* other = substitute(c))
      result += other;
    else
      result += c;
  }
  return result;
}

}  // namespace

std::string html_escaped(const std::string_view text) {
  return replaced(text, entity);
}

std::string html_element(const std::string& tag, const std::string_view text) {
  std::string html = "<";
  html.append(tag).append(">").append(html_escaped(text));
  return html.append("</").append(tag).append(">\n");
}

std::string script_json(const nlohmann::json& json) {
  return replaced(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), json_escape);
}

}  // namespace vibrissa::report
