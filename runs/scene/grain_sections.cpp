// SPDX-License-Identifier: BSD-3-Clause
// Keys and checks of [[grain]], [[grains]] and [[source]].
#include "runs/scene/detail/section_lists.hpp"

#include "runs/scene/detail/section_checks.hpp"

#include <fmt/format.h>

namespace grouser::scene::detail {

namespace {

using base::Section;
using base::Table;

Table<Grain> grainTable() {
  using S = Grain;
  Table<S> t("[grain]", "A single grain, for small scenes");
  t.add("position", &S::position, "m", "position of the centre").plausible(0, 1000).required();
  t.add("velocity", &S::velocity, "m/s", "initial velocity").plausible(0, 300).atLeast(-1e4).atMost(1e4);
  t.add("spin", &S::spin, "rad/s", "initial angular velocity").plausible(0, 1e4).atLeast(-1e6).atMost(1e6);
  t.add("radius", &S::radius, "m", "radius of the sphere").plausible(1e-6, 2).above(0).atMost(1e3).required();
  t.add("material", &S::material, "", "name of the material").required();
  t.add("above_bed", &S::aboveBed, "m",
        "gap between the grain and the highest grain below it after the bed has settled; replaces the z coordinate of "
        "position")
      .plausible(0, 100)
      .atLeast(0)
      .atMost(1e4);
  t.add("fixed", &S::fixed, "", "whether the grain is fixed, e.g. as part of rough ground");
  return t;
}

Table<GrainFill> fillTable() {
  using S = GrainFill;
  Table<S> t("[grains]", "A set of grains: a lattice, a random fill of a box, or a file of positions and radii");
  t.add("form", &S::form, "", "lattice or random (in a box), or file (one grain per line)");
  t.add("low", &S::low, "m",
        "lower corner of the box that contains all grains completely; not allowed with form = \"file\"")
      .plausible(0, 1000);
  t.add("high", &S::high, "m", "upper corner of the box").plausible(0, 1000);
  t.add("radius", &S::radius, "m",
        "grain radius, or minimum radius if radius_to is set; not allowed with form = \"file\"")
      .plausible(1e-6, 2)
      .above(0)
      .atMost(1e3);
  t.add("radius_to", &S::radiusTo, "m",
        "maximum grain radius; radii are uniformly distributed between radius and radius_to")
      .plausible(1e-6, 2)
      .above(0)
      .atMost(1e3);
  t.add("spacing", &S::spacing, "-", "lattice spacing, in units of the maximum grain radius").atLeast(2).atMost(100);
  t.add("jitter", &S::jitter, "-",
        "maximum random displacement from the lattice sites along each axis / half the gap between grains")
      .atLeast(0)
      .atMost(1);
  t.add("number", &S::number, "-", "number of grains of a random fill").atLeast(1).atMost(1e8);
  t.add("file", &S::file, "",
        "text file with one grain per line: x, y, z, r [m], optionally vx, vy, vz [m/s], then wx, wy, wz [rad/s], and "
        "optionally a header with these names; searched for in the scene's folder, the working folder and the assets "
        "folder");
  t.add("velocity", &S::velocity, "m/s", "initial velocity; with form = \"file\", only for lines without a velocity")
      .plausible(0, 300)
      .atLeast(-1e4)
      .atMost(1e4);
  t.add("spin", &S::spin, "rad/s",
        "initial angular velocity; with form = \"file\", only for lines without an angular velocity")
      .plausible(0, 1e4)
      .atLeast(-1e6)
      .atMost(1e6);
  t.add("material", &S::material, "", "name of the material").required();
  t.add("above_bed", &S::aboveBed, "m",
        "gap between the lowest point of these grains and the highest grain below them after the bed has settled; all "
        "grains of the section are raised or lowered together")
      .plausible(0, 100)
      .atLeast(0)
      .atMost(1e4);
  return t;
}

Table<Source> sourceTable() {
  using S = Source;
  Table<S> t("[source]", "Source of grains that enter during the run at random positions in a box");
  t.add("low", &S::low, "m", "lower corner of the box in which the centres of new grains are placed")
      .plausible(0, 1000)
      .required();
  t.add("high", &S::high, "m", "upper corner of the box").plausible(0, 1000).required();
  t.add("velocity", &S::velocity, "m/s", "initial velocity").plausible(0, 300).atLeast(-1e4).atMost(1e4);
  t.add("spin", &S::spin, "rad/s", "initial angular velocity").plausible(0, 1e4).atLeast(-1e6).atMost(1e6);
  t.add("radius", &S::radius, "m", "radius of each grain").plausible(1e-6, 2).above(0).atMost(10).required();
  t.add("material", &S::material, "", "name of the material").required();
  t.add("number", &S::number, "-", "number of grains that enter at the same time").atLeast(1).atMost(1e6);
  t.add("every", &S::every, "s", "time between two entries").plausible(1e-5, 100).above(0).required();
  t.add("start", &S::start, "s", "time of the first entry").plausible(0, 1000).atLeast(0);
  t.add("total", &S::total, "-", "total number of grains").atLeast(1).atMost(1e8).required();
  return t;
}

void checkFill(const Section& section, GrainFill& b, const Scene& scene) {
  requireMaterial(scene, section, "material", b.material);
  const bool file = b.form == FillForm::file;
  for (const char* key : {"low", "high", "radius"})
    if (file == section.has(key))
      section.fail(key,
                   file ? "does not apply to form = \"file\"; remove it"
                        : fmt::format("[m] is missing, but form = \"{}\" requires it; add it", base::wordOf(b.form)));
  if (file && b.radiusTo) section.fail("radius_to", "does not apply to form = \"file\"; remove it");
  if ((b.form == FillForm::random) != section.has("number"))
    section.fail("number", b.form == FillForm::random ? "is missing, but form = \"random\" requires it; add it"
                                                      : "applies to form = \"random\" only; remove it");
  if (file != section.has("file"))
    section.fail("file", file ? "is missing, but form = \"file\" requires it; add it"
                              : "applies to form = \"file\" only; remove it");
  if (b.radiusTo && *b.radiusTo < *b.radius) section.fail("radius_to", "[m] is below radius; raise it");
  for (int a = 0; !file && a < 3; ++a)
    if ((*b.high)[a] - (*b.low)[a] < 2 * b.largestRadius() * (1 - 1e-9))
      section.fail("high", fmt::format("[m] makes the box too small for a grain of radius {:g} m; enlarge the box",
                                       b.largestRadius()));
  if (file) {
    resolveFile(scene, section, "file", *b.file);
    b.fromFile = readGrainFile(*b.file, b);
  }
}

void checkGrain(const Section& section, Grain& g, const Scene& scene) {
  requireMaterial(scene, section, "material", g.material);
  if (!g.fixed) return;
  const char* const remedy = "has no effect on a fixed grain; remove it, or fixed = true";
  if (norm2(g.velocity) > 0) section.fail("velocity", std::string("[m/s] ") + remedy);
  if (norm2(g.spin) > 0) section.fail("spin", std::string("[rad/s] ") + remedy);
}

void checkSource(const Section& section, Source& s, const Scene& scene) {
  requireMaterial(scene, section, "material", s.material);
  for (int a = 0; a < 3; ++a)
    if (s.high[a] < s.low[a]) section.fail("high", "[m] is below low; swap the corners");
  if (s.start > scene.run.duration)
    section.fail("start", fmt::format("[s] is after the end of the run (run.duration = {:g} s), so no grain would "
                                      "enter; lower it, raise run.duration, or remove the source",
                                      scene.run.duration));
}

} // namespace

SectionList grainSections() {
  return {list("grain", &Scene::grains, grainTable(), checkGrain),
          list("grains", &Scene::fills, fillTable(), checkFill),
          list("source", &Scene::sources, sourceTable(), checkSource)};
}

} // namespace grouser::scene::detail
