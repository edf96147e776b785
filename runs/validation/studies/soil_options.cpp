// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/soil_options.hpp"

#include "runs/support/option_checks.hpp"
#include "runs/validation/studies/option_parts.hpp"

namespace grouser::studies {

namespace {

void addShearAngle(CLI::App& study, ShearAngleCommand& c) {
  CLI::App* shear = study.add_subcommand(
      "shear-angle", "Measure the angle of internal friction and the cohesion of poured beds in simple shear between "
                     "toothed plates, with and without rolling friction (hours on one core: use --part)");
  addNumber(*shear, "--friction", c.friction, 0, 5, "friction between grains, and between grains and plates [-]");
  addNumber(*shear, "--preparation-friction", c.preparationFriction, 0, 5,
            "friction between grains during pouring; a lower value makes the bed denser [-]");
  QuickValues quick;
  quick.instead(shear->add_option("--rolling-frictions", c.rollingFrictions, "rolling friction of each soil [-]")
                    ->check(support::between(0.0, 5.0))
                    ->capture_default_str(),
                c.rollingFrictions, {0});
  quick.instead(shear->add_option("--stresses", c.stresses, "normal stress on the upper plate [Pa]")
                    ->check(support::between(100.0, 1e6))
                    ->capture_default_str(),
                c.stresses, {2000});
  quick.instead(addSeeds(*shear, c.seeds, "number of samples per load and soil"), c.seeds, 2);
  jobs::addPieceOptions(*shear, c.pieces);
  addPlace(*shear, c.place, "shear-angle", "use one load, two small samples and fast shear (takes seconds)");
  doStudy(*shear, c, studyShearAngleCommand, quick);
}

void addPlates(CLI::App& study, PlatesCommand& c) {
  CLI::App* plates = study.add_subcommand(
      "plates",
      "Push plates into poured beds: measure the pressure over the sinkage and the effects of floor, depth and width "
      "of "
      "the bed, and compare the bearing capacity with theory and a graded bed with a fine bed (GPU recommended)");
  QuickValues quick;
  const auto number = [&](const std::string& name, double& value, double low, double high, double quickly,
                          const std::string& help) {
    quick.instead(addNumber(*plates, name, value, low, high, help), value, quickly);
  };
  quick.instead(plates
                    ->add_option("--cases", c.cases,
                                 "run only these cases, separated by commas: base, rough, deep, wide, old, circular, "
                                 "fine, graded; default: all")
                    ->delimiter(','),
                c.cases, {"base", "old", "circular"});
  quick.instead(addSeeds(*plates, c.seeds, "number of beds per case"), c.seeds, 2);
  number("--breadth", c.breadth, 2, 1000, 4,
         "width of the strip, and diameter of the circular plate [grain diameters]");
  number("--strip-bin", c.stripBin, 1.5, 100, 3, "width of the strip's bed [plate widths]");
  number("--strip-depth", c.stripDepth, 0.5, 100, 1.5, "depth of the strip's bed [plate widths]");
  number("--strip-thickness", c.thickness, 4, 1000, 5, "length of the strip and its bed [grain diameters]");
  number("--circular-bin", c.circularBin, 1.5, 100, 3, "width of the circular plate's bed [plate widths]");
  number("--circular-depth", c.circularDepth, 0.5, 100, 1.5, "depth of the circular plate's bed [plate widths]");
  number("--fine-breadth", c.fineBreadth, 4, 1000, 5, "strip width in cases fine and graded [grain diameters]");
  number("--fine-thickness", c.fineThickness, 6, 1000, 7,
         "length of strips and beds in cases fine and graded [grain diameters]; limits the largest grain to 2/7 of it");
  addNumber(*plates, "--fine-depth", c.fineDepth, 0, 100, "depth of the fine layer of the graded bed [plate widths]");
  number("--coarsening", c.coarsening, 1e-4, 0.5, 0.12,
         "increase of the mean radius per depth below the fine layer [-]");
  number("--young", c.young, 1e5, 1e12, 5e7,
         "Young's modulus of the grains in cases fine and graded, with Hertz contacts [Pa]");
  number("--sinkage", c.sinkage, 0.01, 2, 0.2, "final sinkage of the plates [plate widths]");
  number(
      "--inertial-number", c.inertialNumber, 1e-6, 0.1, 2e-2,
      "inertial number (speed / plate width) d sqrt(density / pressure), which determines the speed of the plates [-]");
  addNumber(*plates, "--friction", c.friction, 0, 5, "friction between grains, and between grains and plate [-]");
  addNumber(*plates, "--rolling-friction", c.rollingFriction, 0, 5, "rolling friction of the same contacts [-]");
  addNumber(*plates, "--preparation-friction", c.preparationFriction, 0, 5,
            "friction between grains during pouring; a lower value makes the bed denser [-]");
  addNumber(*plates, "--angle", c.angle, 0, 60,
            "angle of internal friction for the theory: the core angle measured by shear-angle [deg]");
  addNumber(*plates, "--angle-error", c.angleError, 0, 20, "half width of the interval of --angle [deg]")
      ->needs("--angle");
  plates->add_flag("--keep-beds", c.keepBeds,
                   "write each bed to a text file with a line x, y, z, r [m] for each grain");
  jobs::addPieceOptions(*plates, c.pieces);
  addPlace(*plates, c.place, "plates", "use small plates on small beds, two seeds and a high speed (takes seconds)");
  doStudy(*plates, c, studyPlatesCommand, quick);
}

void addPreparation(CLI::App& study, PreparationCommand& c) {
  CLI::App* preparation = study.add_subcommand(
      "preparation",
      "Settle beds with a target porosity in [terrain], and measure their porosity and the settling friction");
  QuickValues quick;
  quick.instead(preparation->add_option("--porosities", c.porosities, "target porosities [-]")
                    ->check(support::between(0.2, 0.7))
                    ->capture_default_str(),
                c.porosities, {0.41});
  addNumber(*preparation, "--friction", c.friction, 0, 5, "friction of the grains [-]");
  addNumber(*preparation, "--rolling-friction", c.rollingFriction, 0, 5, "rolling friction of the grains [-]");
  quick.instead(addNumber(*preparation, "--width", c.width, 6, 1000,
                          "width of the bed between opposite periodic boundaries [grain diameters]"),
                c.width, 9);
  quick.instead(addNumber(*preparation, "--depth", c.depth, 4, 1000, "depth of the bed [grain diameters]"), c.depth, 7);
  quick.instead(addSeeds(*preparation, c.seeds, "number of beds per porosity"), c.seeds, 2);
  jobs::addPieceOptions(*preparation, c.pieces);
  addPlace(*preparation, c.place, "preparation", "use one porosity and two small beds (takes half a minute)");
  doStudy(*preparation, c, studyPreparationCommand, quick);
}

} // namespace

void addSoilStudies(CLI::App& study, SoilStudies& studies) {
  addShearAngle(study, studies.shearAngle);
  addPlates(study, studies.plates);
  addPreparation(study, studies.preparation);
}

} // namespace grouser::studies
