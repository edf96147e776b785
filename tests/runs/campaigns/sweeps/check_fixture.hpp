// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/runs/program_fixture.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <string>

namespace grouser::test {

/// Scenes with a quick check, and its files.
class Check : public ProgramTest {
protected:
  using Json = nlohmann::json;
  static constexpr const char* kQuiet = "[output]\nplots = false\npicture = false\nframes = false\n";

  /// A grain in free fall for 0.1 s. Symplectic Euler falls too far by g T h / 2, exactly.
  void writeFall() const {
    std::ofstream(folder_ / "fall.toml")
        << "version = 1\n[run]\nduration = 0.1\ntime_step = 1e-3\noutput_interval = 0.01\nthreads = 1\n"
           "[material.glass]\n[[grain]]\nposition = [0, 0, 1]\nradius = 0.01\nmaterial = \"glass\"\n"
        << kQuiet;
  }
  /// Some grains at random positions that fall onto a plane.
  void writeHeap() const {
    std::ofstream(folder_ / "heap.toml")
        << "version = 1\n[run]\nduration = 0.05\ntime_step = 2e-4\noutput_interval = 0.01\nthreads = 1\n"
           "[material.glass]\nstiffness = 1e4\n[[grains]]\nform = \"random\"\nnumber = 30\nlow = [0, 0, 0]\n"
           "high = [0.15, 0.15, 0.1]\nradius = 0.01\nmaterial = \"glass\"\n"
           "[[plane]]\nname = \"ground\"\nmaterial = \"glass\"\n"
        << kQuiet;
  }
  Json json(const std::string& name) const { return Json::parse(contents((folder_ / name).string())); }
  static Json figure(const Json& check, const std::string& name) {
    for (const Json& f : check.at("figures"))
      if (f.at("name") == name) return f;
    ADD_FAILURE() << name << " is missing";
    return {};
  }
  static Json errorBy(const Json& figure, const std::string& axis) {
    for (const Json& e : figure.at("errors"))
      if (e.at("axis") == axis) return e;
    ADD_FAILURE() << axis << " is missing";
    return {};
  }
};

} // namespace grouser::test
