// Before deal.II, whose macro Assert hides a function of gmock.
#include <gmock/gmock.h>

#include "meshes/sensor_geometry.h"

#include <limits>
#include <sstream>

#include "signals/base/error.h"
#include "tests/meshes/flow_sensor.h"

namespace vibrissa::meshes {
namespace {

using signals::UserError;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

SensorGeometry parsed(const std::string& text) {
  dealii::ParameterHandler prm;
  SensorGeometry::declare(prm);
  prm.parse_input_from_string(text);
  SensorGeometry geometry;
  geometry.parse(prm);
  return geometry;
}

TEST(SensorGeometry, DeclaresTheDefaultsOfTheStruct) {
  const SensorGeometry geometry = parsed(""), defaults;
  EXPECT_EQ(geometry.base_diameter, defaults.base_diameter);
  EXPECT_EQ(geometry.base_height, defaults.base_height);
  EXPECT_EQ(geometry.wire_diameter, defaults.wire_diameter);
  EXPECT_EQ(geometry.embedded_length, defaults.embedded_length);
  EXPECT_EQ(geometry.free_length, defaults.free_length);
  EXPECT_EQ(geometry.fin, defaults.fin);
  EXPECT_EQ(geometry.fin_height, defaults.fin_height);
  EXPECT_EQ(geometry.fin_thickness, defaults.fin_thickness);
  EXPECT_EQ(geometry.fin_top_width, defaults.fin_top_width);
  EXPECT_EQ(geometry.fin_bottom_width, defaults.fin_bottom_width);
}

TEST(SensorGeometry, ReadsEveryEntry) {
  const SensorGeometry geometry = parsed(
      "subsection Geometry\n"
      "set Base diameter = 0.02\n set Base height = 0.01\n set Wire diameter = 0.001\n"
      "set Embedded length = 0.005\n set Free length = 0.03\n set Fin = plate\n"
      "set Fin height = 0.04\n set Fin thickness = 0.0012\n set Fin top width = 0.016\n"
      "set Fin bottom width = 0.006\nend\n");
  EXPECT_EQ(geometry.base_diameter, 0.02);
  EXPECT_EQ(geometry.base_height, 0.01);
  EXPECT_EQ(geometry.wire_diameter, 0.001);
  EXPECT_EQ(geometry.embedded_length, 0.005);
  EXPECT_EQ(geometry.free_length, 0.03);
  EXPECT_EQ(geometry.fin, FinShape::plate);
  EXPECT_EQ(geometry.fin_height, 0.04);
  EXPECT_EQ(geometry.fin_thickness, 0.0012);
  EXPECT_EQ(geometry.fin_top_width, 0.016);
  EXPECT_EQ(geometry.fin_bottom_width, 0.006);
  EXPECT_EQ(parsed("subsection Geometry\n set Fin = cross\nend\n").fin, FinShape::cross);
  EXPECT_EQ(parsed("subsection Geometry\n set Fin = none\nend\n").fin, FinShape::none);
}

TEST(SensorGeometry, RefusesEntriesOutOfRangeOrUnknownWhenTheyAreRead) {
  for (const char* const entry : {"Base diameter = 10", "Wire diameter = 0", "Free length = -0.01",
                                  "Fin = star", "Fin height = tall", "Wire radius = 0.001"})
    EXPECT_THROW(parsed("subsection Geometry\n set " + std::string(entry) + "\nend\n"),
                 dealii::ExceptionBase)
        << entry;
}

TEST(SensorGeometry, DocumentsEveryEntryWithItsUnit) {
  dealii::ParameterHandler prm;
  SensorGeometry::declare(prm);
  std::ostringstream text;
  prm.print_parameters(text, dealii::ParameterHandler::Description);
  for (const char* const part : {"Base diameter", "Fin bottom width", "[m]", "none, cross, plate"})
    EXPECT_THAT(text.str(), HasSubstr(part));
}

TEST(SensorGeometry, TipIsAtTheTopOfTheWireOrOfTheFin) {
  EXPECT_DOUBLE_EQ(SensorGeometry().tip_height(), 97.9e-3);
  EXPECT_DOUBLE_EQ(flow_sensor().tip_height(), 44.57e-3);
}

TEST(SensorGeometry, AcceptsBothSensorsOfTheStudyAndThePlate) {
  EXPECT_NO_THROW(SensorGeometry().check());
  EXPECT_NO_THROW(flow_sensor().check());
  SensorGeometry plate = flow_sensor();
  plate.fin = FinShape::plate;
  EXPECT_NO_THROW(plate.check());
}

TEST(SensorGeometry, RefusesLengthsThatAreNoLengthsWithEntryAndValue) {
  using G = SensorGeometry;
  const std::pair<double G::*, const char*> members[] = {
      {&G::base_diameter, "'Base diameter'"},      {&G::base_height, "'Base height'"},
      {&G::wire_diameter, "'Wire diameter'"},      {&G::embedded_length, "'Embedded length'"},
      {&G::free_length, "'Free length'"},          {&G::fin_height, "'Fin height'"},
      {&G::fin_thickness, "'Fin thickness'"},      {&G::fin_top_width, "'Fin top width'"},
      {&G::fin_bottom_width, "'Fin bottom width'"}};
  const double bad_values[] = {-1e-3, 0., 1.5, std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity()};
  for (const auto& [member, entry] : members)
    for (const double value : bad_values) {
      SensorGeometry geometry = flow_sensor();
      geometry.*member = value;
      EXPECT_THAT([&] { geometry.check(); },
                  ThrowsMessage<UserError>(AllOf(HasSubstr("subsection Geometry"), HasSubstr(entry),
                                                 HasSubstr("is outside 1e-05 ... 1 m"))));
    }
  SensorGeometry geometry;
  geometry.base_height = -8e-3;
  EXPECT_THAT([&] { geometry.check(); }, ThrowsMessage<UserError>(HasSubstr("-0.008 m")));
}

TEST(SensorGeometry, NeedsSiliconeAroundTheWire) {
  SensorGeometry geometry;
  geometry.base_diameter = geometry.wire_diameter;
  EXPECT_THAT([&] { geometry.check(); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("'Base diameter' = 0.00058 m must exceed"),
                                             HasSubstr("'Wire diameter' = 0.00058 m"))));
  geometry.base_diameter = geometry.wire_diameter + 2e-5;
  EXPECT_NO_THROW(geometry.check());
}

TEST(SensorGeometry, EmbedsTheWireAtMostDownToTheSupport) {
  SensorGeometry geometry;
  geometry.embedded_length = geometry.base_height;
  EXPECT_NO_THROW(geometry.check());
  geometry.embedded_length = 8.5e-3;
  EXPECT_THAT([&] { geometry.check(); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("'Embedded length' = 0.0085 m"),
                                             HasSubstr("'Base height' = 0.008 m"))));
  geometry.embedded_length = 7.999e-3;
  EXPECT_THAT([&] { geometry.check(); }, ThrowsMessage<UserError>(HasSubstr("film of silicone")));
}

TEST(SensorGeometry, NeedsAFinThatIsThickerThanTheWireAndWiderThanThick) {
  SensorGeometry geometry = flow_sensor();
  geometry.fin_thickness = 0.6e-3;
  EXPECT_THAT([&] { geometry.check(); },
              ThrowsMessage<UserError>(
                  AllOf(HasSubstr("'Fin thickness' = 6e-04 m must be at least 1.1 times"),
                        HasSubstr("'Wire diameter' = 0.00058 m"))));
  geometry = flow_sensor();
  geometry.fin_top_width = 1e-3;
  EXPECT_THAT([&] { geometry.check(); },
              ThrowsMessage<UserError>(HasSubstr("'Fin top width' = 0.001 m must exceed")));
  geometry = flow_sensor();
  geometry.fin_bottom_width = 0.9e-3;
  EXPECT_THAT([&] { geometry.check(); },
              ThrowsMessage<UserError>(HasSubstr("'Fin bottom width' = 9e-04 m must exceed")));
}

TEST(SensorGeometry, DoesNotJudgeTheFinOfASensorWithoutOne) {
  SensorGeometry geometry;
  geometry.fin_thickness = 0.;
  geometry.fin_top_width = -1.;
  EXPECT_NO_THROW(geometry.check());
}

}  // namespace
}  // namespace vibrissa::meshes
