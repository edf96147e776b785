// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/soil_options.hpp"

#include "runs/support/option_checks.hpp"
#include "runs/validation/studies/option_parts.hpp"

namespace grouser::studies {

namespace {

void addShearAngle(CLI::App& study, ShearAngleCommand& c) {
  CLI::App* shear = study.add_subcommand(
      "shear-angle",
      "Simple shear of poured beds between toothed plates: angle of internal friction and cohesion, with "
      "and without rolling friction (hours on one core: --part)");
  addNumber(*shear, "--friction", c.friction, 0, 5, "between grains, and between grains and plates [-]");
  addNumber(*shear, "--preparation-friction", c.preparationFriction, 0, 5,
            "between grains while a sample is poured: the less, the denser [-]");
  QuickValues quick;
  quick.instead(
      shear->add_option("--rolling-frictions", c.rollingFrictions, "soils that differ in rolling friction [-]")
          ->check(support::between(0.0, 5.0))
          ->capture_default_str(),
      c.rollingFrictions, {0});
  quick.instead(shear->add_option("--stresses", c.stresses, "on the upper plate [Pa]")
                    ->check(support::between(100.0, 1e6))
                    ->capture_default_str(),
                c.stresses, {2000});
  quick.instead(addSeeds(*shear, c.seeds, "samples of each load and soil"), c.seeds, 2);
  jobs::addPieceOptions(*shear, c.pieces);
  addPlace(*shear, c.place, "shear-angle", "one load, two small samples, sheared fast: in seconds");
  doStudy(*shear, c, studyShearAngleCommand, quick);
}

void addPlates(CLI::App& study, PlatesCommand& c) {
  CLI::App* plates = study.add_subcommand(
      "plates",
      "Plates pushed into poured beds: pressure over sinkage, what floor, depth and width of the bed do to it, "
      "bearing capacity against theory, and a graded bed against a fine one (made for a GPU)");
  QuickValues quick;
  const auto number = [&](const std::string& name, double& value, double low, double high, double quickly,
                          const std::string& help) {
    quick.instead(addNumber(*plates, name, value, low, high, help), value, quickly);
  };
  quick.instead(
      plates
          ->add_option("--cases", c.cases,
                       "of base, rough, deep, wide, old, circular, fine, graded, separated by commas; default: all")
          ->delimiter(','),
      c.cases, {"base", "old", "circular"});
  quick.instead(addSeeds(*plates, c.seeds, "beds of each case"), c.seeds, 2);
  number("--breadth", c.breadth, 2, 1000, 4, "of the strip, and diameter of the circular plate [d]");
  number("--strip-bin", c.stripBin, 1.5, 100, 3, "between the boundaries beside the strip [breadths]");
  number("--strip-depth", c.stripDepth, 0.5, 100, 1.5, "of the strip's bed [breadths]");
  number("--strip-thickness", c.thickness, 4, 1000, 5, "of the strip's bed along the strip [d]");
  number("--circular-bin", c.circularBin, 1.5, 100, 3, "between the boundaries beside the circle [breadths]");
  number("--circular-depth", c.circularDepth, 0.5, 100, 1.5, "of the circle's bed [breadths]");
  number("--fine-breadth", c.fineBreadth, 4, 1000, 5, "of the strips of cases fine and graded [d]");
  number("--fine-thickness", c.fineThickness, 6, 1000, 7,
         "of their beds along the strip [d]; the coarsest grains are a third of it");
  addNumber(*plates, "--fine-depth", c.fineDepth, 0, 100, "down to which the graded bed is fine [breadths]");
  number("--coarsening", c.coarsening, 1e-4, 0.5, 0.12, "growth of its mean radius with depth below that [-]");
  number("--young", c.young, 1e5, 1e12, 5e7, "of the grains of both, whose contacts are Hertz' [Pa]");
  number("--sinkage", c.sinkage, 0.01, 2, 0.2, "to which the plates are pushed [breadths]");
  number("--inertial-number", c.inertialNumber, 1e-6, 0.1, 2e-2, "speed/breadth d sqrt(density/pressure) [-]");
  addNumber(*plates, "--friction", c.friction, 0, 5, "between grains, and between grains and plate [-]");
  addNumber(*plates, "--rolling-friction", c.rollingFriction, 0, 5, "the same of rolling [-]");
  addNumber(*plates, "--preparation-friction", c.preparationFriction, 0, 5,
            "between grains while a bed is poured: the less, the denser [-]");
  addNumber(*plates, "--angle", c.angle, 0, 60, "of internal friction, for theory: core angle of shear-angle [deg]");
  addNumber(*plates, "--angle-error", c.angleError, 0, 20, "half width of its interval [deg]")->needs("--angle");
  plates->add_flag("--keep-beds", c.keepBeds, "writes each bed as lines of x, y, z, r, for other programs");
  jobs::addPieceOptions(*plates, c.pieces);
  addPlace(*plates, c.place, "plates", "small plates on small beds, two seeds, pushed fast: in seconds");
  doStudy(*plates, c, studyPlatesCommand, quick);
}

void addPreparation(CLI::App& study, PreparationCommand& c) {
  CLI::App* preparation = study.add_subcommand(
      "preparation",
      "Beds of [terrain] that ask for a porosity: what they reach, and with which friction while settling");
  QuickValues quick;
  quick.instead(preparation->add_option("--porosities", c.porosities, "asked for [-]")
                    ->check(support::between(0.2, 0.7))
                    ->capture_default_str(),
                c.porosities, {0.41});
  addNumber(*preparation, "--friction", c.friction, 0, 5, "of the grains [-]");
  addNumber(*preparation, "--rolling-friction", c.rollingFriction, 0, 5, "the same of rolling [-]");
  quick.instead(addNumber(*preparation, "--width", c.width, 6, 1000, "of a bed between periodic boundaries [d]"),
                c.width, 9);
  quick.instead(addNumber(*preparation, "--depth", c.depth, 4, 1000, "of a bed [d]"), c.depth, 7);
  quick.instead(addSeeds(*preparation, c.seeds, "beds of each porosity"), c.seeds, 2);
  jobs::addPieceOptions(*preparation, c.pieces);
  addPlace(*preparation, c.place, "preparation", "one porosity, two small beds: half a minute");
  doStudy(*preparation, c, studyPreparationCommand, quick);
}

} // namespace

void addSoilStudies(CLI::App& study, SoilStudies& studies) {
  addShearAngle(study, studies.shearAngle);
  addPlates(study, studies.plates);
  addPreparation(study, studies.preparation);
}

} // namespace grouser::studies
