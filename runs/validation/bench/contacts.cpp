// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/bench/contacts.hpp"

#include "base/error.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/line_fit.hpp"
#include "runs/validation/bench/bullet.hpp"
#include "runs/validation/bench/contact_spheres.hpp"
#include "runs/validation/bench/pair_search.hpp"
#include "runs/validation/bench/report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>

namespace grouser::bench {

namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr std::uint64_t kSpheresSeed = 1;
constexpr double kPairsPerSphere = 3; ///< number of contacts / number of spheres, for many spheres
constexpr double kLinearFrom = 1e6;   ///< the growth fit uses points with at least this number of contacts
const std::vector<double> kOnCpu = {3e4, 1e5, 3e5, 1e6, 3e6, 1e7};
const std::vector<double> kOnGpu = {1e6, 1e7, 1e8, 3e8, 1e9, 2e9, 4e9, 6e9};

/// Times of one search [s].
struct Times {
  double grid = 0, sort = 0, count = 0, store = 0, total = 0;
};

struct Point {
  std::int64_t spheres = 0, contacts = 0;
  Times first;  ///< times of the first search, including memory allocation
  Times median; ///< median times of the later searches; `first` if there are no later searches
  int slabs = 0;
  double bytesPerSphere = 0; ///< memory for positions, pairs and work arrays / number of spheres [B]
  std::optional<BulletFigures> bullet;
};

/// One search from positions; releases the pairs. All ranks search together; the time ends when the last rank finishes.
Times search(PairSearch& searcher, const base::Array<base::Position>& positions, const PairSearchOptions& options,
             const base::Comm& comm, Point& point) {
  comm.wait();
  const Clock::time_point start = Clock::now();
  const FoundPairs found = searcher.find(positions.data(), positions.size(), options);
  comm.wait();
  const double total = std::chrono::duration<double>(Clock::now() - start).count();
  std::size_t bytes = found.workBytes + positions.bytes();
  for (const base::Array<IdPair>& part : found.pairs) bytes += part.bytes();
  point.contacts = comm.sumOf(found.count), point.slabs = found.slabs;
  point.bytesPerSphere = static_cast<double>(bytes) / static_cast<double>(positions.size());
  return {found.gridSeconds, found.sortSeconds, found.countSeconds, found.storeSeconds, total};
}

Point measure(std::int64_t spheres, const ContactsBench& bench, const base::Exec& exec) {
  const base::Comm comm = bench.ranks ? bench.ranks->comm() : base::Comm();
  Point point;
  point.spheres = spheres;
  const base::Array<base::Position> positions = ContactSpheres::make(exec, spheres, kSpheresSeed);
  PairSearch searcher(exec, ContactSpheres::kDiameter);
  PairSearchOptions options;
  options.store = !bench.countOnly, options.atATime = bench.atATime;
  options.share = comm.rank(), options.of = comm.size();
  point.first = search(searcher, positions, options, comm, point);
  std::vector<Times> repeats;
  for (int k = 1; k < bench.repeats; ++k) repeats.push_back(search(searcher, positions, options, comm, point));
  std::sort(repeats.begin(), repeats.end(), [](const Times& a, const Times& b) { return a.total < b.total; });
  point.median = repeats.empty() ? point.first : repeats[repeats.size() / 2];
  if (comm.first() && static_cast<std::size_t>(spheres) <= bench.bulletSpheres && !bulletVersion().empty()) {
    std::vector<base::Vec3f> places;
    const double unit = 1.0 / double(ContactSpheres::kDiameter);
    for (const base::Position& p : positions.toHost())
      places.push_back((base::toUnits(p).as<double>() * unit).as<float>());
    point.bullet = benchBullet(places, 1.0f, bench.repeats);
  }
  return point;
}

void printHead(bool isStored) {
  fmt::print("\n{:>12} {:>13} {:>8} | {:>10} {:>10} {:>9} {:>9} {:>9} {:>9} | {:>11} {:>6}", "spheres", "contacts",
             "/sphere", "first [s]", "total [s]", "grid", "sort", "count", isStored ? "store" : "-", "contacts/s",
             "B/sph.");
  if (!bulletVersion().empty()) fmt::print(" | {:>9} {:>9} {:>8}", "cold [s]", "warm [s]", "warm/ours");
  fmt::print("\n");
}

void print(const Point& p) {
  const double contacts = static_cast<double>(p.contacts);
  fmt::print("{:>12} {:>13} {:>8.3f} | {:>10.4f} {:>10.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} | {:>11.3e} {:>6.0f}",
             p.spheres, p.contacts, 2 * contacts / static_cast<double>(p.spheres), p.first.total, p.median.total,
             p.median.grid, p.median.sort, p.median.count, p.median.store, contacts / p.median.total, p.bytesPerSphere);
  if (p.bullet)
    fmt::print(" | {:>9.3f} {:>9.4f} {:>8.1f}", p.bullet->setUpSeconds + p.bullet->coldSeconds, p.bullet->warmSeconds,
               p.bullet->warmSeconds / p.median.total);
  fmt::print("\n");
  std::fflush(stdout);
}

Json jsonOf(const Times& t) {
  return {{"grid", t.grid}, {"sort", t.sort}, {"count", t.count}, {"store", t.store}, {"total", t.total}};
}

Json jsonOf(const Point& p) {
  const double contacts = static_cast<double>(p.contacts);
  Json json = {{"spheres", p.spheres},
               {"contacts", p.contacts},
               {"contacts_a_sphere", 2 * contacts / static_cast<double>(p.spheres)},
               {"seconds_first", jsonOf(p.first)},
               {"seconds", jsonOf(p.median)},
               {"contacts_per_second", contacts / p.median.total},
               {"slabs", p.slabs},
               {"bytes_a_sphere", p.bytesPerSphere}};
  if (p.bullet)
    json["bullet"] = {{"contacts", p.bullet->contacts},
                      {"seconds_set_up", p.bullet->setUpSeconds},
                      {"seconds_cold", p.bullet->coldSeconds},
                      {"seconds_warm", p.bullet->warmSeconds},
                      {"contacts_per_second_warm", static_cast<double>(p.bullet->contacts) / p.bullet->warmSeconds},
                      {"warm_over_ours", p.bullet->warmSeconds / p.median.total}};
  return json;
}

/// Tolerance: Bullet uses single precision, so that a few pairs with almost zero overlap may differ.
void checkBullet(const Point& p) {
  if (!p.bullet) return;
  const double apart = std::fabs(static_cast<double>(p.bullet->contacts - p.contacts));
  if (apart > 1e-4 * static_cast<double>(p.contacts) + 2)
    throw base::SimulationError(
        fmt::format("contact counts differ: for {} spheres, Bullet finds {} contacts, but grouser finds {}", p.spheres,
                    p.bullet->contacts, p.contacts));
}

} // namespace

void benchContactsCommand(const ContactsBench& bench) {
  const base::Exec exec = support::chooseDevice(support::deviceChoice(bench.device), bench.threads, bench.ranks);
  if (!bench.plot.empty() && !bench.plot.ends_with(".png"))
    throw base::InputError(fmt::format("--plot {}: the file name must end in .png", bench.plot));
  if (!bench.plot.empty() && bench.json.empty()) throw base::InputError("--plot requires --json; add it");
  Json json = benchOrigin("contacts", exec);
  json["arrangement"] =
      fmt::format("cubic lattice of spacing {:g} diameters, random displacements up to {:g} diameters "
                  "along each axis, ids scattered over the lattice",
                  ContactSpheres::kSpacing, ContactSpheres::kJitter);
  json["pairs"] = bench.countOnly ? "counted" : "stored";
  const int ranks = bench.ranks ? bench.ranks->comm().size() : 1;
  json["ranks"] = ranks;
  json["bullet_version"] = bulletVersion();
  fmt::print("spheres   {}\n", json["arrangement"].get<std::string>());
  fmt::print("contacts  overlapping pairs, each counted once, {}\n",
             bench.countOnly ? "not stored" : "stored as two 32-bit ids");
  fmt::print("times     searches from positions: a first one that allocates memory, and the median of {}\n",
             std::max(1, bench.repeats - 1));
  if (ranks > 1) fmt::print("ranks     {}: each rank stores all positions and searches some of the slabs\n", ranks);
  fmt::print(
      "bullet    {}\n",
      bulletVersion().empty()
          ? std::string("no comparison: this grouser was built without Bullet (Debian: libbullet-dev)")
          : fmt::format("{}, one thread, up to {} spheres; cold: with set-up; warm: with kept pairs, spheres at rest",
                        bulletVersion(), bench.bulletSpheres));
  printHead(!bench.countOnly);
  std::vector<double> wanted = bench.contacts.empty() ? exec.onCpu() ? kOnCpu : kOnGpu : bench.contacts;
  std::sort(wanted.begin(), wanted.end());
  std::vector<double> contacts, seconds;
  for (const double c : wanted) {
    const Point p = measure(std::max<std::int64_t>(1, std::llround(c / kPairsPerSphere)), bench, exec);
    print(p);
    checkBullet(p);
    json["points"].push_back(jsonOf(p));
    if (static_cast<double>(p.contacts) < 0.9 * kLinearFrom) continue;
    contacts.push_back(static_cast<double>(p.contacts)), seconds.push_back(p.median.total);
  }
  if (const support::LineFit growth = support::fitPower(contacts, seconds); growth.points >= 2) {
    fmt::print("\ngrowth    time ~ contacts^{} from {:.2g} to {:.2g} contacts{}\n",
               growth.hasError() ? fmt::format("({:.3f} +- {:.3f})", growth.slope, growth.slopeEstimate().halfWidth)
                                 : fmt::format("{:.3f}", growth.slope),
               contacts.front(), contacts.back(), growth.hasError() ? " (95 %)" : "");
    json["growth_exponent"] = growth.slope;
    if (growth.hasError()) json["growth_exponent_half_width"] = growth.slopeEstimate().halfWidth;
  }
  const base::Comm comm = bench.ranks ? bench.ranks->comm() : base::Comm();
  writeBench(json, bench.json, comm);
  if (!bench.plot.empty() && comm.first()) output::drawPicture("contacts.py", {bench.json}, bench.plot);
}

} // namespace grouser::bench
