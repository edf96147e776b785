// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "runs/validation/bench/bullet.hpp"
#include "runs/validation/bench/contact_spheres.hpp"
#include "runs/validation/bench/contacts.hpp"
#include "runs/validation/bench/pair_search.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace grouser::bench {
namespace {

namespace fs = std::filesystem;

TEST(ContactSpheres, EverySiteHoldsOneSphereWhateverTheirNumber) {
  const base::Exec exec = testExec();
  for (const std::int64_t count : {1, 2, 7, 64, 618, 1000, 4097}) {
    std::vector<std::array<std::int64_t, 3>> sites;
    for (const base::Position& p : ContactSpheres::make(exec, count, 3).toHost()) {
      std::array<std::int64_t, 3> site;
      const base::Vec3d u = base::toUnits(p).as<double>() * (1.0 / double(ContactSpheres::kDiameter));
      for (int k = 0; k < 3; ++k) {
        site[static_cast<std::size_t>(k)] = std::llround(u[k] / ContactSpheres::kSpacing);
        EXPECT_LE(std::fabs(u[k] - ContactSpheres::kSpacing * std::round(u[k] / ContactSpheres::kSpacing)),
                  ContactSpheres::kJitter + 1e-6); // rounding to units
      }
      sites.push_back(site);
    }
    ASSERT_EQ(static_cast<std::int64_t>(sites.size()), count);
    std::sort(sites.begin(), sites.end());
    EXPECT_TRUE(std::adjacent_find(sites.begin(), sites.end()) == sites.end()) << count;
  }
}

TEST(ContactSpheres, InsideTheBlockASphereTouchesSixOthers) {
  constexpr int kEdge = 50;
  const base::Exec exec = testExec();
  const base::Array<base::Position> spheres = ContactSpheres::make(exec, kEdge * kEdge * kEdge, 1);
  const FoundPairs found = PairSearch(exec, ContactSpheres::kDiameter).find(spheres.data(), spheres.size(), {});
  // Spheres at least two sites from the faces have all their neighbours.
  const std::vector<base::Position> host = spheres.toHost();
  std::vector<bool> inside;
  for (const base::Position& p : host) {
    const base::Vec3d u =
        base::toUnits(p).as<double>() * (1.0 / (ContactSpheres::kSpacing * double(ContactSpheres::kDiameter)));
    inside.push_back(std::min({u.x, u.y, u.z}) > 2 && std::max({u.x, u.y, u.z}) < kEdge - 3);
  }
  double contacts = 0;
  for (const auto& part : found.pairs)
    for (const IdPair& p : part.toHost()) contacts += inside[p.first] + inside[p.second];
  const double count = static_cast<double>(std::count(inside.begin(), inside.end(), true));
  // About 90,000 spheres whose contact numbers have a standard deviation of 1.2: 0.02 is five errors of the mean.
  EXPECT_NEAR(contacts / count, 6.0, 0.02);
}

TEST(BenchContacts, FiguresHoldContactsTimesAndBullet) {
  const fs::path file = fs::path(::testing::TempDir()) / "grouser_bench_contacts.json";
  ContactsBench bench;
  bench.contacts = {3000, 900}, bench.threads = 1, bench.device = "cpu", bench.json = file.string();
  benchContactsCommand(bench);
  const nlohmann::json json = nlohmann::json::parse(std::ifstream(file));
  ASSERT_EQ(json.at("points").size(), 2u);
  EXPECT_EQ(json["points"][0]["spheres"], 300);
  EXPECT_EQ(json["points"][1]["spheres"], 1000);
  const auto& p = json["points"][1];
  const double parts = p["seconds"]["grid"].get<double>() + p["seconds"]["sort"].get<double>() +
                       p["seconds"]["count"].get<double>() + p["seconds"]["store"].get<double>();
  EXPECT_LE(parts, p["seconds"]["total"].get<double>());
  EXPECT_EQ(p.contains("bullet"), !bulletVersion().empty());
  if (p.contains("bullet")) {
    EXPECT_EQ(p["bullet"]["contacts"], p["contacts"]);
  }
  fs::remove(file);
  bench.json.clear(), bench.plot = "plot.png";
  EXPECT_THROW(benchContactsCommand(bench), base::InputError);
}

TEST(BenchBullet, FindsThePairsThatOverlapAndNoOthers) {
  if (bulletVersion().empty()) GTEST_SKIP() << "built without Bullet";
  // A row: the first two overlap, the third almost touches, the fourth is isolated.
  const BulletFigures f = benchBullet({{0, 0, 0}, {0.9f, 0, 0}, {1.905f, 0, 0}, {5, 0, 0}}, 1.0f, 2);
  EXPECT_EQ(f.contacts, 1);
}

} // namespace
} // namespace grouser::bench
