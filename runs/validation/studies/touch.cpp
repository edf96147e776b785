// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/touch.hpp"

#include "runs/jobs/study_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace grouser::studies {

using base::Position;
using base::Vec3;
using base::Vec3l;

namespace {

/// Width of the local cells [units]; grain diameters are 1e8 to 2e8 units.
constexpr std::int64_t kCell = std::int64_t{1} << 27;

std::int64_t cellOf(std::int64_t units) { return units >= 0 ? units / kCell : -((kCell - 1 - units) / kCell); }

template <class T> bool nearer(const Vec3<T>& apart, T reach) { return dot(apart, apart) < reach * reach; }

/// Gap [m], computed from exact squares.
double gapOf(const Position& a, const Position& b, double unit, std::int64_t diameterUnits) {
  const std::int64_t distance2 = base::squaredNorm(base::difference(a, b));
  const double difference = static_cast<double>(distance2 - diameterUnits * diameterUnits);
  return difference / (std::sqrt(static_cast<double>(distance2)) + static_cast<double>(diameterUnits)) * unit;
}

/// Contacts of all grains as sorted keys; each pair occurs once.
std::vector<std::uint64_t> contactKeys(const terrain::GrainState& state) {
  std::vector<std::uint64_t> keys;
  std::size_t at = 0;
  for (std::size_t i = 0; i < state.rows(); ++i)
    for (std::uint32_t k = 0; k < state.contacts[i]; ++k) {
      const std::uint64_t j = state.neighbour[at++];
      if (i < j) keys.push_back(static_cast<std::uint64_t>(i) << 32 | j);
    }
  return keys;
}

/// State with the contact lists that one step of `grains` finds in a configuration.
terrain::GrainState listsOf(terrain::Grains& grains, const terrain::GrainState& configuration) {
  grains.restore(configuration);
  grains.refreshNeighbours();
  grains.step();
  return grains.state();
}

void countDifferences(const terrain::GrainState& a, const terrain::GrainState& b, TouchConfiguration& now) {
  std::size_t atA = 0, atB = 0;
  for (std::size_t i = 0; i < a.rows(); ++i) {
    const auto firstA = a.neighbour.begin() + static_cast<std::ptrdiff_t>(atA),
               firstB = b.neighbour.begin() + static_cast<std::ptrdiff_t>(atB);
    now.grainListsDiffer += a.contacts[i] != b.contacts[i] || !std::equal(firstA, firstA + a.contacts[i], firstB);
    now.wallListsDiffer += a.wallBits[i] != b.wallBits[i];
    atA += a.contacts[i], atB += b.contacts[i];
  }
}

} // namespace

const char* touchArithmeticName(int arithmetic) {
  const char* const names[] = {"float from the origin", "float from a local cell", "float of exact difference",
                               "double from the origin"};
  return names[arithmetic];
}

bool touchesExactly(const Position& a, const Position& b, std::int64_t diameterUnits) {
  return base::squaredNorm(base::difference(a, b)) < diameterUnits * diameterUnits;
}

bool touchesIn(TouchArithmetic arithmetic, const Position& a, const Position& b, const base::PositionScale& scale,
               std::int64_t diameterUnits) {
  const double diameter = static_cast<double>(diameterUnits) * scale.unit;
  switch (arithmetic) {
  case kFloatFromOrigin:
    return nearer(scale.toMetres(b).as<float>() - scale.toMetres(a).as<float>(), static_cast<float>(diameter));
  case kFloatFromCell: {
    const Vec3l ua = base::toUnits(a), ub = base::toUnits(b);
    Vec3<float> apart;
    for (int k = 0; k < 3; ++k) {
      const std::int64_t ca = cellOf(ua[k]), cb = cellOf(ub[k]);
      const auto inA = static_cast<float>(static_cast<double>(ua[k] - ca * kCell) * scale.unit);
      const auto inB = static_cast<float>(static_cast<double>(ub[k] - cb * kCell) * scale.unit);
      apart[k] = inB - inA + static_cast<float>(static_cast<double>((cb - ca) * kCell) * scale.unit);
    }
    return nearer(apart, static_cast<float>(diameter));
  }
  case kFloatDifference:
    return nearer(base::difference(a, b).as<float>(), static_cast<float>(diameterUnits));
  default:
    return nearer(scale.toMetres(b) - scale.toMetres(a), diameter);
  }
}

void TouchCounts::add(const Position& a, const Position& b, const base::PositionScale& scale,
                      std::int64_t diameterUnits) {
  const bool exact = touchesExactly(a, b, diameterUnits);
  const double gap = std::fabs(gapOf(a, b, scale.unit, diameterUnits));
  ++pairs, touching += exact;
  nearest = std::min(nearest, gap);
  for (int k = 0; k < kTouchArithmetics; ++k) {
    if (touchesIn(static_cast<TouchArithmetic>(k), a, b, scale, diameterUnits) == exact) continue;
    Disagreements& d = wrong[static_cast<std::size_t>(k)];
    ++(exact ? d.missed : d.invented);
    d.widest = std::max(d.widest, gap);
  }
}

void TouchCounts::add(const TouchCounts& more) {
  pairs += more.pairs, touching += more.touching, nearest = std::min(nearest, more.nearest);
  for (std::size_t k = 0; k < wrong.size(); ++k) {
    wrong[k].missed += more.wrong[k].missed, wrong[k].invented += more.wrong[k].invented;
    wrong[k].widest = std::max(wrong[k].widest, more.wrong[k].widest);
  }
}

TouchCounts judgePairs(const terrain::Grains& grains, std::int64_t diameterUnits) {
  const contact::NeighbourList::HostCopy list = grains.system().neighbours.toHost();
  const Position* position = grains.view().position; // on the CPU
  TouchCounts counts;
  for (std::size_t i = 0; i < grains.view().count; ++i)
    for (std::uint32_t k = 0; k < list.count[i]; ++k) {
      const std::size_t j = list.slot[static_cast<std::size_t>(list.at(i, k))];
      if (i < j) counts.add(position[i], position[j], grains.scale(), diameterUnits);
    }
  return counts;
}

std::vector<TouchConfiguration> studyTouch(const TouchStudy& study,
                                           const std::function<void(const TouchConfiguration&)>& done) {
  StudyBox box;
  box.grains = study.grains;
  const base::Exec exec = base::cpuExec(study.threads);
  terrain::Grains run = fill(box, exec), single = fill(box, exec);
  box.precision = terrain::Precision::double_;
  terrain::Grains twice = fill(box, exec);
  std::vector<TouchConfiguration> all;
  std::vector<std::uint64_t> former;
  for (int c = 0; c < study.configurations; ++c) {
    for (std::int64_t i = 0; i < study.every; ++i) {
      run.refreshNeighbours();
      run.step();
    }
    run.refreshNeighbours();
    TouchConfiguration now;
    now.step = run.steps();
    now.counts = judgePairs(run, studyBoxDiameter());
    now.kineticPerGrain = run.ledger().kinetic / static_cast<double>(study.grains);
    const terrain::GrainState state = run.state();
    const terrain::GrainState inSingle = listsOf(single, state), inDouble = listsOf(twice, state);
    countDifferences(inSingle, inDouble, now);
    std::vector<std::uint64_t> keys = contactKeys(inSingle), change;
    std::set_symmetric_difference(keys.begin(), keys.end(), former.begin(), former.end(), std::back_inserter(change));
    now.changed = keys.empty() ? 0 : static_cast<double>(change.size()) / static_cast<double>(keys.size());
    former = std::move(keys);
    all.push_back(now);
    done(now);
  }
  return all;
}

std::string touchTable(const std::vector<TouchConfiguration>& all, const TouchStudy& study) {
  TouchCounts sum;
  std::int64_t grains = 0, walls = 0;
  std::vector<double> changed;
  for (const TouchConfiguration& c : all) {
    sum.add(c.counts), grains += c.grainListsDiffer, walls += c.wallListsDiffer;
    if (&c != &all.front()) changed.push_back(c.changed);
  }
  std::string text = fmt::format(
      "\ncontact decisions: {} configurations of {} grains, {} steps apart ({:g} s); contacts made or lost between two "
      "configurations / all contacts: median {:.3g}, minimum {:.3g}\n  {} candidate pairs, {} in contact; smallest "
      "|gap|: {:.2g} m\n  grains with different contacts in single and double precision: {} with grains, {} with "
      "walls\n  {:<28} {:>14} {:>14} {:>14} {:>22}\n",
      all.size(), study.grains, study.every, static_cast<double>(study.every) * StudyBox::kTimeStep,
      jobs::medianOf(changed), changed.empty() ? 0 : *std::min_element(changed.begin(), changed.end()), sum.pairs,
      sum.touching, sum.nearest, grains, walls, "compared with exact integers", "disagreements", "missed", "false",
      "largest |gap| [m]");
  for (int k = 0; k < kTouchArithmetics; ++k) {
    const TouchCounts::Disagreements& d = sum.wrong[static_cast<std::size_t>(k)];
    text += fmt::format("  {:<28} {:>14} {:>14} {:>14} {:>22}\n", touchArithmeticName(k), d.count(), d.missed,
                        d.invented, d.count() ? fmt::format("{:.2e}", d.widest) : "-");
  }
  return text;
}

std::string touchCsv(const std::vector<TouchConfiguration>& all) {
  std::string text = "step,candidate pairs,touching,nearest |gap| [m],kinetic energy a grain [J],contacts changed [-],"
                     "grains whose contacts with grains differ single to double,with walls";
  for (int k = 0; k < kTouchArithmetics; ++k)
    text += fmt::format(",{0}: missed,{0}: invented,{0}: widest |gap| [m]", touchArithmeticName(k));
  text += "\n";
  for (const TouchConfiguration& c : all) {
    text += fmt::format("{},{},{},{},{},{},{},{}", c.step, c.counts.pairs, c.counts.touching, c.counts.nearest,
                        c.kineticPerGrain, c.changed, c.grainListsDiffer, c.wallListsDiffer);
    for (const TouchCounts::Disagreements& d : c.counts.wrong)
      text += fmt::format(",{},{},{}", d.missed, d.invented, d.widest);
    text += "\n";
  }
  return text;
}

} // namespace grouser::studies
