#include "signals/base/unit.h"

#include <udunits2.h>

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>

#include "signals/base/decimal_point.h"
#include "signals/base/error.h"
#include "signals/base/lower_case.h"

namespace vibrissa::signals {
namespace {

struct Free {
  void operator()(ut_system* system) const { ut_free_system(system); }
  void operator()(ut_unit* unit) const { ut_free(unit); }
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
using Unit = std::unique_ptr<ut_unit, Free>;
using Words = std::map<std::string, std::string>;

ut_system* unit_system() {
  static const std::unique_ptr<ut_system, Free> system = [] {
    ut_set_error_message_handler(ut_ignore);
    std::unique_ptr<ut_system, Free> read(ut_read_xml(nullptr));
    if (!read)
      throw std::runtime_error(
          "the unit tables of UDUNITS-2 are missing; install the package libudunits2-data");
    return read;
  }();
  return system.get();
}

// Usual spellings that UDUNITS reads with another meaning or not at all.
const Words& usual_words() {
  static const Words words{{"Nm", "(N.m)"},     {"mNm", "(mN.m)"},     {"uNm", "(uN.m)"},
                           {"Nmm", "(N.mm)"},   {"mNmm", "(mN.mm)"},   {"uNmm", "(uN.mm)"},
                           {"mps", "(m/s)"},    {"mmps", "(mm/s)"},    {"radps", "(rad/s)"},
                           {"mph", "(mile/h)"}, {"dps", "(degree/s)"}, {"deg", "degree"},
                           {"sec", "s"},        {"secs", "s"},         {"msec", "ms"},
                           {"usec", "us"},      {"kmh", "(km/h)"},     {"kph", "(km/h)"}};
  return words;
}

const Words& gravity_words() {
  static const Words words = [] {
    Words all = usual_words();
    all["g"] = all["gn"] = "(9.80665 m.s-2)";
    all["mg"] = "(9.80665e-3 m.s-2)";
    all["ug"] = "(9.80665e-6 m.s-2)";
    all["G"] = all["g"];
    return all;
  }();
  return words;
}

bool is_letter(const char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (c & 0x80) != 0;
}

std::string replaced(const std::string& text, const Words& words) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at;
    while (end < text.size() && is_letter(text[end])) ++end;
    if (end == at) {
      result += text[at++];
      continue;
    }
    const std::string word = text.substr(at, end - at);
    const auto found = words.find(word);
    result += found == words.end() ? word : found->second;
    at = end;
  }
  return result;
}

Unit parse(const std::string& text) {
  Unit unit(ut_parse(unit_system(), text.c_str(), UT_UTF8));
  // "Volts" and "Newtons".
  if (!unit && text.size() > 3)
    unit.reset(ut_parse(unit_system(), lower_case(text).c_str(), UT_UTF8));
  return unit;
}

// UDUNITS has global state.
std::mutex& alone() {
  static std::mutex mutex;
  return mutex;
}

std::unique_ptr<cv_converter, Free> converter(const Unit& from, const Unit& to) {
  if (!from || !to || !ut_are_convertible(from.get(), to.get())) return nullptr;
  return std::unique_ptr<cv_converter, Free>(ut_get_converter(from.get(), to.get()));
}

}  // namespace

bool is_unit(const std::string& text) {
  constexpr std::size_t longest = 30;
  const bool has_letter =
      std::any_of(text.begin(), text.end(), [](const char c) { return is_letter(c) || c == '%'; });
  if (!has_letter || text.size() > longest) return false;
  const std::lock_guard lock(alone());
  const DecimalPoint in_its_tables;
  return parse(replaced(text, gravity_words())) != nullptr;
}

UnitConversion convert_unit(const std::string& from, const std::string& to) {
  const std::lock_guard lock(alone());
  const DecimalPoint in_its_tables;
  const Unit target = parse(replaced(to, usual_words()));
  const Unit plain = parse(replaced(from, usual_words()));
  if (!target || !plain)
    throw UnitError("unit '" + (target ? from : to) +
                    "' is not known; write it as in m/s2, g, mN mm, uT, V, km/h or N m/T");
  auto found = converter(plain, target);
  if (!found) found = converter(parse(replaced(from, gravity_words())), target);
  if (!found)
    throw UnitError("'" + from + "' cannot be converted to '" + to +
                    "': the units measure different quantities");
  const double offset = cv_convert_double(found.get(), 0.);
  return {cv_convert_double(found.get(), 1.) - offset, offset};
}

}  // namespace vibrissa::signals
