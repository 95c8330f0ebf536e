#include "report/modes/mode_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/report/letters.h"

namespace vibrissa::report {
namespace {

ModePage page_for(const double width, const double height) {
  ModePicture picture;
  picture.title = "Mode 3: 147 Hz, torsion of the fin about the wire";
  picture.colour_label = "Size of the displacement [mm]";
  DeformedMesh mesh;
  mesh.scale = 50.;
  mesh.colours = {0., 3e-5};
  MeshView view{};
  view.width = width;
  view.height = height;
  return mode_page(picture, mesh, view, wide_letters);
}

TEST(ModePage, KeepsTextsApartAndOnThePageForTallAndFlatMeshes) {
  for (const double aspect : {0.02, 0.5, 1., 3., 50.}) {
    const ModePage page = page_for(aspect, 1.);
    for (std::size_t i = 0; i < page.texts.size(); ++i) {
      const Box a = box_of(page.texts[i]);
      EXPECT_GE(a.left, 0.) << page.texts[i].text;
      EXPECT_LE(a.right(), page.width) << page.texts[i].text;
      EXPECT_GE(a.bottom, 0.) << page.texts[i].text;
      EXPECT_LE(a.top(), page.height) << page.texts[i].text;
      for (std::size_t j = 0; j < i; ++j) {
        const Box b = box_of(page.texts[j]);
        EXPECT_FALSE(a.left < b.right() && b.left < a.right() && a.bottom < b.top() &&
                     b.bottom < a.top())
            << aspect << ": '" << page.texts[i].text << "' and '" << page.texts[j].text << "'";
      }
    }
    EXPECT_GT(page.bar.bottom, page.compass_y + page.compass_length) << aspect;
  }
}

TEST(ModePage, TellsTheScaleAndTheValuesOfTheColours) {
  const ModePage page = page_for(0.3, 1.);
  std::vector<std::string> texts;
  for (const auto& text : page.texts) texts.push_back(text.text);
  EXPECT_THAT(texts, ::testing::IsSupersetOf({std::string("deformation \u00d7 50"),
                                              std::string("\u00d710\u207b\u2076"), std::string("0"),
                                              std::string("30")}));
  EXPECT_EQ(page.bar_axis.range, (Range{0., 3e-5}));
}

}  // namespace
}  // namespace vibrissa::report
