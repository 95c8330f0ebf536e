#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "signals/base/error.h"
#include "signals/model/reduced_model.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double smallest = std::numeric_limits<double>::denorm_min();
constexpr double largest = std::numeric_limits<double>::max();

/// Numbers without an exact short decimal text.
ReducedModel awkward_model() {
  ReducedModel model;
  model.name = "flow sensor, \"level 2\" \\ µ";
  model.axial_direction = {0.6, 0.8, -0.};
  model.modes = {
      {37.3, 0.05, {0.1 + 0.2, 1. / 3., -smallest}, {std::exp(1.), largest, -0.}},
      {std::nextafter(528., 529.), 0., {1e-300, 5e-324, 1.}, {2e22, 1e23, 9007199254740993.}}};
  model.rigid_moment = {{{1e-8, -9e-6, 2e-7}, {9.5e-6, 2e-8, -1e-7}, {1. / 7., 3e-7, 0.}}};
  model.wind = {.speed_m_s = {-1.1, 0.1},
                .modal_coefficient = {{3e-4, 1.1e-5}, {4e-4, 1. / 9.}},
                .moment_coefficient = {{-6e-7, 1e-6, 0.}, {1. / 11., 2e-6, 1e-8}}};
  model.sensitivities = {{.parameter = "silicone_modulus",
                          .nominal_value = 2.04e6,
                          .unit = "Pa",
                          .frequency = {0.355, 1. / 13.},
                          .base_gain = {-0.1, 0.},
                          .wind_gain = {0.7, 1e-17},
                          .static_base_moment = 1. / 17.,
                          .static_wind_moment = -1. / 19.}};
  model.provenance = {{"mesh", "level 2"}, {"revision", "abc"}};
  return model;
}

class ModelFile : public ::testing::Test {
 protected:
  std::filesystem::path file() const { return folder_.path() / "model.json"; }
  void write_text(const std::string& text) const { std::ofstream(file()) << text; }
  auto reading(const json& document) const {
    write_text(document.dump());
    return [this] { read_reduced_model(file()); };
  }
  /// A complaint that names the file and the entry.
  static auto complains(const std::string& file, const std::string& complaint) {
    return ThrowsMessage<UserError>(AllOf(HasSubstr(file + ": "), HasSubstr(complaint)));
  }

 private:
  test::TemporaryFolder folder_;
};

template <typename T>
void expect_same_bits(const T& a, const T& b) {
  if constexpr (std::is_same_v<T, double>) {
    EXPECT_EQ(std::memcmp(&a, &b, sizeof(double)), 0) << a << " and " << b;
  } else {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) expect_same_bits(a[i], b[i]);
  }
}

TEST_F(ModelFile, ReadsBackToIdenticalBits) {
  const auto written = awkward_model();
  write_reduced_model(file(), written);
  const auto read = read_reduced_model(file());
  EXPECT_EQ(read.name, written.name);
  EXPECT_EQ(read.provenance, written.provenance);
  expect_same_bits(read.axial_direction, written.axial_direction);
  expect_same_bits(read.rigid_moment, written.rigid_moment);
  ASSERT_EQ(read.modes.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    expect_same_bits(read.modes[k].frequency_hz, written.modes[k].frequency_hz);
    expect_same_bits(read.modes[k].damping_ratio, written.modes[k].damping_ratio);
    expect_same_bits(read.modes[k].participation, written.modes[k].participation);
    expect_same_bits(read.modes[k].moment_participation, written.modes[k].moment_participation);
  }
  expect_same_bits(read.wind.speed_m_s, written.wind.speed_m_s);
  expect_same_bits(read.wind.modal_coefficient, written.wind.modal_coefficient);
  expect_same_bits(read.wind.moment_coefficient, written.wind.moment_coefficient);
  ASSERT_EQ(read.sensitivities.size(), 1u);
  const Sensitivity &a = read.sensitivities[0], &b = written.sensitivities[0];
  EXPECT_EQ(a.parameter, b.parameter);
  EXPECT_EQ(a.unit, b.unit);
  expect_same_bits(a.nominal_value, b.nominal_value);
  expect_same_bits(a.frequency, b.frequency);
  expect_same_bits(a.base_gain, b.base_gain);
  expect_same_bits(a.wind_gain, b.wind_gain);
  expect_same_bits(a.static_base_moment, b.static_base_moment);
  expect_same_bits(a.static_wind_moment, b.static_wind_moment);
}

TEST_F(ModelFile, KeepsAModelWithoutWindSensitivitiesOrProvenance) {
  ReducedModel bare;
  bare.modes = {{37.3, 0.05, {1., 0., 0.}, {0., 1., 0.}}};
  write_reduced_model(file(), bare);
  const auto read = read_reduced_model(file());
  EXPECT_EQ(read.modes.size(), 1u);
  EXPECT_TRUE(read.wind.speed_m_s.empty());
  EXPECT_TRUE(read.sensitivities.empty());
  EXPECT_TRUE(read.provenance.empty());
}

TEST_F(ModelFile, SaysItsSchemaUnitsAndSignConvention) {
  const json document = to_json(awkward_model());
  EXPECT_EQ(document["schema"], "vibrissa-model-1");
  EXPECT_THAT(document["moment"].get<std::string>(), HasSubstr("positive for wind along axial"));
  EXPECT_EQ(document["modes"][0]["frequency_hz"], 37.3);
  EXPECT_TRUE(document.contains("rigid_moment_kg_m"));
  EXPECT_TRUE(document["wind"].contains("speed_m_s"));
}

TEST_F(ModelFile, AcceptsWholeNumbersAndFurtherEntries) {
  json document = to_json(awkward_model());
  document["modes"][0]["frequency_hz"] = 37;
  document["comment"] = "measured twice";
  EXPECT_NO_THROW(reading(document)());
  EXPECT_EQ(read_reduced_model(file()).modes[0].frequency_hz, 37.);
}

// Every named entry but the hint for people and the free list of origins.
std::vector<json::json_pointer> named_entries(const json& document) {
  std::vector<json::json_pointer> places;
  const std::function<void(const json&, const json::json_pointer&)> visit =
      [&](const json& value, const json::json_pointer& place) {
        for (const auto& item : value.items()) {
          const auto below = value.is_array() ? place / std::stoul(item.key()) : place / item.key();
          if (below.to_string() == "/moment") continue;
          if (value.is_object() && place.to_string() != "/provenance") places.push_back(below);
          if (item.value().is_structured()) visit(item.value(), below);
        }
      };
  visit(document, json::json_pointer());
  return places;
}

TEST_F(ModelFile, NamesEveryEntryThatIsMissing) {
  const json document = to_json(awkward_model());
  const auto places = named_entries(document);
  EXPECT_GT(places.size(), 25u);
  for (const auto& place : places) {
    json spoilt = document;
    spoilt[place.parent_pointer()].erase(place.back());
    EXPECT_THAT(reading(spoilt), complains(file().string(), place.to_string() + " is missing"));
  }
}

TEST_F(ModelFile, NamesEveryEntryOfTheWrongKind) {
  const json document = to_json(awkward_model());
  const json leaves = document.flatten();
  for (const auto& [text, value] : leaves.items()) {
    const json::json_pointer place(text);
    if (text == "/moment") continue;
    for (const json& wrong : {json(nullptr), json(true), json::array({1., 2.}), json{{"a", 1}}}) {
      json spoilt = document;
      spoilt[place] = wrong;
      EXPECT_THAT(reading(spoilt), complains(file().string(), ": " + text + " must be "));
    }
    json spoilt = document;
    if (value.is_number())
      spoilt[place] = "NaN";
    else
      spoilt[place] = 3.;
    EXPECT_THAT(reading(spoilt), complains(file().string(), ": " + text + " must be "));
  }
}

TEST_F(ModelFile, NamesListsOfTheWrongKindAndVectorsOfTheWrongLength) {
  const json document = to_json(awkward_model());
  for (const auto& place : named_entries(document)) {
    if (!document[place].is_structured()) continue;
    json spoilt = document;
    spoilt[place] = "nothing";
    EXPECT_THAT(reading(spoilt), complains(file().string(), place.to_string() + " must be"));
  }
  for (const char* text :
       {"/axial_direction", "/modes/1/participation_sqrt_kg", "/rigid_moment_kg_m",
        "/rigid_moment_kg_m/2", "/wind/moment_coefficient_N_s2_per_m/0"}) {
    json spoilt = document;
    spoilt[json::json_pointer(text)].push_back(1.);
    EXPECT_THAT(reading(spoilt),
                complains(file().string(), std::string(text) + " must be an array of 3"));
  }
}

TEST_F(ModelFile, NamesTheFileOfAModelThatCannotBe) {
  json document = to_json(awkward_model());
  document["modes"][1]["damping_ratio"] = -0.1;
  EXPECT_THAT(reading(document),
              complains(file().string(), "modes[1].damping_ratio = -0.1 is negative"));
  document = to_json(awkward_model());
  document["wind"]["speed_m_s"].push_back(5.);
  EXPECT_THAT(reading(document), complains(file().string(), "has 2 entries instead of 3"));
}

TEST_F(ModelFile, RefusesAnotherSchema) {
  json document = to_json(awkward_model());
  document["schema"] = "vibrissa-model-2";
  EXPECT_THAT(reading(document),
              complains(file().string(), "/schema must be \"vibrissa-model-1\", but is"));
}

TEST_F(ModelFile, RefusesWhatIsNoJson) {
  for (const char* text :
       {"", "{", "{\"schema\": NaN}", "{\"schema\": 1e999}", "\xff\xfe", "[1,]"}) {
    write_text(text);
    EXPECT_THAT([&] { read_reduced_model(file()); }, complains(file().string(), "not valid JSON"));
  }
  for (const char* text : {"[]", "3", "null", "\"vibrissa-model-1\""}) {
    write_text(text);
    EXPECT_THAT([&] { read_reduced_model(file()); },
                complains(file().string(), ": the document must be a JSON object"));
  }
}

TEST_F(ModelFile, RefusesAFileThatIsNotThere) {
  EXPECT_THAT([&] { read_reduced_model(file()); }, complains(file().string(), "cannot be opened"));
}

TEST_F(ModelFile, IsNotWrittenForAModelThatCannotBe) {
  auto model = awkward_model();
  model.modes[0].participation[1] = NAN;
  EXPECT_THAT([&] { write_reduced_model(file(), model); },
              ThrowsMessage<UserError>(HasSubstr("modes[0].participation[1] = nan")));
  EXPECT_FALSE(std::filesystem::exists(file()));
}

}  // namespace
}  // namespace vibrissa::signals
