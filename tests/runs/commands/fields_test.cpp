// SPDX-License-Identifier: BSD-3-Clause
// The documents agree with the program's keys and scenes.
#include "runs/commands/fields.hpp"
#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

const fs::path kDocuments = fs::path(GROUSER_SOURCE_DIR) / "docs";

/// The indented blocks of a document that begin with `version = 1`, without indentation.
std::vector<std::string> scenesIn(const fs::path& document) {
  std::istringstream lines(contents(document));
  std::vector<std::string> scenes;
  bool within = false;
  for (std::string line; std::getline(lines, line);) {
    const bool indented = line.rfind("    ", 0) == 0;
    if (indented && line.rfind("    version = 1", 0) == 0) scenes.emplace_back(), within = true;
    within = within && (indented || line.empty());
    if (within) scenes.back() += (indented ? line.substr(4) : line) + "\n";
  }
  return scenes;
}

using Documents = ProgramTest;

TEST_F(Documents, KeysAreThoseOfTheProgram) {
  EXPECT_EQ(contents(kDocuments / "keys.md"), keysDocument())
      << "update it: build/bin/grouser fields --markdown > docs/keys.md";
}

TEST_F(Documents, FilesOfResultsAreThoseOfTheProgram) {
  EXPECT_EQ(contents(kDocuments / "files.md"), filesDocument())
      << "update it: build/bin/grouser fields --files > docs/files.md";
  EXPECT_EQ(call("fields --files").out, filesDocument());
  EXPECT_EQ(call("fields --files --soil").code, 2);
}

TEST_F(Documents, FieldsPrintWhatIsAskedFor) {
  EXPECT_EQ(call("fields --markdown").out, keysDocument());
  const Outcome vehicle = call("fields --vehicle");
  EXPECT_NE(vehicle.out.find("| `friction_ground` | - | required | [0, 5]; usually 0.05 to 2 |"), std::string::npos)
      << vehicle.out;
  EXPECT_EQ(vehicle.out.find("`[run]`"), std::string::npos);
  EXPECT_EQ(call("fields --vehicle --markdown").code, 2);
}

TEST_F(Documents, EveryRowOfTheKeysHasFiveCells) {
  std::istringstream lines(keysDocument());
  int rows = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("| `", 0) != 0) continue;
    EXPECT_EQ(std::count(line.begin(), line.end(), '|'), 6) << line;
    ++rows;
  }
  EXPECT_GT(rows, 200);
}

TEST_F(Documents, ScenesCanBePlanned) {
  const std::vector<std::string> scenes = scenesIn(kDocuments / "scenes.md");
  ASSERT_EQ(scenes.size(), 2u) << "one with grains, one with a vehicle";
  for (const std::string& scene : scenes) {
    put(folder_ / "scene.toml", scene);
    const Outcome o = call("plan scene.toml --no-probe");
    EXPECT_EQ(o.code, 0) << o.errors << scene;
  }
}

} // namespace
} // namespace grouser::commands
