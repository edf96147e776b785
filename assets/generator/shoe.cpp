// SPDX-License-Identifier: BSD-3-Clause
#include "assets/generator/parts.hpp"
#include "assets/generator/solids.hpp"

namespace grouser::assets {
namespace {

/// Overlap of a shell with the shell below it, so that no two faces coincide [m].
constexpr double kSunk = 0.010;
/// The pad ends this far below the line of pins, clear of the neighbour's pins (radius 0.010) at any fold.
constexpr double kPadTop = -0.015;

void addPad(TriangleMesh& mesh, const TrackDims& d) {
  const double x = d.plateHalfLength, c = d.chamfer;
  prism(mesh,
        {{-x + c, d.padBottom},
         {x - c, d.padBottom},
         {x, d.padBottom + c},
         {x, kPadTop},
         {-x, kPadTop},
         {-x, d.padBottom + c}},
        -d.padHalfWidth, d.padHalfWidth);
  const double tip = d.padBottom - d.grouserDepth, half = d.grouserWidth / 2, y = d.padHalfWidth - 0.002;
  for (const double centre : {-d.grouserX, d.grouserX})
    prism(mesh,
          {{centre - half + c, tip},
           {centre + half - c, tip},
           {centre + half, tip + c},
           {centre + half, d.padBottom + kSunk},
           {centre - half, d.padBottom + kSunk},
           {centre - half, tip + c}},
          -y, y);
}

void addPlates(TriangleMesh& mesh, const TrackDims& d) {
  // The foot narrows where it enters the pad, so that its ends do not coincide with the pad's.
  const double x = d.plateHalfLength, foot = x - 0.008;
  const std::vector<std::pair<double, double>> profile = {{-foot, kPadTop - kSunk}, {foot, kPadTop - kSunk},
                                                          {x, kPadTop + 0.003},     {x, d.plateTop},
                                                          {-x, d.plateTop},         {-x, kPadTop + 0.003}};
  prism(mesh, profile, -d.plateOuter, -d.plateInner);
  prism(mesh, profile, d.plateInner, d.plateOuter);
}

void addHorn(TriangleMesh& mesh, const TrackDims& d) {
  auto rectangle = [](double length, double width, double z) {
    const double x = length / 2, y = width / 2;
    return Ring{{-x, -y, z}, {-x, y, z}, {x, y, z}, {x, -y, z}};
  };
  const double foot = kPadTop - kSunk, tip = d.plateTop + d.hornHeight;
  loft(mesh,
       {rectangle(d.hornLength, d.hornWidth, foot), rectangle(d.hornLength, d.hornWidth, d.plateTop),
        rectangle(d.hornTipLength, d.hornTipWidth, tip)},
       {0, 0, foot}, {0, 0, tip});
}

/// Bosses and pins of the joint at x = +pitch/2, with a lug that supports each pin beside the wheel plate.
void addBosses(TriangleMesh& mesh, const TrackDims& d) {
  const double x = d.pitch / 2, lugInner = d.plateOuter + 0.003, lugOuter = d.padHalfWidth - 0.003;
  for (const double side : {-1.0, 1.0}) {
    auto span = [&](double a, double b) { return side > 0 ? std::pair{a, b} : std::pair{-b, -a}; };
    const auto [pin0, pin1] = span(lugInner + 0.002, d.bossOuter - 0.002);
    lathe(mesh, {{pin0, d.pinRadius}, {pin1, d.pinRadius}}, x, 0, d.bossFacets / 2);
    const auto [boss0, boss1] = span(d.bossInner, d.bossOuter);
    lathe(mesh, {{boss0, d.bossRadius}, {boss1, d.bossRadius}}, x, 0, d.bossFacets);
    const auto [lug0, lug1] = span(lugInner, lugOuter);
    prism(mesh,
          {{0.030, kPadTop - kSunk}, {0.060, kPadTop - kSunk}, {x, -0.007}, {x, 0.007}, {0.050, 0.007}, {0.030, 0.000}},
          lug0, lug1);
  }
}

} // namespace

TriangleMesh shoe(const TrackDims& dims) {
  TriangleMesh mesh;
  addPad(mesh, dims);
  addPlates(mesh, dims);
  addHorn(mesh, dims);
  addBosses(mesh, dims);
  return mesh;
}

} // namespace grouser::assets
