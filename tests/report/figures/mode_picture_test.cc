#include "report/figures/mode_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "signals/base/error.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::report {
namespace {

using signals::UserError;
using signals::test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

ModePicture example_scene() {
  return {.name = "mode_1",
          .title = "Mode 1: 37.3 Hz",
          .caption = "caption",
          .vtu = "modes/mode_1_0.vtu",
          .displacement = "displacement_m",
          .colour_field = "pressure_Pa",
          .colour_label = "Pressure [kPa]",
          .colour_factor = 1e-3,
          .scale = 20.};
}

TEST(ModePicture, ComesBackFromItsFileAsItWas) {
  const TemporaryFolder folder;
  write_mode_picture(folder.path(), example_scene());
  EXPECT_EQ(read_mode_picture(folder.path() / "figures" / "mode_1.scene.json"), example_scene());
  ModePicture plain{.name = "a", .vtu = "a.vtu", .displacement = "u"};
  write_mode_picture(folder.path(), plain);
  EXPECT_EQ(read_mode_picture(folder.path() / "figures" / "a.scene.json"), plain);
}

TEST(ModePicture, RefusesWhatCannotBeDrawn) {
  const TemporaryFolder folder;
  const auto write = [&](auto&& change) {
    ModePicture picture = example_scene();
    change(picture);
    return [&folder, picture] { write_mode_picture(folder.path(), picture); };
  };
  EXPECT_THAT(write([](auto& p) { p.name = "a/b"; }),
              ThrowsMessage<UserError>(HasSubstr("not a plain file name")));
  for (const std::string vtu : {"", "/etc/x.vtu", "../x.vtu", "a/../../x.vtu"})
    EXPECT_THAT(write([&](auto& p) { p.vtu = vtu; }),
                ThrowsMessage<UserError>(HasSubstr("inside the run folder")))
        << vtu;
  EXPECT_THAT(write([](auto& p) { p.displacement = ""; }),
              ThrowsMessage<UserError>(HasSubstr("'displacement'")));
  EXPECT_THAT(write([](auto& p) { p.scale = INFINITY; }),
              ThrowsMessage<UserError>(HasSubstr("'scale'")));
  EXPECT_THAT(write([](auto& p) { p.colour_factor = NAN; }),
              ThrowsMessage<UserError>(HasSubstr("'colour_factor'")));
  EXPECT_EQ(folder.n_entries(), 0u);
}

TEST(ModePicture, NamesFileAndEntryWhenAFileIsWrong) {
  const TemporaryFolder folder;
  nlohmann::json json = example_scene();
  json.erase("vtu");
  const auto file = folder.file("m.scene.json", json.dump());
  EXPECT_THAT([&] { read_mode_picture(file); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("m.scene.json"), HasSubstr("'vtu'"))));
}

}  // namespace
}  // namespace vibrissa::report
