#include "apps/command_line/manual.h"

#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

using ::testing::HasSubstr;

TEST(Manual, ManReadsItWithoutAWarning) {
  const Folder folder;
  const ProgramResult page = vibrissa("manual");
  ASSERT_EQ(page.status, 0);
  const std::string file = folder.write("vibrissa.1", page.output);
  EXPECT_THAT(page.output, HasSubstr(".SS vibrissa diagnose"));
  EXPECT_THAT(page.output, HasSubstr("\\-\\-column"));
  if (std::system("command -v groff > /dev/null") != 0) GTEST_SKIP() << "groff is missing";
  const std::string check = "groff -man -Tutf8 -ww '" + file + "' > '" + folder.file("text") +
                            "' 2> '" + folder.file("warnings") + "'";
  EXPECT_EQ(std::system(check.c_str()), 0);
  EXPECT_EQ(content(folder.file("warnings")), "");
  // Lines are justified with further spaces, which lines before them may shift.
  EXPECT_THAT(std::regex_replace(content(folder.file("text")), std::regex("\\s+"), " "),
              HasSubstr("base vibration response model"));
}

// Commands that hold others do nothing themselves.
void expect_json_option(const nlohmann::json& command, const std::string& path) {
  for (const auto& inner : command["commands"])
    expect_json_option(inner, path + " " + inner["name"].get<std::string>());
  if (!command["commands"].empty()) return;
  std::string names;
  for (const auto& option : command["options"]) names += option["name"].get<std::string>() + " ";
  EXPECT_THAT(names, HasSubstr("--json ")) << path;
}

TEST(Manual, EveryCommandTakesJson) {
  const ProgramResult page = vibrissa("manual --json");
  ASSERT_EQ(page.status, 0);
  const auto document = nlohmann::json::parse(page.output);
  EXPECT_GT(document["commands"].size(), 15u);
  expect_json_option(document, "vibrissa");
}

TEST(Completion, IsJsonOnDemand) {
  const auto document = nlohmann::json::parse(vibrissa("completion zsh --json").output);
  EXPECT_EQ(document["shell"], "zsh");
  EXPECT_EQ(document["script"], vibrissa("completion zsh").output);
}

TEST(Completion, BashCompletesCommandsAndOptions) {
  const Folder folder;
  const std::string script = folder.write("script", vibrissa("completion bash").output);
  const auto completed = [&](const std::string& words, const int at) {
    const std::string command = "cd '" + folder.file("") + "' && bash -c 'source " + script +
                                "; COMP_WORDS=(" + words + "); COMP_CWORD=" + std::to_string(at) +
                                "; _vibrissa; echo \"${COMPREPLY[@]}\"' > " + folder.file("out");
    EXPECT_EQ(std::system(command.c_str()), 0);
    return content(folder.file("out"));
  };
  EXPECT_EQ(completed("vibrissa diag", 1), "diagnose\n");
  EXPECT_EQ(completed("vibrissa diagnose --max-e", 2), "--max-effects\n");
}

TEST(Misspelt, CommandsAndOptionsAreTakenForTheirNeighbours) {
  const ProgramResult command = vibrissa("idenfity x.csv");
  EXPECT_EQ(command.status, 2);
  EXPECT_THAT(command.errors, HasSubstr("unknown command 'idenfity'; did you mean 'identify'?"));
  const ProgramResult option = vibrissa("identify --colum a=b x.csv");
  EXPECT_EQ(option.status, 2);
  EXPECT_THAT(option.errors, HasSubstr("unknown option '--colum'; did you mean '--column'?"));
  const ProgramResult inner = vibrissa("trial mak");
  EXPECT_THAT(inner.errors, HasSubstr("unknown command 'mak'; did you mean 'make'?"));
}

TEST(Init, WritesACaseThatRunsAndOverwritesNothing) {
  const Folder folder;
  const std::string file = folder.file("mine.prm");
  ASSERT_EQ(vibrissa("init '" + file + "' --kind whisker").status, 0);
  const std::string written = content(file);
  EXPECT_THAT(written, HasSubstr("# "));
  const ProgramResult mesh = vibrissa("mesh '" + file + "' --json");
  EXPECT_EQ(mesh.status, 0) << mesh.errors;
  EXPECT_EQ(mesh.json(), vibrissa("mesh '" + case_file("whisker_sensor.prm") + "' --json").json());
  EXPECT_EQ(vibrissa("init '" + file + "'").status, 2);
  EXPECT_EQ(content(file), written);
}

TEST(Doctor, NamesWhatIsMissing) {
  const ProgramResult doctor = vibrissa("doctor --json");
  ASSERT_EQ(doctor.status, 0);
  EXPECT_EQ(doctor.json()["checks"].size(), 8u);
  const Folder folder;
  const std::string bare = "env -u DISPLAY PATH=/nowhere '" + std::string(VIBRISSA_PROGRAM) +
                           "' doctor > '" + folder.file("out") + "'";
  ASSERT_EQ(std::system(bare.c_str()), 0);
  EXPECT_THAT(content(folder.file("out")), HasSubstr("apt-get install xvfb"));
}

TEST(Convert, UnitsAreConvertedAndImplausibleMagnitudesRemarked) {
  const Folder folder;
  std::string text = "t,ax,hall\n";
  for (int i = 0; i < 100; ++i)
    text += std::to_string(2 * i) + "e-3,0.99," + std::to_string(i % 7) + "\n";
  const std::string file = folder.write("mine.csv", text);
  const std::string taken = " --column time=t[s] --column 'base_moment=hall[uT]*0.18[N m/T]'";
  const ProgramResult right = vibrissa("convert '" + file + "' '" + folder.file("si.mat") + "'" +
                                       taken + " --column 'base_acceleration=ax[g]' --json");
  ASSERT_EQ(right.status, 0) << right.errors;
  EXPECT_THAT(right.errors, testing::Not(testing::HasSubstr("warning")));
  EXPECT_THAT(right.errors, testing::HasSubstr("base_acceleration_m_s2 = ax [g] * 9.80665"));
  EXPECT_EQ(right.json()["sampling_rate_hz"], 500.);
  const ProgramResult unitless = vibrissa("convert '" + file + "' '" + folder.file("x.csv") + "'" +
                                          taken + " --column base_acceleration=ax");
  EXPECT_THAT(unitless.errors, HasSubstr("looks like gravity in g"));
  const ProgramResult wrong = vibrissa("convert '" + file + "' '" + folder.file("y.csv") + "'" +
                                       taken + " --column 'base_acceleration=ax[uT]'");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.errors, HasSubstr("cannot be converted"));
}

}  // namespace
}  // namespace vibrissa::apps
