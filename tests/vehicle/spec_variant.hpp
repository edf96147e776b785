// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

namespace grouser::test {

/// One key of a vehicle file with another value: {"road_wheel", "spacing", "0.3"}.
struct KeyChange {
  std::string section, key, value;
};

/// The shipped vehicle's file with modified keys, in its own place for the lifetime of the object.
class SpecVariant {
public:
  explicit SpecVariant(const std::vector<KeyChange>& changes) {
    std::stringstream text;
    text << std::ifstream(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml").rdbuf();
    text_ = text.str();
    change({"vehicle", "mesh_folder", "\"" GROUSER_SOURCE_DIR "/assets/meshes\""});
    for (const KeyChange& c : changes) change(c);
    // Process and object are part of the name: tests run in parallel.
    static int number = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("grouser_variant_" + std::to_string(getpid()) + "_" + std::to_string(number++) + ".toml");
    std::ofstream(path_) << text_;
  }
  ~SpecVariant() { std::filesystem::remove(path_); }
  SpecVariant(const SpecVariant&) = delete;
  SpecVariant& operator=(const SpecVariant&) = delete;

  std::string path() const { return path_.string(); }

private:
  void change(const KeyChange& c) {
    const std::size_t section = text_.find("\n[" + c.section + "]\n");
    const std::size_t line = section == std::string::npos ? section : text_.find("\n" + c.key + " = ", section);
    if (line == std::string::npos) {
      ADD_FAILURE() << "no " << c.section << "." << c.key << " in the vehicle file";
      return;
    }
    const std::size_t end = text_.find('\n', line + 1);
    text_.replace(line + 1, end - line - 1, c.key + " = " + c.value);
  }

  std::string text_;
  std::filesystem::path path_;
};

} // namespace grouser::test
