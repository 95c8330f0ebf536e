// Tables as loggers and spreadsheets write them: every one is read alike, or refused as ambiguous.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "signals/base/error.h"
#include "signals/files/record_io.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals {
namespace {

constexpr std::size_t table_rows = 400;
constexpr double table_rate_hz = 500.;

enum class Header { none, names, metadata_and_names, names_in_comment };
enum class Units { none, in_names, in_a_line };
enum class Stamps { seconds, milliseconds, iso, epoch, rate_in_comment };
enum class Coding { utf_8, with_mark, latin_1, utf_16 };

struct Layout {
  char separator = ',', decimal = '.';
  Header header = Header::names;
  Units units = Units::none;
  Stamps stamps = Stamps::seconds;
  Coding coding = Coding::utf_8;
  bool quoted = false, crlf = false, remark_column = false, blank_lines = false, trailing = false;
};

// The response of an oscillator of 31 Hz to noise.
struct Truth {
  std::vector<double> acceleration, moment;
};

Truth oscillator() {
  std::mt19937_64 random(11);
  std::normal_distribution<> normal;
  Truth truth;
  const double w = 2. * std::numbers::pi * 31., zeta = 0.03, dt = 1. / table_rate_hz;
  double x = 0., v = 0.;
  for (std::size_t i = 0; i < table_rows; ++i) {
    const double a = normal(random);
    for (int step = 0; step < 20; ++step) {
      v += dt / 20. * (-a - 2. * zeta * w * v - w * w * x);
      x += dt / 20. * v;
    }
    // As printed, to six digits.
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.6g", a);
    truth.acceleration.push_back(std::stod(text.data()));
    std::snprintf(text.data(), text.size(), "%.6g", 1e3 * w * w * x * 2e-3);
    truth.moment.push_back(std::stod(text.data()));
  }
  return truth;
}

class TableWriter {
 public:
  explicit TableWriter(const Layout& layout) : layout_(layout) {}

  std::string text(const Truth& truth) {
    write_head();
    for (std::size_t i = 0; i < table_rows; ++i) {
      if (layout_.blank_lines && i == 150) line("");
      if (layout_.blank_lines && i == 151) line("# paused here");
      std::vector<std::string> fields;
      if (has_time()) fields.push_back(time(i));
      fields.push_back(number(truth.acceleration[i]));
      fields.push_back(number(truth.moment[i]));
      row(fields, i % 7 == 0 ? "ok" : "a b");
    }
    return coded();
  }
  bool has_time() const { return layout_.stamps != Stamps::rate_in_comment; }

 private:
  void line(const std::string& text) { text_ += text + (layout_.crlf ? "\r\n" : "\n"); }

  void row(const std::vector<std::string>& fields, const std::string& remark) {
    std::string text;
    for (const std::string& field : fields)
      text += (text.empty() ? "" : std::string(1, layout_.separator)) +
              (layout_.quoted ? "\"" + field + "\"" : field);
    if (layout_.remark_column) text += std::string(1, layout_.separator) + "\"" + remark + "\"";
    if (layout_.trailing && layout_.separator != ' ') text += layout_.separator;
    line(text);
  }

  void write_head() {
    if (layout_.header == Header::metadata_and_names) {
      line("Device: Logger 7 (M\u00fcnchen)");
      line("Started by: nobody, 2024-01-02");
      line("");
    }
    if (layout_.stamps == Stamps::rate_in_comment) line("# Sampling rate: 500 Hz, filter 200 Hz");
    if (layout_.header == Header::none) return;
    const bool in_names = layout_.units == Units::in_names;
    const std::string time_name = layout_.stamps == Stamps::milliseconds ? "t_ms" : "t";
    std::vector<std::string> names;
    if (has_time()) names.push_back(time_name);
    // A blank within a name would separate where blanks do.
    names.push_back(in_names ? "ax[m/s2]" : "ax");
    names.push_back(in_names ? "M\u00fc[mN.m]" : "M\u00fc");
    if (layout_.header == Header::names_in_comment) text_ += "# ";
    row(names, "remark");
    if (layout_.units != Units::in_a_line) return;
    std::vector<std::string> units;
    if (has_time()) units.push_back(layout_.stamps == Stamps::milliseconds ? "ms" : "s");
    units.push_back("m/s2");
    units.push_back("mN.m");
    row(units, "-");
  }

  std::string number(const double value) const {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.6g", value);
    std::string result = text.data();
    if (layout_.decimal == ',') std::replace(result.begin(), result.end(), '.', ',');
    return result;
  }

  std::string time(const std::size_t i) const {
    std::array<char, 60> text{};
    const double ms = 2. * double(i);
    if (layout_.stamps == Stamps::milliseconds) return std::to_string(2 * i);
    if (layout_.stamps == Stamps::iso) {
      std::snprintf(text.data(), text.size(), "2024-01-02T10:11:%06.3f", 12. + ms / 1000.);
      return text.data();
    }
    if (layout_.stamps == Stamps::epoch) {
      std::snprintf(text.data(), text.size(), "%.3f", 1704190272. + ms / 1000.);
      std::string result = text.data();
      if (layout_.decimal == ',') std::replace(result.begin(), result.end(), '.', ',');
      return result;
    }
    return number(ms / 1000.);
  }

  std::string coded() const {
    if (layout_.coding == Coding::with_mark) return "\xEF\xBB\xBF" + text_;
    if (layout_.coding == Coding::utf_8) return text_;
    std::string coded = layout_.coding == Coding::utf_16 ? "\xFF\xFE" : "";
    for (std::size_t i = 0; i < text_.size(); ++i) {
      // The only other character is U+00FC.
      const bool is_umlaut = text_[i] == '\xC3';
      coded += is_umlaut ? '\xFC' : text_[i];
      i += is_umlaut;
      if (layout_.coding == Coding::utf_16) coded += '\0';
    }
    return coded;
  }

  Layout layout_;
  std::string text_;
};

template <typename T>
T any_of(std::mt19937_64& random, const std::vector<T>& all) {
  return all[random() % all.size()];
}

Layout any_layout(std::mt19937_64& random) {
  Layout layout;
  layout.separator = any_of<char>(random, {',', ';', '\t', ' '});
  layout.decimal = any_of<char>(random, {'.', ','});
  layout.header = any_of<Header>(
      random, {Header::none, Header::names, Header::metadata_and_names, Header::names_in_comment});
  layout.units = any_of<Units>(random, {Units::none, Units::in_names, Units::in_a_line});
  layout.stamps = any_of<Stamps>(random, {Stamps::seconds, Stamps::milliseconds, Stamps::iso,
                                          Stamps::epoch, Stamps::rate_in_comment});
  layout.coding =
      any_of<Coding>(random, {Coding::utf_8, Coding::with_mark, Coding::latin_1, Coding::utf_16});
  layout.quoted = random() % 4 == 0;
  layout.crlf = random() % 2 == 0;
  layout.remark_column = random() % 3 == 0;
  layout.blank_lines = random() % 3 == 0;
  layout.trailing = random() % 4 == 0;
  if (layout.header == Header::none) layout.units = Units::none;
  return layout;
}

std::string described(const Layout& layout, const std::string& text) {
  std::string name = "separator '" + std::string(1, layout.separator) + "' decimal '" +
                     layout.decimal + "' header " + std::to_string(int(layout.header)) + " units " +
                     std::to_string(int(layout.units)) + " stamps " +
                     std::to_string(int(layout.stamps)) + " coding " +
                     std::to_string(int(layout.coding));
  return name + "\n" + (layout.coding == Coding::utf_16 ? "" : text.substr(0, 250));
}

std::vector<ColumnChoice> choices(const Layout& layout, const bool has_time) {
  const bool has_names = layout.header != Header::none;
  const auto column = [&](const int n) { return "column_" + std::to_string(n + has_time); };
  const std::string moment_unit = layout.units == Units::none ? "[mN.m]" : "";
  std::vector<ColumnChoice> all{
      parse_column_choice("base_acceleration=" + (has_names ? "ax" : column(1))),
      parse_column_choice("base_moment=" + (has_names ? "M\u00fc" : column(2)) + moment_unit)};
  if (has_time && !has_names)
    all.push_back(parse_column_choice(layout.stamps == Stamps::milliseconds ? "time=column_1[ms]"
                                                                            : "time=column_1"));
  return all;
}

TEST(TextLayouts, TwoHundredTablesAreReadAlikeOrRefusedAsAmbiguous) {
  const Truth truth = oscillator();
  const test::TemporaryFolder folder;
  std::mt19937_64 random(2024);
  std::size_t n_read = 0, n_refused = 0;
  for (int i = 0; i < 200; ++i) {
    const Layout layout = any_layout(random);
    TableWriter writer(layout);
    const std::string text = writer.text(truth);
    SCOPED_TRACE(described(layout, text));
    const bool is_ambiguous = layout.separator == ',' && layout.decimal == ',' && !layout.quoted;
    try {
      const Record record =
          read_record(folder.file("r.txt", text), {.columns = choices(layout, writer.has_time())});
      ++n_read;
      EXPECT_FALSE(is_ambiguous);
      EXPECT_NEAR(record.sampling_rate_hz(), table_rate_hz, 1e-6 * table_rate_hz);
      ASSERT_EQ(record.n_samples(), table_rows);
      const auto a = record.channel(channel::base_acceleration);
      const auto m = record.channel(channel::base_moment);
      for (std::size_t k = 0; k < table_rows; ++k) {
        ASSERT_DOUBLE_EQ(a[k], truth.acceleration[k]) << k;
        ASSERT_NEAR(m[k], 1e-3 * truth.moment[k], 1e-15) << k;
      }
    } catch (const UserError& error) {
      ++n_refused;
      EXPECT_TRUE(is_ambiguous) << error.what();
    }
  }
  RecordProperty("read", int(n_read));
  RecordProperty("refused", int(n_refused));
  EXPECT_GE(n_read, 160u);
  EXPECT_GE(n_refused, 5u) << "the generator makes ambiguous tables, too";
}

}  // namespace
}  // namespace vibrissa::signals
