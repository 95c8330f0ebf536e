#include "report/figures/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <optional>

namespace vibrissa::report {
namespace {

Table modes() {
  Table table({{"mode", ""}, {"frequency", "Hz", 4}, {"kind", ""}});
  table.add_row({1, 37.3, "bending, x"});
  table.add_row({std::size_t{2}, 147.123456789, "torsion"});
  table.add_row({3, Cell(), "a|b"});
  return table;
}

TEST(Table, CsvKeepsAllDigitsAndQuotes) {
  EXPECT_EQ(modes().to_csv(),
            "mode,frequency [Hz],kind\n"
            "1,37.3,\"bending, x\"\n"
            "2,147.123456789,torsion\n"
            "3,,a|b\n");
}

TEST(Cell, OfANumberThatMayBeMissingIsTheNumberOrNothing) {
  EXPECT_EQ(Cell(std::optional(0.25)).exact(), "0.25");
  EXPECT_EQ(Cell(std::optional<double>()).exact(), "");
  EXPECT_EQ(Cell(std::optional<double>()).rounded(3), "-");
}

TEST(Table, MarkdownRoundsAlignsAndEscapes) {
  EXPECT_EQ(modes().to_markdown(),
            "| mode | frequency [Hz] | kind |\n"
            "|---:|---:|---|\n"
            "| 1 | 37.3 | bending, x |\n"
            "| 2 | 147.1 | torsion |\n"
            "| 3 | - | a\\|b |\n");
}

TEST(Table, TextHasAlignedColumnsAndNoTrailingBlanks) {
  EXPECT_EQ(modes().to_text(),
            "mode  frequency [Hz]  kind\n"
            "----  --------------  ----------\n"
            "   1            37.3  bending, x\n"
            "   2           147.1  torsion\n"
            "   3               -  a|b\n");
}

TEST(Table, TextAlignsByCharactersNotBytes) {
  Table table({{"\u00b5", "\u00b0"}, {"n", ""}});
  table.add_row({"\u00b5\u00b5\u00b5\u00b5\u00b5\u00b5", 1});
  EXPECT_EQ(table.to_text(),
            "\u00b5 [\u00b0]     n\n"
            "------  ---\n"
            "\u00b5\u00b5\u00b5\u00b5\u00b5\u00b5    1\n");
}

TEST(Table, TellsNotKnownFromNaNInCsvAlone) {
  Table table({{"a", ""}, {"b", ""}});
  table.add_row({std::nan(""), Cell()});
  EXPECT_EQ(table.to_csv(), "a,b\nnan,\n");
  EXPECT_EQ(table.to_markdown(), "| a | b |\n|---:|---:|\n| - | - |\n");
}

TEST(Table, WithoutRowsStillHasItsHeading) {
  const Table table(std::vector<Column>{{"name", "m"}});
  EXPECT_EQ(table.n_rows(), 0u);
  EXPECT_EQ(table.to_csv(), "name [m]\n");
  EXPECT_EQ(table.to_text(), "name [m]\n--------\n");
}

TEST(Table, HtmlEscapesTextNamesItsColumnsAndMarksNumbers) {
  Table table({{"record", ""}, {"error <b>", "%", 3}});
  table.add_row({"<script>", 1. / 3.});
  EXPECT_EQ(table.to_html("Errors & more"),
            "<table><caption>Errors &amp; more</caption>\n<thead><tr><th scope=\"col\">record</th>"
            "<th scope=\"col\" class=\"number\">error &lt;b&gt; [%]</th></tr></thead>\n<tbody>\n"
            "<tr><td>&lt;script&gt;</td><td class=\"number\">0.333</td></tr>\n"
            "</tbody></table>\n");
}

}  // namespace
}  // namespace vibrissa::report
