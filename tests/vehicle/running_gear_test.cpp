// SPDX-License-Identifier: BSD-3-Clause
// Invalid vehicles: one clear error each, with advice that works.
#include "vehicle/running_gear.hpp"

#include "base/error.hpp"
#include "tests/vehicle/spec_variant.hpp"
#include "vehicle/spec_file.hpp"
#include "vehicle/wrap.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <ostream>
#include <regex>

using namespace grouser;
using test::KeyChange;
using test::SpecVariant;

namespace {

/// An invalid vehicle file, and the required parts of its message.
struct Impossible {
  std::string name;
  KeyChange change;
  std::vector<std::string> words;
};
std::ostream& operator<<(std::ostream& out, const Impossible& i) { return out << i.name; }

class ImpossibleVehicle : public ::testing::TestWithParam<Impossible> {};

std::string refusalOf(const std::vector<KeyChange>& changes) {
  const SpecVariant variant(changes);
  try {
    vehicle::readVehicleSpec(variant.path());
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

/// A change as in the message, "set roller.z[1] = 0.09": lists keep the other values of the faulty file.
KeyChange adviceIn(const std::string& message, const KeyChange& fault) {
  std::smatch m;
  if (!std::regex_search(message, m,
                         std::regex(R"(set (every entry of )?([a-z_]+)\.([a-z_]+)(\[(\d)\])? = ([-0-9.e+]+))")))
    return {};
  if (m[1].matched) return {m[2], m[3], fmt::format("[{0}, {0}, {0}]", m[6].str())};
  if (!m[4].matched) return {m[2], m[3], m[6]};
  std::vector<std::string> values = m[3] == "x" ? std::vector<std::string>{"0.70", "1.38", "2.06"}
                                                : std::vector<std::string>{"0.1283", "0.1300", "0.1317"};
  if (fault.section == "roller" && fault.key == m[3]) {
    std::stringstream list(fault.value.substr(1));
    for (std::string& v : values) std::getline(list, v, ',');
    values.back() = values.back().substr(0, values.back().find(']'));
  }
  values[std::stoul(m[5])] = m[6];
  return {m[2], m[3], "[" + values[0] + ", " + values[1] + ", " + values[2] + "]"};
}

TEST_P(ImpossibleVehicle, IsRefusedByNameAndPlace) {
  const Impossible& p = GetParam();
  const std::string message = refusalOf({p.change});
  ASSERT_NE(message, "") << "was accepted";
  EXPECT_TRUE(std::regex_search(message, std::regex(R"(\.toml:\d+: [a-z_]+\.[a-z_]+ = )"))) << message;
  for (const std::string& word : p.words)
    EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST_P(ImpossibleVehicle, AdviceMendsIt) {
  const Impossible& p = GetParam();
  const std::string message = refusalOf({p.change});
  const KeyChange advice = adviceIn(message, p.change);
  if (advice.key.empty()) {
    // Keys with a range in the table, and keys without a single valid number, state the required condition.
    EXPECT_TRUE(std::regex_search(
        message,
        std::regex("is outside|not finite|as many values|choose|must be in|no single change|not physical|at least")))
        << message;
    return;
  }
  const std::string after = refusalOf({p.change, advice});
  EXPECT_EQ(after, "") << "after: " << message;
}

INSTANTIATE_TEST_SUITE_P(
    Variants, ImpossibleVehicle,
    ::testing::Values(
        Impossible{"RoadWheelsOverlap",
                   {"road_wheel", "spacing", "0.30"},
                   {"road wheel 0 and road wheel 1 overlap by 80.0 mm"}},
        Impossible{"LastWheelInIdler", {"road_wheel", "spacing", "0.60"}, {"idler and road wheel 4 overlap by"}},
        Impossible{"TooManyWheels", {"road_wheel", "count", "7"}, {"idler and road wheel 5 overlap by"}},
        Impossible{"FirstWheelInSprocket", {"road_wheel", "first_x", "0.3"}, {"sprocket and road wheel 0 overlap by"}},
        Impossible{"WheelsTooFarAhead", {"road_wheel", "first_x", "0.9"}, {"idler and road wheel 4 overlap by"}},
        Impossible{"WheelInTheRisingStrand", {"road_wheel", "first_x", "0.56"}, {"road wheel 4 and shoe", "mm"}},
        Impossible{"WheelsTooLarge", {"road_wheel", "radius", "0.25"}, {"idler and road wheel 4 overlap by 6.8 mm"}},
        Impossible{"WheelAboveTheStrand", {"road_wheel", "z", "-0.02"}, {"road wheel 0", "overlap by"}},
        Impossible{"WheelsTooLow", {"road_wheel", "z", "-0.25"}, {"close only with the idler at", "mm"}},
        Impossible{"RollerPushesUpTheTrack", {"roller", "z", "[0.15, 0.13, 0.1317]"}, {"roller 0 and shoe", "21.4 mm"}},
        Impossible{
            "RollerBelowTheGround", {"roller", "z", "[0.1283, -0.6, 0.1317]"}, {"roller 1 outside the track loop"}},
        Impossible{"RollerInWheel", {"roller", "z", "[0.1283, 0.0, 0.1317]"}, {"road wheel 2 and roller 1 overlap"}},
        Impossible{
            "RollerAboveTheTrack", {"roller", "z", "[0.1283, 0.6, 0.1317]"}, {"roller 1 outside the track loop"}},
        Impossible{"RollerInSprocket", {"roller", "x", "[0.3, 1.38, 2.06]"}, {"sprocket and roller 0", "12.9 mm"}},
        Impossible{"RollersOverlap", {"roller", "x", "[0.7, 0.8, 2.06]"}, {"roller 0 and roller 1", "80.0 mm"}},
        Impossible{"RollerInIdler", {"roller", "x", "[0.7, 1.38, 2.6]"}, {"idler and roller 2 overlap by"}},
        Impossible{"RollersTooLarge", {"roller", "radius", "0.2"}, {"road wheel 0 and roller 0 overlap by"}},
        Impossible{"RollerWithoutHeight", {"roller", "z", "[0.1283, 0.13]"}, {"as many values"}},
        Impossible{"ShoeTooFew", {"shoe", "count", "45"}, {"-80.7 mm", "outside its slide", "shoe.count = 46"}},
        Impossible{"HalfTheShoes", {"shoe", "count", "24"}, {"does not close", "-3385.7 mm"}},
        Impossible{"TooManyShoes", {"shoe", "count", "60"}, {"close only with", "outside its slide"}},
        Impossible{"PitchTooLong", {"shoe", "pitch", "0.16"}, {"folds neighbouring shoes by 0.6511 rad"}},
        Impossible{"PadsWiderThanPitch", {"shoe", "pitch", "0.13"}, {"neighbouring shoes overlap by 6.0 mm"}},
        Impossible{"PlatesLongerThanPitch", {"shoe", "half_length", "0.08"}, {"overlap by 6.0 mm", "(0, 0.077)"}},
        Impossible{"PlatesTouchAtTheFold", {"shoe", "half_length", "0.075"}, {"touch at 0.1993 rad"}},
        Impossible{"PlatesTooHighForTheFold", {"shoe", "plate_top", "0.08"}, {"touch at"}},
        Impossible{"FoldBeyondThePlates", {"shoe", "maximum_fold", "1.2"}, {"touch at 0.8457 rad"}},
        Impossible{"HornsReachAxles", {"shoe", "horn_height", "0.1"}, {"10.0 mm beyond the axles"}},
        Impossible{"PadAboveThePins", {"shoe", "pad_bottom", "0.02"}, {"is outside"}},
        Impossible{"NegativeGrouser", {"shoe", "grouser_height", "-0.01"}, {"is outside"}},
        Impossible{"IdlerTooFar", {"idler", "x", "3.2"}, {"-452.6 mm", "outside its slide"}},
        Impossible{"IdlerInSprocket", {"idler", "x", "0.4"}, {"sprocket and idler overlap by 66.2 mm"}},
        Impossible{"IdlerTooHigh", {"idler", "z", "0.3"}, {"does not close"}},
        Impossible{"IdlerTooSmall", {"idler", "radius", "0.1"}, {"folds neighbouring shoes"}},
        Impossible{"IdlerTooLarge", {"idler", "radius", "0.4"}, {"idler and road wheel 4 overlap by 129.8 mm"}},
        Impossible{"IdlerSlidesIntoWheel", {"idler", "slide_min", "-0.1"}, {"road wheel 4", "idler's rear stop"}},
        Impossible{"StopBeforeTheStart", {"idler", "slide_min", "0.02"}, {"is outside"}},
        Impossible{"NoTravel", {"idler", "slide_max", "0"}, {"front stop"}},
        Impossible{"TravelPastStops", {"idler", "slide_max", "-0.01"}, {"is outside"}},
        Impossible{"NoTension", {"idler", "preload", "0"}, {"slack"}},
        Impossible{"TensionPulls", {"idler", "preload", "-9200"}, {"is outside"}},
        Impossible{"TensionAboveTheWeight", {"idler", "preload", "1e6"}, {"weight of 49210 N", "(0, 98420]"}},
        Impossible{"TensionNoSpringGives", {"idler", "stiffness", "1000"}, {"compression of 9200 mm"}},
        Impossible{"TooFewTeeth", {"sprocket", "teeth", "8"}, {"at least 10 teeth"}},
        Impossible{"TooManyTeeth", {"sprocket", "teeth", "20"}, {"sprocket and road wheel 0 overlap by 105.0 mm"}},
        Impossible{"ArmsWithoutSpring", {"arm", "stiffness", "0"}, {"hull sink"}},
        Impossible{"ArmsLiftTheHull", {"arm", "preload", "50000"}, {"lifts the hull"}},
        Impossible{"ArmPivotsBelowTheTrack", {"arm", "pivot_angle", "-1"}, {"20.4 mm below the plates"}},
        Impossible{"TipsOver", {"chassis", "centre", "[3.0, 0.0, 0.1]"}, {"671.8 mm ahead of all road wheels"}},
        Impossible{"TipsSideways", {"chassis", "centre", "[1.4, 1.5, 0.1]"}, {"550.0 mm outside the tracks"}},
        Impossible{"TracksOverlap", {"vehicle", "track_offset", "0.1"}, {"left and right shoes overlap by 80.0 mm"}},
        Impossible{"RollersAllInTheWheels", {"roller", "z", "[0.0, 0.0, 0.0]"}, {"set every entry of roller.z = "}},
        Impossible{"IdlerAsLargeAsTheVehicle", {"idler", "radius", "2"}, {"idler.radius = 2 [m]", "423.2 mm"}},
        Impossible{"IdlerBelowTheGround", {"idler", "z", "-0.3"}, {"idler.z = -0.3 [m]", "149.2 mm above"}},
        Impossible{"IdlerOutOfSight", {"idler", "x", "15"}, {"shoe.count = 46 [-]: the track does not close"}},
        Impossible{"FoldOfNoChain", {"shoe", "maximum_fold", "0.1"}, {"shoe.maximum_fold = 0.1 [rad]", "63 teeth"}},
        Impossible{"PlatesFarTooHigh", {"shoe", "plate_top", "0.2"}, {"shoe.plate_top = 0.2 [m] lets"}},
        Impossible{"StopThatStopsNothing", {"idler", "stop_stiffness", "1e-3"}, {"softer than the tensioner spring"}},
        Impossible{"SoftAsFoam", {"contact", "foundation_modulus", "1e6"}, {"a tenth of their 60 mm", "4.60e+07"}},
        Impossible{"HeavierThanAPlanet", {"chassis", "mass", "1e300"}, {"is outside [0.001, 1e+06]"}},
        Impossible{"MassOfNothing", {"chassis", "mass", "nan"}, {"not finite; use a finite number"}},
        Impossible{"InertiaBelowZero", {"shoe", "inertia", "[-1, 1, 1]"}, {"is outside (0, 1e+08]"}},
        Impossible{"BarOfDiamond", {"arm", "stiffness", "1e308"}, {"is outside [0, 1e+09]"}},
        Impossible{"NoMass", {"shoe", "mass", "0"}, {"is outside"}},
        Impossible{"ImpossibleInertia", {"shoe", "inertia", "[0.064, 0.020, 0.2]"}, {"is not physical"}}),
    [](const auto& tested) { return tested.param.name; });

TEST(RunningGear, PadsThatYieldByMoreThanATenthOfTheirHeight_AreRefused) {
  vehicle::VehicleSpec spec = vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml");
  // A tenth of the weight on a pad of 136 x 280 mm.
  const double least = 501.8 * 9.81 / (0.136 * 0.28 * 0.1 * -spec.shoe.padBottom);
  spec.contact.padModulus = 1.01 * least;
  EXPECT_FALSE(vehicle::runningGearFault(spec).has_value());
  spec.contact.padModulus = 0.99 * least;
  const auto fault = vehicle::runningGearFault(spec);
  ASSERT_TRUE(fault.has_value());
  EXPECT_NE(fault->message.find("more than a tenth of its height"), std::string::npos) << fault->message;
}

TEST(RunningGear, ShippedVehicle_IsSound) {
  const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml");
  EXPECT_FALSE(vehicle::runningGearFault(spec).has_value());
}

/// Tries only splits of the shoes that can end at the idler; all splits yield the same loop.
/// All changes of "set together road_wheel.count = 6, ..., roller.x = [0.7, 1.4, 2.1]"; empty without this text.
std::vector<KeyChange> togetherIn(const std::string& message) {
  std::vector<KeyChange> changes;
  const std::size_t from = message.find("set together ");
  if (from == std::string::npos) return changes;
  const std::regex key(R"(([a-z_]+)\.([a-z_]+) = (\[[^\]]*\]|[-0-9.e+]+))");
  for (std::sregex_iterator m(message.begin() + static_cast<std::ptrdiff_t>(from), message.end(), key), end; m != end;
       ++m)
    changes.push_back({(*m)[1], (*m)[2], (*m)[3]});
  return changes;
}

TEST(VehicleOfOtherNumbers, WorksAtTheFirstRetry) {
  struct Numbers {
    int wheels, shoes;
  };
  for (const auto& [wheels, shoes] : {Numbers{6, 48}, {4, 40}}) {
    const std::vector<KeyChange> asked{{"road_wheel", "count", std::to_string(wheels)},
                                       {"shoe", "count", std::to_string(shoes)}};
    const std::string message = refusalOf(asked);
    if (message.empty()) continue;
    std::vector<KeyChange> changes = togetherIn(message);
    if (changes.empty()) { // a single key is enough
      changes = asked;
      changes.push_back(adviceIn(message, asked.front()));
    }
    EXPECT_EQ(refusalOf(changes), "") << message;
  }
  const std::vector<KeyChange> six = togetherIn(refusalOf({{"road_wheel", "count", "6"}, {"shoe", "count", "48"}}));
  ASSERT_GE(six.size(), 5u);
  EXPECT_EQ(six[0].value, "6");
  EXPECT_EQ(six[3].value, "48");
}

TEST(VehicleOfOtherNumbers, AnotherNumberOfWheelsAloneIsKeptByASetOfKeys) {
  for (const char* wheels : {"4", "6", "7"}) {
    const std::string message = refusalOf({{"road_wheel", "count", wheels}});
    if (message.empty()) continue;
    const std::vector<KeyChange> changes = togetherIn(message);
    ASSERT_GE(changes.size(), 5u) << message;
    EXPECT_EQ(changes[0].value, wheels) << message;
    EXPECT_EQ(refusalOf(changes), "") << message;
  }
}

TEST(RunningGear, AdviceOfClosure_IsFoundFromFarAway) {
  for (const char* count : {"40", "52", "58"}) {
    const std::string message = refusalOf({{"shoe", "count", count}});
    const KeyChange advice = adviceIn(message, {});
    EXPECT_EQ(refusalOf({{"shoe", "count", count}, advice}), "") << message;
  }
}

} // namespace
