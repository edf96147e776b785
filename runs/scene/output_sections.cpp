// SPDX-License-Identifier: BSD-3-Clause
// Keys and checks of [output] and [parallel].
#include "runs/scene/detail/section_lists.hpp"

#include "base/name_fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::scene::detail {

namespace {

using base::Section;
using base::Table;

Table<Output> outputTable() {
  using S = Output;
  Table<S> t("output", "Output files of a run; their intervals are set in [run]");
  t.add("folder", &S::folder, "",
        "results folder, relative to the working folder; default: out/NAME, where NAME is the scene name");
  t.add("record", &S::record, "", "names of the bodies, joints, springs and drives in the time series; default: all");
  t.add("frames", &S::frames, "", "write frames.h5 and frames.xdmf (for ParaView)");
  t.add("contact_forces", &S::contactForces, "", "add the resultant contact force on each grain to the frames");
  t.add("shoe_forces", &S::shoeForces, "",
        "add ground force and shear force on each track shoe, and lateral force and moment of each pin, to results.h5");
  t.add("gear_contacts", &S::gearContacts, "",
        "add the number of grain contacts of each vehicle part, and the number of grains caught in the running gear, "
        "to each row; each row then costs a pass over all contacts of parts");
  t.add("final_surface", &S::finalSurface, "",
        "add the final bed surface (ruts) of a run with a vehicle to results.h5");
  t.add("grains_csv", &S::grainsCsv, "",
        "write grains.csv with all grains at each output time; \"auto\": only if there are at most 1000 grains and 1e6 "
        "lines")
      .orWord("auto");
  t.add("picture", &S::picture, "", "write picture.png with vehicle and bed at the end of the run");
  t.add("picture_width", &S::pictureWidth, "px", "width of the picture").atLeast(64).atMost(8192);
  t.add("fields_cell", &S::fieldsCell, "m",
        "cell size of the soil fields (stress, strain rate, porosity, velocity, coordination number) in each frame; "
        "default: no fields")
      .plausible(1e-4, 20)
      .above(0);
  t.add("fields_low", &S::fieldsLow, "m",
        "lower corner of the box divided into cells; default: the initial bounding box of the grains, extended upwards "
        "by one cell")
      .plausible(0, 1000);
  t.add("fields_high", &S::fieldsHigh, "m", "upper corner of the box divided into cells").plausible(0, 1000);
  t.add("plots", &S::plots, "", "draw plots of the time series (requires Python with matplotlib)");
  return t;
}

Table<PlotSection> plotTable() {
  using S = PlotSection;
  Table<S> t("[output.plot]", "Panel of figure.png: columns of the results over time or over another column");
  t.add("x", &S::x, "", "column for the horizontal axis, as named in timeseries.csv, e.g. \"bodies.cone.position.z\"");
  t.add("y", &S::y, "", "columns for the vertical axis").required();
  t.add("sum", &S::sum, "", "draw the sum of the y columns as a single curve");
  t.add("labels", &S::labels, "", "legend labels of the curves");
  t.add("title", &S::title, "", "title above the panel");
  t.add("x_label", &S::xLabel, "", "axis label: quantity and unit");
  t.add("y_label", &S::yLabel, "", "axis label: quantity and unit").required();
  t.add("x_scale", &S::xScale, "-", "factor applied to x, e.g. to convert units");
  t.add("x_offset", &S::xOffset, "as the axis", "offset added to x_scale times x");
  t.add("x_from_start", &S::xFromStart, "", "subtract the first value of x before scaling");
  t.add("x_range", &S::xRange, "as the axis", "axis limits; default: the range of the values");
  t.add("y_scale", &S::yScale, "-", "factor applied to y, e.g. to convert units");
  t.add("y_offset", &S::yOffset, "as the axis", "offset added to y_scale times y");
  t.add("y_from_start", &S::yFromStart, "", "subtract the first value of each y before scaling");
  t.add("y_range", &S::yRange, "as the axis", "axis limits; default: the range of the values");
  t.add("levels", &S::levels, "as the axis", "y values of dashed horizontal reference lines");
  t.add("level_labels", &S::levelLabels, "", "legend labels of the reference lines");
  return t.leaveOutEmpty();
}

Table<Parallel> parallelTable() {
  using S = Parallel;
  Table<S> t("parallel", "Settings for several MPI ranks (mpirun -np N); results do not depend on the number of ranks");
  t.add("subdomains", &S::subdomains, "-",
        "number of subdomains along x, y and z; their product must equal the number of ranks; 0: automatic")
      .atLeast(0)
      .atMost(64)
      .orWord("auto");
  t.add("cuts_x", &S::cutsX, "m", "initial positions along x of the planes between subdomains; default: automatic");
  t.add("cuts_y", &S::cutsY, "m", "initial positions along y of the planes between subdomains");
  t.add("cuts_z", &S::cutsZ, "m", "initial positions along z of the planes between subdomains");
  t.add("rebalance", &S::rebalance, "",
        "move the planes between subdomains if a rank has clearly more work than the average");
  t.add("peer_memory", &S::peerMemory, "",
        "whether GPUs of one machine access each other's memory directly instead of exchanging messages: auto (if "
        "possible), never, or required (ranks on CPUs then also share memory)");
  return t;
}

/// Rejects paths that no file system accepts before the run starts.
void checkFolder(const Section& output, const std::string& folder) {
  if (base::hasControlCharacter(folder)) output.fail("folder", "contains a control character; remove it");
}

/// Throws InputError for names that the mechanism does not have.
void checkRecord(const Section& section, const Output& output, const Scene& scene) {
  std::vector<std::string> known;
  forEachKind(scene.mechanism, [&](const char*, const auto& sections) {
    for (const auto& part : sections) known.push_back(part.name);
  });
  for (const std::string& name : output.record)
    if (std::find(known.begin(), known.end(), name) == known.end())
      section.fail("record",
                   known.empty()
                       ? "lists parts of a mechanism, but the scene has no mechanism; remove it"
                       : fmt::format("contains \"{}\", which is not a part of the mechanism; did you mean \"{}\"?",
                                     name, base::nearestWord(name, known)));
}

void checkFields(const Section& section, const Output& output) {
  if (output.fieldsLow.has_value() != output.fieldsHigh.has_value())
    section.fail(output.fieldsLow ? "fields_low" : "fields_high",
                 fmt::format("requires fields_{}; set both corners or neither", output.fieldsLow ? "high" : "low"));
  if (output.fieldsLow && !output.fieldsCell)
    section.fail("fields_low", "has no effect without fields_cell; remove it");
  for (int a = 0; output.fieldsLow && a < 3; ++a)
    if (!((*output.fieldsHigh)[a] > (*output.fieldsLow)[a]))
      section.fail("fields_high", fmt::format("[m] is not above fields_low along {}; raise it", "xyz"[a]));
  if (output.fieldsCell && !output.frames)
    section.fail("fields_cell", "requires frames.h5, which frames = false disables; remove one of the two keys");
}

void checkOutput(const Section& section, Output& output, const Scene& scene) {
  checkFolder(section, output.folder);
  checkFields(section, output);
  if (!output.record.empty()) checkRecord(section, output, scene);
}

void checkPlot(const Section& section, PlotSection& plot, const Scene&) {
  const auto check = [&](const char* key, const std::string& text) {
    if (const std::string fault = base::textFault(text); !fault.empty()) section.fail(key, fault);
  };
  check("title", plot.title), check("x_label", plot.xLabel), check("y_label", plot.yLabel);
  for (const std::string& label : plot.labels) check("labels", label);
  for (const std::string& label : plot.levelLabels) check("level_labels", label);
  if (plot.y.empty()) section.fail("y", "is empty; set a column, e.g. \"bodies.cone.position.z\"");
  const std::size_t curves = plot.sum ? 1 : plot.y.size();
  if (!plot.labels.empty() && plot.labels.size() != curves)
    section.fail("labels", fmt::format("must have one entry for each of {} curves; correct the list", curves));
  if (plot.levelLabels.size() != plot.levels.size())
    section.fail("level_labels",
                 fmt::format("must have one entry for each of {} levels; correct the list", plot.levels.size()));
  for (const auto& [key, range] : {std::pair{"x_range", plot.xRange}, std::pair{"y_range", plot.yRange}})
    if (range && !((*range)[0] < (*range)[1])) section.fail(key, "must be [min, max]; swap the limits");
}

/// [output] with its [[output.plot]]s.
SectionEntry output() {
  SectionEntry entry = single<Output>("output", &Scene::output, outputTable(), checkOutput, {"plot"});
  const Table<PlotSection> table = plotTable();
  entry.read = [table, read = std::move(entry.read)](const Section& root, Scene& scene) {
    read(root, scene);
    if (!root.has("output")) return;
    for (const Section& section : root.section("output").list("plot"))
      scene.output.panels.push_back(readChecked<PlotSection>(section, table, checkPlot, scene));
  };
  entry.write = [table, write = std::move(entry.write)](const Scene& scene) {
    std::string text = write(scene);
    for (const PlotSection& plot : scene.output.panels) text += written<PlotSection>("[[output.plot]]", table, plot);
    return text;
  };
  entry.describe = [table, describe = std::move(entry.describe)] { return describe() + "\n" + base::describe(table); };
  for (const std::string& key : fullKeys("output.plot", table)) entry.keys.push_back(key);
  return entry;
}

void checkParallel(const Section& section, Parallel& parallel, const Scene&) {
  const std::vector<double>* cuts[] = {&parallel.cutsX, &parallel.cutsY, &parallel.cutsZ};
  for (int a = 0; a < 3; ++a)
    for (std::size_t k = 1; k < cuts[a]->size(); ++k)
      if (!((*cuts[a])[k] > (*cuts[a])[k - 1]))
        section.fail(std::string("cuts_") + "xyz"[a], "[m] must increase; sort the planes and remove duplicates");
  const auto& n = parallel.subdomains;
  for (int a = 0; n && a < 3; ++a) {
    if ((*n)[a] != std::floor((*n)[a]))
      section.fail("subdomains", "[-] must be whole numbers, e.g. [2, 2, 1]; round them");
    const auto slabs = static_cast<double>(cuts[a]->size() + 1);
    if (slabs > 1 && (*n)[a] != 0 && (*n)[a] != slabs)
      section.fail(std::string("cuts_") + "xyz"[a],
                   fmt::format("[m] results in {} subdomains along {}, but subdomains sets {}; make them consistent",
                               slabs, "xyz"[a], (*n)[a]));
  }
}

} // namespace

SectionList outputSections() {
  return {output(), single("parallel", &Scene::parallel, parallelTable(), checkParallel)};
}

} // namespace grouser::scene::detail
