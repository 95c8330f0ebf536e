#include <gmock/gmock.h>  // first: deal.II defines a macro of a name that gmock uses

#include "materials/sensor_materials.h"

#include <sstream>
#include <string>

#include "signals/base/error.h"

namespace vibrissa::materials {
namespace {

using dealii::ParameterHandler;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

SensorMaterials parsed(const std::string& case_file) {
  ParameterHandler prm;
  SensorMaterials::declare(prm);
  std::istringstream in(case_file);
  prm.parse_input(in, "case.prm");
  SensorMaterials materials;
  materials.parse(prm);
  return materials;
}

std::string entry(const std::string& body, const std::string& line) {
  return "subsection Materials\n  subsection " + body + "\n    set " + line + "\n  end\nend\n";
}

TEST(SensorMaterials, DefaultsAreThePapersMaterialsAsSettled) {
  const SensorMaterials materials = parsed("");
  EXPECT_EQ(std::get<Yeoh>(materials.silicone.isochoric).c,
            (std::array<double, 3>{3.4e5, 1.7152e5, 1.32e8}));
  EXPECT_EQ(materials.silicone.volumetric.bulk_modulus, 1.5e9);
  EXPECT_EQ(materials.silicone.volumetric.kind, VolumetricLaw::Kind::quadratic);
  EXPECT_EQ(materials.silicone.density, 1080.);
  EXPECT_NEAR(materials.wire.youngs_modulus_at_rest(), 70e9, 1.);
  EXPECT_NEAR(materials.wire.poisson_ratio_at_rest(), 0.33, 1e-12);
  EXPECT_EQ(materials.wire.density, 6450.);
  EXPECT_NEAR(materials.fin.youngs_modulus_at_rest(), 4.1e9, 1.);
  EXPECT_NEAR(materials.fin.poisson_ratio_at_rest(), 0.35, 1e-12);
  EXPECT_EQ(materials.fin.density, 1230.);
  for (const auto& [region, material] : materials.by_region())
    EXPECT_EQ(material.loss_factor, 0.) << region;
}

TEST(SensorMaterials, EveryEntryReachesItsOwnMaterial) {
  const SensorMaterials materials =
      parsed(entry("Silicone", "c1 = 2e5") + entry("Silicone", "c2 = -3e4") +
             entry("Silicone", "c3 = 5e3") + entry("Silicone", "Bulk modulus = 1e9") +
             entry("Silicone", "Volumetric law = Hartmann-Neff") +
             entry("Silicone", "Density = 1100") + entry("Silicone", "Loss factor = 0.12") +
             entry("Wire", "Young modulus = 60e9") + entry("Wire", "Poisson ratio = 0.3") +
             entry("Wire", "Density = 6400") + entry("Wire", "Loss factor = 0.01") +
             entry("Fin", "Young modulus = 3e9") + entry("Fin", "Poisson ratio = 0.36") +
             entry("Fin", "Density = 1000") + entry("Fin", "Loss factor = 0.02"));
  const auto& [silicone, wire, fin] = materials;
  EXPECT_EQ(std::get<Yeoh>(silicone.isochoric).c, (std::array<double, 3>{2e5, -3e4, 5e3}));
  EXPECT_EQ(silicone.volumetric.bulk_modulus, 1e9);
  EXPECT_EQ(silicone.volumetric.kind, VolumetricLaw::Kind::hartmann_neff);
  EXPECT_EQ(silicone.density, 1100.);
  EXPECT_EQ(silicone.loss_factor, 0.12);
  EXPECT_NEAR(wire.youngs_modulus_at_rest() / 60e9, 1., 1e-12);
  EXPECT_NEAR(wire.poisson_ratio_at_rest(), 0.3, 1e-12);
  EXPECT_EQ(wire.density, 6400.);
  EXPECT_EQ(wire.loss_factor, 0.01);
  EXPECT_NEAR(fin.youngs_modulus_at_rest() / 3e9, 1., 1e-12);
  EXPECT_NEAR(fin.poisson_ratio_at_rest(), 0.36, 1e-12);
  EXPECT_EQ(fin.density, 1000.);
  EXPECT_EQ(fin.loss_factor, 0.02);
}

TEST(SensorMaterials, KnowsItsMaterialsByRegion) {
  const SensorMaterials materials = parsed(entry("Fin", "Density = 999"));
  const auto regions = materials.by_region();
  ASSERT_EQ(regions.size(), 3u);
  EXPECT_EQ(regions.at("silicone").density, 1080.);
  EXPECT_EQ(regions.at("wire").density, 6450.);
  EXPECT_EQ(regions.at("fin").density, 999.);
}

TEST(SensorMaterials, RelaxingBranchesAreReadInPairs) {
  const auto materials =
      parsed(entry("Silicone", "Prony moduli = 0.3, 0.1\n    set Prony times = 1e-3, 0.2"));
  const auto& branches = materials.silicone.relaxation.branches();
  ASSERT_EQ(branches.size(), 2u);
  EXPECT_EQ(branches[1].modulus_ratio, 0.1);
  EXPECT_EQ(branches[1].relaxation_time_s, 0.2);
  EXPECT_TRUE(materials.wire.relaxation.branches().empty());
  EXPECT_THAT([] { parsed(entry("Fin", "Prony moduli = 0.3")); },
              ThrowsMessage<signals::UserError>(
                  AllOf(HasSubstr("Materials/Fin"), HasSubstr("the same number of both"))));
}

TEST(SensorMaterials, AValueOutOfRangeIsRefusedWithItsLineAndEntry) {
  const auto refused = [](const std::string& body, const std::string& line,
                          const std::string& name) {
    EXPECT_THAT([&] { parsed(entry(body, line)); },
                ThrowsMessage<std::exception>(
                    AllOf(HasSubstr("Line <3>"), HasSubstr("case.prm"), HasSubstr(name))))
        << line;
  };
  refused("Silicone", "c1 = 0", "c1");
  refused("Silicone", "c2 = stiff", "c2");
  refused("Silicone", "c3 = nan", "c3");
  refused("Silicone", "Bulk modulus = -1", "Bulk modulus");
  refused("Silicone", "Volumetric law = linear", "Volumetric law");
  refused("Silicone", "Loss factor = -0.1", "Loss factor");
  refused("Wire", "Density = -6450", "Density");
  refused("Wire", "Young modulus = 0", "Young modulus");
  refused("Fin", "Poisson ratio = 0.5", "Poisson ratio");
}

TEST(SensorMaterials, AMisspelledEntryIsRefusedWithItsLine) {
  EXPECT_THAT(
      [] { parsed(entry("Wire", "Youngs modulus = 70e9")); },
      ThrowsMessage<std::exception>(AllOf(HasSubstr("Line <3>"), HasSubstr("Youngs modulus"))));
}

TEST(SensorMaterials, EntriesThatDoNotFitEachOtherAreRefusedWithTheirSubsection) {
  EXPECT_THAT([] { parsed(entry("Silicone", "Bulk modulus = 6.7e6")); },
              ThrowsMessage<signals::UserError>(AllOf(HasSubstr("Materials/Silicone"),
                                                      HasSubstr("bulk modulus is 6700000 Pa"),
                                                      HasSubstr("6800000 Pa"))));
}

}  // namespace
}  // namespace vibrissa::materials
