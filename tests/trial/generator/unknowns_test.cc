#include "trial/generator/unknowns.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "signals/base/error.h"

namespace vibrissa::trial {
namespace {

/// All text of the room that must not contain these ids.
std::string text_of_diagnosis() {
  std::ostringstream out;
  const std::filesystem::path room = std::filesystem::path(VIBRISSA_SOURCE_DIR) / "diagnosis";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(room))
    if (entry.is_regular_file()) out << std::ifstream(entry.path()).rdbuf();
  return out.str();
}

TEST(Unknowns, NamelessOnesAreAtLeastEightAndTheDiagnosisNamesNone) {
  const std::string diagnosis = text_of_diagnosis();
  ASSERT_NE(diagnosis.find("stiffness"), std::string::npos);
  EXPECT_GE(nameless_unknowns().size(), 8u);
  for (const Unknown& unknown : nameless_unknowns())
    EXPECT_EQ(diagnosis.find(unknown.id), std::string::npos) << unknown.id;
}

TEST(Unknowns, NamedOnesAreTheWordsOfTheCatalogue) {
  EXPECT_EQ(named_unknowns().size(), 31u);
  const std::string diagnosis = text_of_diagnosis();
  for (const Unknown& unknown : named_unknowns())
    EXPECT_NE(diagnosis.find("\"" + unknown.id + "\""), std::string::npos) << unknown.id;
}

TEST(Unknowns, AreFoundByNameOrRefused) {
  EXPECT_EQ(find_unknown("delay").id, "delay");
  EXPECT_THROW(find_unknown("gremlins"), signals::UserError);
}

}  // namespace
}  // namespace vibrissa::trial
