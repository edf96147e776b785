// SPDX-License-Identifier: BSD-3-Clause
// Suggested key for an unknown one, from all sections of a file; or none.
#include "base/nearest_key.hpp"

#include <gtest/gtest.h>

#include <string>

namespace grouser::base {
namespace {

const std::vector<std::string> kSections{"roller", "idler", "sprocket"};
const std::vector<std::string> kKeys{"roller.x", "roller.radius", "idler.radius", "sprocket.speed"};

std::string messageFor(const std::string& section, const std::string& key, const std::string& nearest) {
  return amongAllKeys(UnknownKey({"car.toml:3", "", section, {key}, kSections}, nearest), kKeys).what();
}

TEST(UnknownKey, ASectionIsNotGuessedByAKeyOfOneLetter) {
  EXPECT_EQ(messageFor("blorp", "x", ""), "car.toml:3: unknown section blorp (valid here: roller, idler, sprocket)");
  EXPECT_NE(messageFor("engine", "speed", "").find("did you mean sprocket.speed?"), std::string::npos);
  EXPECT_NE(messageFor("rollr", "x", "roller").find("did you mean roller?"), std::string::npos);
}

} // namespace
} // namespace grouser::base
