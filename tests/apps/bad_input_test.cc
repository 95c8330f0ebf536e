#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Checks that hold for every user error.
void expect_refusal(const ProgramResult& result, const testing::Matcher<const std::string&>& text) {
  EXPECT_EQ(result.status, 2) << result.errors;
  EXPECT_THAT(result.errors, text);
  EXPECT_THAT(result.errors, testing::Not(HasSubstr("internal error")));
  EXPECT_EQ(result.output, "");
}

std::string case_with(const std::string& section, const std::string& entry) {
  return "subsection " + section + "\n  set " + entry + "\nend\n";
}

class BadCase : public testing::Test {
 protected:
  void refuse(const std::string& text, const testing::Matcher<const std::string&>& message) {
    const std::string file = folder.write("bad.prm", text);
    expect_refusal(vibrissa("run '" + file + "' -o '" + folder.file("run") + "'" + quick), message);
    EXPECT_FALSE(std::filesystem::exists(folder.file("run"))) << "half a run was written";
  }
  Folder folder;
};

TEST_F(BadCase, UnknownEntryNamesFileLineAndKnownNames) {
  refuse(case_with("Geometry", "Wire diametre = 1e-3"),
         AllOf(HasSubstr("bad.prm:2"), HasSubstr("Wire diametre"), HasSubstr("Wire diameter"),
               HasSubstr("Free length")));
}

TEST_F(BadCase, UnknownSubsectionNamesTheKnownOnes) {
  refuse(case_with("Geometri", "Fin = none"),
         AllOf(HasSubstr("bad.prm:1"), HasSubstr("Geometri"), HasSubstr("Geometry")));
}

TEST_F(BadCase, TextInANumberNamesLineAndEntry) {
  refuse(
      case_with("Geometry", "Wire diameter = thin"),
      AllOf(HasSubstr("bad.prm"), HasSubstr("2"), HasSubstr("thin"), HasSubstr("Wire diameter")));
}

TEST_F(BadCase, NegativeDensityIsRefused) {
  refuse("subsection Materials\n  subsection Wire\n    set Density = -6450\n  end\nend\n",
         AllOf(HasSubstr("3"), HasSubstr("Density"), HasSubstr("-6450")));
}

TEST_F(BadCase, ZeroC1IsRefused) {
  refuse("subsection Materials\n  subsection Silicone\n    set c1 = 0\n  end\nend\n",
         AllOf(HasSubstr("c1")));
}

TEST_F(BadCase, BulkModulusBelowTenShearModuliIsRefusedWithTheNumbers) {
  refuse("subsection Materials\n  subsection Silicone\n    set Bulk modulus = 1e6\n  end\nend\n",
         AllOf(HasSubstr("bulk modulus"), HasSubstr("6")));
}

TEST_F(BadCase, BulkModulusOfZeroIsRefused) {
  refuse("subsection Materials\n  subsection Silicone\n    set Bulk modulus = 0\n  end\nend\n",
         AllOf(HasSubstr("bad.prm"), HasSubstr("Bulk modulus")));
}

TEST_F(BadCase, MeshWithAnInvertedCellIsRefusedWithItsPlace) {
  // A cube of 1 mm whose corner 7 is pushed through the opposite one.
  const std::string mesh = folder.write(
      "inverted.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
      "$PhysicalNames\n3\n3 1 \"silicone\"\n2 1 \"clamp\"\n2 2 "
      "\"wire_surface\"\n$EndPhysicalNames\n"
      "$Nodes\n8\n1 0 0 0\n2 1e-3 0 0\n3 1e-3 1e-3 0\n4 0 1e-3 0\n5 0 0 1e-3\n6 1e-3 0 1e-3\n"
      "7 -1e-3 -1e-3 -1e-3\n8 0 1e-3 1e-3\n$EndNodes\n"
      "$Elements\n7\n1 5 2 1 1 1 2 3 4 5 6 7 8\n2 3 2 1 1 1 2 3 4\n3 3 2 2 2 5 6 7 8\n"
      "4 3 2 2 2 1 2 6 5\n5 3 2 2 2 2 3 7 6\n6 3 2 2 2 3 4 8 7\n7 3 2 2 2 4 1 5 8\n"
      "$EndElements\n");
  const std::string file = folder.write("bad.prm", case_with("Model", "Mesh file = " + mesh));
  expect_refusal(vibrissa("run '" + file + "' -o '" + folder.file("run") + "' --quiet"),
                 AllOf(HasSubstr("inverted or degenerate cell"), HasSubstr("z = ")));
}

TEST_F(BadCase, LineAtOrAboveHalfTheSamplingRateIsRefused) {
  refuse(case_with("Base motion", "Lines = 20, 250"),
         AllOf(HasSubstr("Lines"), HasSubstr("250"), HasSubstr("line 2")));
}

TEST_F(BadCase, DragOfRelativeVelocityInTheReducedModelIsRefusedWithWhatHasIt) {
  refuse(case_with("Wind", "Relative velocity = true"),
         AllOf(HasSubstr("Wind/Relative velocity"), HasSubstr("vibrissa transient")));
}

TEST_F(BadCase, WireThickerThanItsBaseIsRefused) {
  refuse(case_with("Geometry", "Wire diameter = 20e-3"), HasSubstr("Wire diameter"));
}

TEST_F(BadCase, MissingCaseFileIsNamed) {
  expect_refusal(vibrissa("run '" + folder.file("none.prm") + "'"), HasSubstr("none.prm"));
}

TEST_F(BadCase, UnknownOptionEntryNamesTheKnownOnes) {
  expect_refusal(vibrissa("modes '" + case_file("flow_sensor.prm") + "' --nonsense"),
                 HasSubstr("--nonsense"));
  expect_refusal(vibrissa("simulate '" + case_file("flow_sensor.prm") + "' --set Wind/Sped=3"),
                 AllOf(HasSubstr("Sped"), HasSubstr("Mean speed")));
}

TEST_F(BadCase, ResultsOfAnEarlierRunAreNotOverwritten) {
  std::filesystem::create_directory(folder.file("run"));
  folder.write("run/summary.json", "old");
  expect_refusal(vibrissa("run '" + case_file("whisker_sensor.prm") + "' -o '" +
                          folder.file("run") + "'" + quick),
                 HasSubstr("run"));
  EXPECT_EQ(content(folder.file("run/summary.json")), "old");
}

TEST_F(BadCase, FolderThatCannotBeMadeIsNamed) {
  folder.write("plain", "a file");
  expect_refusal(vibrissa("run '" + case_file("whisker_sensor.prm") + "' -o '" +
                          folder.file("plain") + "/run'" + quick),
                 HasSubstr("plain"));
}

TEST_F(BadCase, OptionsAboutARecordingThatIsNotReadAreRefused) {
  const std::string simulate =
      "simulate '" + case_file("flow_sensor.prm") + "' -o '" + folder.file("record.csv") + "' ";
  for (const std::string option :
       {"--column base_acceleration=ax", "--rate 500", "--rate wind_speed=500",
        "--rows base_acceleration=1:100", "--range wind_speed=0:4", "--remove-mean wind_speed"})
    expect_refusal(vibrissa(simulate + option),
                   AllOf(HasSubstr(option), HasSubstr("--base-acceleration FILE")));
  expect_refusal(vibrissa(simulate + "--periodic"), HasSubstr("updated model"));
  EXPECT_EQ(folder.n_entries(), 0u);
}

TEST(TakenFolder, IsRefusedBeforeTheWork) {
  const Folder folder;
  std::filesystem::create_directory(folder.file("taken"));
  folder.write("taken/report.html", "old");
  for (const std::string command : {"plan --sim nowhere", "diagnose --sim nowhere --real nowhere",
                                    "reproduce", "benchmark separation", "static nowhere.prm"}) {
    SCOPED_TRACE(command);
    expect_refusal(vibrissa(command + " -o '" + folder.file("taken") + "'"), HasSubstr("taken"));
  }
  EXPECT_EQ(content(folder.file("taken/report.html")), "old");
}

TEST(BadModel, SamplingTooSlowForItsFirstModeIsRefused) {
  const Folder folder;
  expect_refusal(vibrissa("plan --model '" + coarse_case(folder) + "' --rate 10 --quiet"),
                 AllOf(HasSubstr("--rate"), HasSubstr("first mode")));
}

TEST(BadModel, ResponsesInMatlabsNewerVersionAreRefused) {
  expect_refusal(vibrissa("convert nowhere.csv out.mat --frequency-response --mat-version 7.3"),
                 HasSubstr("is for records"));
}

/// A record of 400 samples whose rows a test can damage.
std::string record_text(const std::function<std::string(int, std::string)>& spoil) {
  std::ostringstream text;
  text << "time_s,base_acceleration_m_s2,base_moment_N_m\n";
  for (int i = 0; i < 400; ++i) {
    std::ostringstream row;
    row << 0.002 * i << "," << std::sin(0.3 * i) << "," << 1e-5 * std::sin(0.3 * i + 3.);
    text << spoil(i, row.str()) << "\n";
  }
  return text.str();
}

TEST(BadModel, FolderIsNoFile) {
  const Folder folder;
  const std::string model = folder.file("model.json");
  std::filesystem::create_directory(model);
  const std::string record =
      folder.write("r.csv", record_text([](int, const std::string& row) { return row; }));
  expect_refusal(vibrissa("plan --model '" + model + "'"), HasSubstr("is a folder"));
  expect_refusal(vibrissa("separate '" + record + "' --settling 0 --model '" + model + "'"),
                 HasSubstr("is a folder"));
}

class BadRecord : public testing::Test {
 protected:
  void refuse(const std::string& text, const std::string& options,
              const testing::Matcher<const std::string&>& message) {
    const std::string file = folder.write("bad.csv", text);
    const std::string model = folder.file("model.json");
    expect_refusal(vibrissa("identify '" + file + "' " + options + " -o '" + model + "'"), message);
    EXPECT_FALSE(std::filesystem::exists(model));
    expect_refusal(vibrissa("run '" + case_file("whisker_sensor.prm") +
                            "' --set Wind/Kind=none --set 'Separation/Settling time=0' --duration "
                            "0.5 --base-acceleration '" +
                            file + "' -o '" + folder.file("run") + "'" + quick + " " + options),
                   message);
    EXPECT_FALSE(std::filesystem::exists(folder.file("run")));
  }
  Folder folder;
};

TEST_F(BadRecord, TextInANumberNamesFileLineAndColumn) {
  refuse(record_text([](int i, std::string row) { return i == 40 ? "0.08,abc,0" : row; }), "",
         AllOf(HasSubstr("bad.csv:42"), HasSubstr("base_acceleration_m_s2"), HasSubstr("abc")));
}

TEST_F(BadRecord, NotANumberIsReportedWithItsPlace) {
  refuse(record_text([](int i, std::string row) { return i == 40 ? "0.08,nan,0" : row; }), "",
         AllOf(HasSubstr("bad.csv:42"), HasSubstr("nan")));
}

std::string text_with_gap() {
  std::string text = record_text(
      [](int i, std::string row) { return i >= 100 && i < 107 ? std::string("DROP") : row; });
  for (std::size_t at; (at = text.find("DROP\n")) != std::string::npos;) text.erase(at, 5);
  return text;
}

TEST_F(BadRecord, GapInTimeIsReportedWithItsPlace) {
  const std::string file = folder.write("gap.csv", text_with_gap());
  const auto message = AllOf(HasSubstr("gap"), HasSubstr("101"));
  expect_refusal(vibrissa("identify '" + file + "' --gaps refuse"), message);
  expect_refusal(vibrissa("run '" + case_file("whisker_sensor.prm") +
                          "' --set Wind/Kind=none --set 'Separation/Settling time=0' --duration "
                          "0.5 --base-acceleration '" +
                          file + "' -o '" + folder.file("run") + "'" + quick),
                 message);
}

TEST_F(BadRecord, PiecesBetweenLostSamplesAreSaidAndConverted) {
  const std::string file = folder.write("gap.csv", text_with_gap());
  const ProgramResult result =
      vibrissa("convert '" + file + "' '" + folder.file("piece.csv") + "'");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.errors, AllOf(HasSubstr("read as: commas, decimal points, names in line 1"),
                                   HasSubstr("7 samples are lost at 1 place"),
                                   HasSubstr("393 samples, 0.786 s in 2 pieces")));
  EXPECT_TRUE(std::filesystem::exists(folder.file("piece_1.csv")));
  EXPECT_TRUE(std::filesystem::exists(folder.file("piece_2.csv")));
  EXPECT_EQ(vibrissa("convert '" + file + "' '" + folder.file("q.csv") + "' --quiet").errors, "");
}

TEST_F(BadRecord, WrongColumnNameListsTheColumnsOfTheFile) {
  refuse(record_text([](int, std::string row) { return row; }), "--column base_acceleration=z_mps2",
         AllOf(HasSubstr("z_mps2"), HasSubstr("base_acceleration_m_s2")));
}

TEST_F(BadRecord, MissingFileIsNamed) {
  expect_refusal(vibrissa("identify '" + folder.file("none.csv") + "'"), HasSubstr("none.csv"));
}

}  // namespace
}  // namespace vibrissa::apps
