// SPDX-License-Identifier: BSD-3-Clause
// `grouser check` on deformable soil: halved nodes, samples of the constants, and no grain axes.
#include "runs/campaigns/sweeps/check_cases.hpp"
#include "runs/setup/load_scene.hpp"
#include "tests/message_of.hpp"
#include "tests/runs/campaigns/sweeps/check_fixture.hpp"
#include "tests/runs/shared_cache.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace grouser::sweeps {

using namespace test; // fixtures

namespace {

class DeformableSoil : public Check {
protected:
  void writeDrive(const std::string& scm = "") const {
    put(folder_ / "drive.toml",
        "version = 1\n[run]\nduration = 0.1\ntime_step = 1e-4\noutput_interval = 0.02\nthreads = 1\n[terrain]\nkind = "
        "\"scm\"\nmaterial = \"lete_sand\"\nheightmap = \"heightmaps/flat.png\"\nsize = [8, 4]\nheight_range = [0, "
        "0]\n[vehicle]\nspec = \"vehicles/light_tracked.toml\"\n[driver]\nweight_ramp = 0.01\ntension_ramp = 0.01\n" +
            scm + kQuiet);
  }
  CheckCases cases(int draws) const {
    const auto file = folder_ / "drive.toml";
    return checkCases(file, {}, setup::loadScene(file), draws);
  }
  static std::vector<CheckCase> of(const CheckCases& all, CheckAxis axis) {
    std::vector<CheckCase> found;
    std::copy_if(all.cases.begin(), all.cases.end(), std::back_inserter(found),
                 [axis](const CheckCase& c) { return c.axis == axis; });
    return found;
  }
};

TEST_F(DeformableSoil, HasNodesAndSamplesInPlaceOfGrains) {
  writeDrive();
  const CheckCases all = cases(3);
  EXPECT_FALSE(all.seeded);
  const std::vector<CheckCase> nodes = of(all, CheckAxis::nodeSpacing);
  ASSERT_EQ(nodes.size(), 1u);
  EXPECT_EQ(nodes[0].refused, "");
  EXPECT_EQ(nodes[0].overrides.at(0), "scm.node_spacing=0.017") << "half of a quarter of a shoe";
  const std::vector<CheckCase> samples = of(all, CheckAxis::parameter);
  ASSERT_EQ(samples.size(), 3u);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(samples[k].overrides.at(0), "scm.constants_draw=" + std::to_string(k + 1));
  std::set<std::string> reasons;
  for (const CheckOmission& o : all.omitted) reasons.insert(o.why);
  EXPECT_EQ(reasons, (std::set<std::string>{"deformable soil has no grains and no seeds"}));
  EXPECT_TRUE(of(cases(0), CheckAxis::parameter).empty());
}

TEST_F(DeformableSoil, SamplesNeedConstantsToDraw) {
  writeDrive("[scm]\nconstants_draw = 2\n");
  EXPECT_NE(messageOf([&] { cases(3); }).find("scm.constants_draw = 2"), std::string::npos);
  writeDrive("[scm]\nn = 1\nk_c = 0\nk_phi = 5e6\nc = 1e3\nphi = 30\nK = 0.01\n");
  EXPECT_NE(messageOf([&] { cases(3); }).find("has no effect, since n, k_c, k_phi, c, phi and K are all set"),
            std::string::npos);
  EXPECT_NO_THROW(cases(0));
  writeFall();
  const Outcome fall = call("check fall.toml --draws 3");
  EXPECT_EQ(fall.code, 2);
  EXPECT_NE(fall.error().find("--draws 3: requires deformable soil"), std::string::npos) << fall.errors;
  writeDrive();
  const Outcome axes = call("check drive.toml --axes parameter");
  EXPECT_EQ(axes.code, 2);
  EXPECT_NE(axes.error().find("add --draws"), std::string::npos) << axes.errors;
}

TEST_F(DeformableSoil, AnErrorOfTheParametersStandsBesideThatOfTheNodes) {
  writeDrive();
  const Outcome o =
      shell(withSharedCache() + "\"$grouser\" check drive.toml --axes node_spacing --draws 3 --out c --jobs 2");
  ASSERT_EQ(o.code, 0) << o.errors;
  const Json check = json("c/check.json");
  const Json error = figure(check, "integration error [J]"); // the vehicle has not driven yet
  const Json parameter = errorBy(error, "parameter"), nodes = errorBy(error, "node_spacing");
  EXPECT_EQ(parameter.at("seeds"), 3);
  EXPECT_GT(parameter.at("half_width").get<double>(), 0) << "the samples differ";
  EXPECT_NE(nodes.at("change").get<double>(), 0);
  EXPECT_DOUBLE_EQ(nodes.at("bar").get<double>(), 2 * std::fabs(nodes.at("change").get<double>()));
  EXPECT_NE(o.out.find("3 samples"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("step, skin, depth, width, floor, grain_size, spheres, precision skipped: not among --axes"),
            std::string::npos)
      << o.out;
  // The total of both axes; before, it was unknown without the axis step.
  const double bar = std::hypot(parameter.at("bar").get<double>(), nodes.at("bar").get<double>());
  EXPECT_NEAR(error.at("bar").get<double>(), bar, 1e-9 * bar);
  EXPECT_NE(o.out.find("error bars include node_spacing, parameter, but not the time step: add step to --axes"),
            std::string::npos)
      << o.out;
  for (const char* none : {"+- ?", "(no interval)", "cheapest"})
    EXPECT_EQ(o.out.find(none), std::string::npos) << none << "\n" << o.out;
}

} // namespace
} // namespace grouser::sweeps
