#include "renderer/parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "renderer/error.h"
#include "renderer/frame/common_parameters.h"

namespace penumbra {
namespace {

using testing::HasSubstr;

std::vector<Parameter> declared() {
  return {
      {.name = "map_size",
       .type = ParameterType::integer,
       .default_value = std::int64_t{512},
       .minimum = 1,
       .maximum = 16384,
       .unit = "texels"},
      {.name = "bias", .default_value = 0.01, .minimum = -1.0, .maximum = 1000.0, .unit = "m"},
      {.name = "clamp", .type = ParameterType::boolean, .default_value = false},
      {.name = "blur",
       .type = ParameterType::choice,
       .default_value = std::string("box"),
       .choices = {"box", "gauss", "7"}},
  };
}

Error refusal_of(const ParameterValues& given) {
  try {
    complete_parameters(declared(), given);
  } catch (const Error& error) {
    return error;
  }
  return {"none", "every value was accepted"};
}

TEST(Parameters, TakeTheirDefaults) {
  const ParameterValues values = complete_parameters(declared(), {});
  EXPECT_EQ(values.size(), 4u);
  EXPECT_EQ(integer_of(values, "map_size"), 512);
  EXPECT_EQ(real_of(values, "bias"), 0.01);
  EXPECT_FALSE(boolean_of(values, "clamp"));
  EXPECT_EQ(choice_of(values, "blur"), "box");
}

TEST(Parameters, ConvertWhereNothingIsLost) {
  const auto completed = [](const std::string& name, const ParameterValue& value) {
    return complete_parameters(declared(), {{name, value}}).at(name);
  };
  EXPECT_EQ(completed("map_size", 64.0), ParameterValue(std::int64_t{64}));
  EXPECT_EQ(completed("map_size", std::string("64")), ParameterValue(std::int64_t{64}));
  EXPECT_EQ(completed("map_size", std::string("1e3")), ParameterValue(std::int64_t{1000}));
  EXPECT_EQ(completed("bias", std::int64_t{3}), ParameterValue(3.0));
  EXPECT_EQ(completed("bias", std::string("0.25")), ParameterValue(0.25));
  EXPECT_EQ(completed("clamp", std::string("true")), ParameterValue(true));
  EXPECT_EQ(completed("clamp", std::string("false")), ParameterValue(false));
  EXPECT_EQ(completed("blur", std::int64_t{7}), ParameterValue(std::string("7")));
}

TEST(Parameters, HaveOneZero) {
  const ParameterValues values = complete_parameters(declared(), {{"bias", -0.0}});
  EXPECT_FALSE(std::signbit(real_of(values, "bias")));
}

TEST(Parameters, RefuseWhatWouldLoseSomething) {
  EXPECT_EQ(refusal_of({{"map_size", 1.5}}).field, "map_size");
  EXPECT_EQ(refusal_of({{"map_size", 1e300}}).field, "map_size");
  EXPECT_EQ(refusal_of({{"map_size", true}}).field, "map_size");
  EXPECT_EQ(refusal_of({{"map_size", std::string("512 texels")}}).field, "map_size");
  EXPECT_EQ(refusal_of({{"map_size", std::string("99999999999999999999")}}).field, "map_size");
  EXPECT_EQ(refusal_of({{"bias", std::string("")}}).field, "bias");
  EXPECT_EQ(refusal_of({{"bias", std::string(" 1")}}).field, "bias");
  EXPECT_EQ(refusal_of({{"bias", true}}).field, "bias");
  EXPECT_EQ(refusal_of({{"clamp", std::int64_t{1}}}).field, "clamp");
  EXPECT_EQ(refusal_of({{"clamp", std::string("yes")}}).field, "clamp");
  EXPECT_EQ(refusal_of({{"blur", true}}).field, "blur");
}

TEST(Parameters, RefuseValuesThatAreNoNumbers) {
  EXPECT_EQ(refusal_of({{"bias", std::numeric_limits<double>::quiet_NaN()}}).field, "bias");
  EXPECT_EQ(refusal_of({{"bias", std::numeric_limits<double>::infinity()}}).field, "bias");
  EXPECT_EQ(refusal_of({{"bias", std::string("nan")}}).field, "bias");
  EXPECT_EQ(refusal_of({{"map_size", std::string("inf")}}).field, "map_size");
}

TEST(Parameters, IncludeTheEndsOfTheirRanges) {
  EXPECT_EQ(refusal_of({{"map_size", std::int64_t{1}}}).code, "none");
  EXPECT_EQ(refusal_of({{"map_size", std::int64_t{16384}}}).code, "none");
  EXPECT_EQ(refusal_of({{"map_size", std::int64_t{0}}}).code, "bad_value");
  EXPECT_EQ(refusal_of({{"map_size", std::int64_t{16385}}}).code, "bad_value");
}

TEST(Parameters, SayWhatIsAllowed) {
  EXPECT_STREQ(refusal_of({{"map_size", 0.5}}).what(),
               "parameter map_size must be a whole number from 1 to 16384 texels, not \"0.5\"");
  EXPECT_STREQ(refusal_of({{"blur", std::string("median")}}).what(),
               "parameter blur must be one of box, gauss, 7, not \"median\"");
  EXPECT_THAT(refusal_of({{"clamp", 2.0}}).what(), HasSubstr("true or false"));
}

TEST(Parameters, RefuseNamesThatNobodyDeclared) {
  const Error error = refusal_of({{"mapsize", std::int64_t{64}}, {"bias", std::string("x")}});
  EXPECT_EQ(error.code, "bad_value");
  EXPECT_EQ(error.field, "mapsize");
  EXPECT_STREQ(error.what(),
               "there is no parameter mapsize here; there are: map_size, bias, clamp, blur");
}

TEST(Parameters, ReadUnderAnotherTypeOrNameAreADefect) {
  const ParameterValues values = complete_parameters(declared(), {});
  EXPECT_THROW(real_of(values, "map_size"), std::logic_error);
  EXPECT_THROW(choice_of(values, "clamp"), std::logic_error);
  EXPECT_THROW(integer_of(values, "taps"), std::logic_error);
}

TEST(Parameters, WriteRealsThatReadBackEqual) {
  for (const double value : {0.1, 1.0 / 3.0, 1e-300, 123456789.123456789, -2.5}) {
    EXPECT_EQ(std::stod(to_text(value)), value);
  }
  EXPECT_EQ(to_text(0.25), "0.25");
  EXPECT_EQ(to_text(true), "true");
  EXPECT_EQ(to_text(std::int64_t{-3}), "-3");
}

TEST(CommonParameters, SayHowOftenColorsAreDecodedAndWhetherThePictureIsEncoded) {
  const auto treatment = [](const std::string& choice) {
    const GammaTreatment gamma =
        gamma_treatment(complete_parameters(common_parameters(), {{"gamma", choice}}));
    return std::pair(gamma.decodes, gamma.encodes);
  };
  EXPECT_EQ(treatment("correct"), std::pair(1, true));
  EXPECT_EQ(treatment("off"), std::pair(0, false));
  EXPECT_EQ(treatment("input_only"), std::pair(1, false));
  EXPECT_EQ(treatment("output_only"), std::pair(0, true));
  EXPECT_EQ(treatment("input_twice"), std::pair(2, true));
  EXPECT_EQ(treatment("textures_encoded_twice"), std::pair(1, true));
}

TEST(Parameters, HaveAnEffectOnlyWithAChoiceTheyNeed) {
  std::vector<Parameter> list = declared();  // blur is box unless given
  list.push_back({.name = "deviation",
                  .default_value = 0.5,
                  .meaning = "of the bell",
                  .only_with = Choices{"blur", {"gauss", "bell"}}});
  const Parameter& deviation = list.back();
  EXPECT_FALSE(has_effect(deviation, list, {}));
  EXPECT_FALSE(has_effect(deviation, list, {{"blur", std::string("box")}}));
  EXPECT_TRUE(has_effect(deviation, list, {{"blur", std::string("gauss")}}));
  EXPECT_TRUE(has_effect(deviation, list, {{"blur", std::string("bell")}}));
  EXPECT_TRUE(has_effect(list.front(), list, {}));
}

TEST(CommonParameters, HandleGammaCorrectlyUnlessAsked) {
  EXPECT_EQ(choice_of(complete_parameters(common_parameters(), {}), "gamma"), "correct");
}

}  // namespace
}  // namespace penumbra
