// SPDX-License-Identifier: BSD-3-Clause
#include "runs/scene/scene.hpp"

#include "base/table.hpp"
#include "runs/scene/detail/scene_tables.hpp"
#include "runs/scene/mechanism_scene.hpp"
#include "runs/scene/surface_scene.hpp"
#include "runs/support/locations.hpp"
#include "runs/support/result_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::scene {

using base::InputError;
using base::Section;

namespace {

const std::vector<std::string> kSections = {"version", "run",    "material", "contact",  "grain", "grains",
                                            "source",  "plane",  "box",      "cylinder", "mesh",  "terrain",
                                            "body",    "joint",  "spring",   "bushing",  "drive", "coupling",
                                            "vehicle", "driver", "output",   "parallel"};

/// One of the two ways to say how lossy a contact is.
template <class S> void checkOneLoss(const Section& section, const S& s) {
  if (s.restitution && s.damping)
    section.fail("damping", "stands beside restitution, which says the same; remove one of the two");
}

/// What belongs to the material's law gets its default; what belongs to the other must not stand there.
void completeLaw(const Section& section, Material& m) {
  const bool hertz = m.law == ContactLawKind::hertz;
  for (const char* key : {"stiffness", "tangential_stiffness_ratio", "damping"})
    if (hertz && section.has(key))
      section.fail(key, "belongs to law = \"linear\"; remove it: young, poisson and restitution say it for hertz");
  for (const char* key : {"young", "poisson"})
    if (!hertz && section.has(key))
      section.fail(key, "belongs to law = \"hertz\"; add that, or remove it: stiffness says it for linear");
  if (hertz && !m.young)
    section.fail("young", "[Pa] is missing, which law = \"hertz\" needs; add it, e.g. young = 7e7");
  if (!m.restitution && !m.damping) m.restitution = Material::kRestitution;
  if (!m.tangentialDampingRatio)
    m.tangentialDampingRatio = hertz ? Material::kHertzTangentialDampingRatio : Material::kLinearTangentialDampingRatio;
  if (hertz) {
    m.poisson = m.poisson.value_or(Material::kPoisson);
  } else {
    m.stiffness = m.stiffness.value_or(Material::kStiffness);
    m.tangentialStiffnessRatio = m.tangentialStiffnessRatio.value_or(Material::kTangentialStiffnessRatio.value());
  }
}

std::vector<Material> readMaterials(const Section& root) {
  std::vector<Material> materials;
  for (const auto& [name, section] : root.named("material")) {
    if (name.find('|') != std::string::npos)
      section.fail("", "has a name with |, which separates the two of a pair; choose another name");
    if (const std::string fault = support::nameFault(name); !fault.empty()) section.fail("", fault);
    Material m = section.read(detail::materialTable());
    m.name = name;
    checkOneLoss(section, m);
    completeLaw(section, m);
    materials.push_back(std::move(m));
  }
  return materials;
}

std::vector<std::string> materialNames(const Scene& scene) {
  std::vector<std::string> names;
  for (const Material& m : scene.materials) names.push_back(m.name);
  return names;
}

/// Fails unless `name` is a material of the scene; `key` is where the name stands.
void checkMaterial(const Scene& scene, const Section& section, const std::string& key, const std::string& name) {
  const std::vector<std::string> names = materialNames(scene);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  const std::string known =
      names.empty() ? "" : fmt::format("did you mean \"{}\"? Or ", base::nearestWord(name, names));
  section.fail(key, fmt::format("names no material of this scene{}; {}add a section [material.{}]",
                                key.empty() ? fmt::format(" (\"{}\")", name) : "", known, name));
}

void readContacts(const Section& root, Scene& scene) {
  for (const auto& [name, section] : root.named("contact")) {
    const std::size_t bar = name.find('|');
    if (bar == std::string::npos || name.find('|', bar + 1) != std::string::npos)
      section.fail("", "is not of the form [contact.\"a|b\"] with two materials; write the pair that way");
    ContactPair pair = section.read(detail::contactTable());
    pair.first = name.substr(0, bar), pair.second = name.substr(bar + 1);
    checkMaterial(scene, section, "", pair.first);
    checkMaterial(scene, section, "", pair.second);
    checkOneLoss(section, pair);
    for (const char* key : {"stiffness", "damping"})
      if (section.has(key) && scene.material(pair.first).law == ContactLawKind::hertz)
        section.fail(key, "belongs to law = \"linear\", but this pair is hertz; remove it");
    if (scene.contact(pair.first, pair.second))
      section.fail("", "is given twice, in both orders; remove one of the two");
    scene.contacts.push_back(std::move(pair));
  }
}

/// Makes `name` the absolute path of an existing file.
void resolveFile(const Scene& scene, const Section& section, const std::string& key, std::string& name) {
  if (name.empty()) section.fail(key, "is empty; give the path of a file");
  std::vector<std::filesystem::path> tried;
  const std::filesystem::path found = support::findInput(name, scene.file, tried);
  if (found.empty()) {
    std::string places;
    std::error_code error;
    for (const auto& p : tried) {
      if (std::filesystem::is_directory(p, error))
        section.fail(key, fmt::format("is a folder, {}; give the path of a file", p.string()));
      places += (places.empty() ? "" : ", ") + p.string();
    }
    section.fail(key, fmt::format("does not exist; correct the path (looked for {})", places));
  }
  name = found.string();
}

void readBlock(const Section& section, Scene& scene) {
  GrainFill b = section.read(detail::fillTable());
  checkMaterial(scene, section, "material", b.material);
  const bool file = b.form == FillForm::file;
  for (const char* key : {"low", "high", "radius"})
    if (file == section.has(key))
      section.fail(key, file ? "has no meaning for form = \"file\"; remove it"
                             : fmt::format("[m] is missing, which form = \"{}\" needs; add it", base::wordOf(b.form)));
  if (file && b.radiusTo) section.fail("radius_to", "has no meaning for form = \"file\"; remove it");
  if ((b.form == FillForm::random) != section.has("number"))
    section.fail("number", b.form == FillForm::random ? "is missing, which form = \"random\" needs; add it"
                                                      : "belongs to form = \"random\"; remove it");
  if (file != section.has("file"))
    section.fail("file",
                 file ? "is missing, which form = \"file\" needs; add it" : "belongs to form = \"file\"; remove it");
  if (b.radiusTo && *b.radiusTo < *b.radius) section.fail("radius_to", "[m] is below radius; raise it");
  for (int a = 0; !file && a < 3; ++a)
    if ((*b.high)[a] - (*b.low)[a] < 2 * b.largestRadius() * (1 - 1e-9))
      section.fail("high",
                   fmt::format("[m] leaves no room for a grain of radius {:g} m; enlarge the box", b.largestRadius()));
  if (file) {
    resolveFile(scene, section, "file", *b.file);
    b.fromFile = readGrainFile(*b.file, b);
  }
  scene.fills.push_back(std::move(b));
}

void readGrainsAndSurfaces(const Section& root, Scene& scene) {
  for (const Section& section : root.list("grain")) {
    scene.grains.push_back(section.read(detail::grainTable()));
    checkMaterial(scene, section, "material", scene.grains.back().material);
  }
  for (const Section& section : root.list("grains")) readBlock(section, scene);
  for (const Section& section : root.list("source")) {
    const Source s = section.read(detail::sourceTable());
    checkMaterial(scene, section, "material", s.material);
    for (int a = 0; a < 3; ++a)
      if (s.high[a] < s.low[a]) section.fail("high", "[m] lies below low; give the lower corner as low");
    if (s.start > scene.run.duration)
      section.fail("start", fmt::format("[s] is after the end of the run, run.duration = {:g} s: no grain would ever "
                                        "enter; lower it, raise run.duration, or remove the source",
                                        scene.run.duration));
    scene.sources.push_back(s);
  }
  readSurfaces(root, scene);
  const auto checkEach = [&](const char* kind, const auto& surfaces) {
    const std::vector<Section> sections = root.list(kind);
    for (std::size_t k = 0; k < sections.size(); ++k)
      checkMaterial(scene, sections[k], "material", surfaces[k].material);
  };
  checkEach("plane", scene.planes), checkEach("box", scene.boxes), checkEach("cylinder", scene.cylinders);
  checkEach("mesh", scene.meshes);
  const std::vector<Section> meshes = root.list("mesh");
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    resolveFile(scene, meshes[k], "file", scene.meshes[k].file);
    loadMesh(meshes[k], scene.meshes[k]);
  }
}

constexpr double kLeastPeriod = 12; // of a tile, in radii [-]

void readTerrain(const Section& section, Scene& scene) {
  Terrain t = section.read(detail::terrainTable());
  checkMaterial(scene, section, "material", t.material);
  if (t.groundMaterial.empty()) t.groundMaterial = t.material;
  checkMaterial(scene, section, "ground_material", t.groundMaterial);
  if (t.heightRange[1] < t.heightRange[0])
    section.fail("height_range", "[m] has white below black; give the lower height first");
  if (t.granular()) {
    if (!t.grainRadius)
      section.fail("grain_radius", "[m] is missing, which a granular bed needs; add it, or set kind = \"rigid\"");
    if (t.layers && t.depth)
      section.fail("depth", "[m] stands beside layers, which says the same; remove one of the two");
    if (!t.layers && !t.depth) section.fail("layers", "is missing; give layers [-] or depth [m] of the bed");
    if (t.depth && *t.depth < 2 * *t.grainRadius)
      section.fail("depth", fmt::format("[m] is less than one grain of radius {} m; give at least {}", *t.grainRadius,
                                        2 * *t.grainRadius));
    if (t.tile && std::min((*t.tile)[0], (*t.tile)[1]) < kLeastPeriod * *t.grainRadius)
      section.fail("tile", fmt::format("[m] is less than {} grain radii: grains would touch their own images; give at "
                                       "least {:g}",
                                       kLeastPeriod, kLeastPeriod * *t.grainRadius));
    if (std::min(t.size[0], t.size[1]) < 4 * *t.grainRadius)
      section.fail("size", fmt::format("[m] holds less than two grains of radius {} m; enlarge it", *t.grainRadius));
  } else {
    for (const char* key : {"grain_radius", "layers", "depth", "tile"})
      if (section.has(key)) section.fail(key, "has no meaning on rigid ground; remove it, or set kind = \"granular\"");
  }
  resolveFile(scene, section, "heightmap", t.heightmap);
  scene.terrain = std::move(t);
}

void readVehicle(const Section& section, Scene& scene) {
  Vehicle v = section.read(detail::vehicleTable());
  if (!v.material.empty()) checkMaterial(scene, section, "material", v.material);
  resolveFile(scene, section, "spec", v.spec);
  const bool hasGround = scene.terrain || !scene.planes.empty();
  if (!hasGround && v.chassis != ChassisMount::fixed)
    section.fail("chassis", "is \"free\" over no ground; add [terrain] or [[plane]], or set chassis = \"fixed\"");
  if (v.position && scene.terrain) {
    const auto [sizeX, sizeY] = scene.terrain->size;
    const auto [x, y] = *v.position;
    if (x < 0 || x > sizeX || y < -sizeY / 2 || y > sizeY / 2)
      section.fail("position",
                   fmt::format("[m] is outside the terrain, x in [0, {}], y in [{}, {}]; place the vehicle on it",
                               sizeX, -sizeY / 2, sizeY / 2));
  }
  scene.vehicle = std::move(v);
}

SpeedTable readSpeeds(const Section& section) {
  SpeedTable table = section.read(detail::speedTable());
  const std::size_t n = table.time.size();
  if (n == 0) section.fail("time", "[s] is empty; give at least one time");
  if (table.left.size() != n || table.right.size() != n)
    section.fail(table.left.size() != n ? "left" : "right",
                 fmt::format("[rad/s] has another length than time, which has {}; make all three alike", n));
  for (std::size_t i = 1; i < n; ++i)
    if (!(table.time[i] > table.time[i - 1]))
      section.fail("time", fmt::format("[s] does not increase at entry {}; sort it", i));
  return table;
}

void readDriver(const Section& section, Scene& scene) {
  if (!scene.vehicle) section.fail("", "has nothing to drive; add a section [vehicle], or remove this one");
  Driver d = section.read(detail::driverTable(), {}, {"table"});
  if (section.has("table")) d.table = readSpeeds(section.section("table"));
  if (d.left.has_value() != d.right.has_value())
    section.fail(d.left ? "left" : "right", fmt::format("[rad/s] stands without {}; give both, or sprocket_speed alone",
                                                        d.left ? "right" : "left"));
  if ((d.sprocketSpeed ? 1 : 0) + (d.left ? 1 : 0) + (d.table ? 1 : 0) > 1)
    section.fail(d.sprocketSpeed ? "sprocket_speed" : "left",
                 "[rad/s] is one of several speeds given; keep one of sprocket_speed, left with right, [driver.table]");
  scene.driver = std::move(d);
}

void readParallel(const Section& section, Scene& scene) {
  scene.parallel = section.read(detail::parallelTable());
  const std::vector<double>* cuts[] = {&scene.parallel.cutsX, &scene.parallel.cutsY, &scene.parallel.cutsZ};
  for (int a = 0; a < 3; ++a)
    for (std::size_t k = 1; k < cuts[a]->size(); ++k)
      if (!((*cuts[a])[k] > (*cuts[a])[k - 1]))
        section.fail(std::string("cuts_") + "xyz"[a], "[m] does not increase; sort it, each plane once");
  const auto& n = scene.parallel.subdomains;
  for (int a = 0; n && a < 3; ++a) {
    if ((*n)[a] != std::floor((*n)[a])) section.fail("subdomains", "[-] are whole numbers, e.g. [2, 2, 1]; round them");
    const auto slabs = static_cast<double>(cuts[a]->size() + 1);
    if (slabs > 1 && (*n)[a] != 0 && (*n)[a] != slabs)
      section.fail(std::string("cuts_") + "xyz"[a],
                   fmt::format("[m] makes {} subdomains along {}, but subdomains says {}; make them agree", slabs,
                               "xyz"[a], (*n)[a]));
  }
}

/// What stands at one of two periodic boundaries must stand at the other, too.
void checkPlanesAcross(const std::vector<Section>& sections, const Scene& scene) {
  for (std::size_t k = 0; k < scene.planes.size(); ++k)
    for (int a = 0; a < 2; ++a)
      if (scene.run.periodic[static_cast<std::size_t>(a)] &&
          std::fabs(scene.planes[k].normal[a]) > 1e-9 * norm(scene.planes[k].normal))
        sections[k].fail("normal", fmt::format("[-] leans along {}, where run.periodic joins the sides, at which the "
                                               "plane must look alike; set that entry to 0, or do not join them",
                                               "xy"[a]));
}

/// A path that no file system takes would only turn out when results are written.
void checkFolder(const Section& output, const std::string& folder) {
  if (std::any_of(folder.begin(), folder.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
    output.fail("folder", "has a control character in it; leave it out");
}

void checkOrder(const Section& run, const RunSettings& settings) {
  const int order = settings.integratorOrder;
  if (settings.integrator == multibody::Integrator::kRattle && order != 2 && order != 4 && order != 6 && order != 8)
    run.fail("integrator_order", "[-] is none of 2, 4, 6, 8; choose one of these");
}

void checkSettling(const Section& run, const Scene& scene) {
  if (scene.terrain && scene.terrain->granular() && scene.terrain->settleTimeLimit > 0 && !(scene.run.gravity.z < 0))
    run.fail("gravity", "[m/s2] does not bring the bed to rest on its floor; give z below 0, or set "
                        "terrain.settle_time_limit = 0");
}

/// Joined sides: where they stand must be known, and what stands between them must be able to do without sides.
void checkPeriodic(const Section& section, const Scene& scene) {
  const RunSettings& run = scene.run;
  const std::optional<std::array<double, 2>>* domains[] = {&run.domainX, &run.domainY};
  for (std::size_t a = 0; a < 2; ++a) {
    const auto& domain = *domains[a];
    const std::string key = std::string("domain_") + "xy"[a];
    if (domain && !run.periodic[a])
      section.fail(key,
                   fmt::format("[m] has no meaning where run.periodic does not join the sides along {}; remove it, "
                               "or join them",
                               "xy"[a]));
    if (domain && scene.terrain) section.fail(key, "[m] stands beside [terrain], whose borders are joined; remove it");
    if (domain && !((*domain)[1] > (*domain)[0])) section.fail(key, "[m] does not increase; give the lower side first");
    if (run.periodic[a] && !domain && !scene.terrain)
      section.fail("periodic",
                   fmt::format("joins sides along {} that stand nowhere; give run.{} = [from, to] [m]", "xy"[a], key));
  }
  if (!run.periodic[0] && !run.periodic[1]) return;
  if (scene.vehicle) section.fail("periodic", "is not possible beside a [vehicle]; set it to [false, false]");
  if (scene.grains.empty() && scene.fills.empty() && scene.sources.empty() &&
      !(scene.terrain && scene.terrain->granular()))
    section.fail("periodic", "joins sides for grains, of which this scene has none; remove it");
}

void checkIntervals(const Section& section, const RunSettings& run) {
  if (!run.timeStep) return;
  if (*run.timeStep > run.duration)
    section.fail("time_step", fmt::format("[s] is above the duration of {} s; lower it", run.duration));
  if (run.outputInterval < *run.timeStep)
    section.fail("output_interval",
                 fmt::format("[s] is below the time step of {} s; raise it to that at least", *run.timeStep));
  if (run.frameInterval < *run.timeStep)
    section.fail("frame_interval",
                 fmt::format("[s] is below the time step of {} s; raise it to that at least", *run.timeStep));
}

Scene sceneOf(base::Document read, const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  const auto document = std::make_shared<const base::Document>(std::move(read));
  const Section root = document->root();
  root.allowOnly(kSections);
  Scene scene;
  scene.file = file, scene.overrides = overrides, scene.document = document;
  scene.run = root.section("run").read(detail::runTable());
  checkIntervals(root.section("run"), scene.run);
  checkOrder(root.section("run"), scene.run);
  scene.materials = readMaterials(root);
  readContacts(root, scene);
  readGrainsAndSurfaces(root, scene);
  if (root.has("terrain")) readTerrain(root.section("terrain"), scene);
  readMechanism(root, scene);
  if (root.has("vehicle")) readVehicle(root.section("vehicle"), scene);
  checkSurfaces(root, scene);
  if (root.has("driver")) readDriver(root.section("driver"), scene);
  if (root.has("output")) scene.output = root.section("output").read(detail::outputTable());
  if (root.has("output")) checkFolder(root.section("output"), scene.output.folder);
  if (!scene.output.record.empty()) checkRecord(root.section("output"), scene);
  checkPeriodic(root.section("run"), scene);
  checkPlanesAcross(root.list("plane"), scene);
  checkSettling(root.section("run"), scene);
  if (root.has("parallel")) readParallel(root.section("parallel"), scene);
  if (scene.grains.empty() && scene.fills.empty() && scene.sources.empty() && !scene.terrain && !scene.vehicle &&
      scene.mechanism.nothing())
    throw InputError(fmt::format(
        "{}: there is nothing to simulate; add [terrain], [vehicle], [[grain]], [[grains]], [[source]] or [[body]]",
        file.string()));
  return scene;
}

template <class S> std::string block(const std::string& heading, const base::Table<S>& table, const S& s) {
  return "\n" + heading + "\n" + table.write(s);
}

/// A name as a key of TOML: in quotes always, which is always allowed.
std::string key(const std::string& name) { return base::toToml(name); }

} // namespace

SpeedTable Driver::speeds() const {
  if (table) return *table;
  return {{0}, {left.value_or(sprocketSpeed.value_or(0))}, {right.value_or(sprocketSpeed.value_or(0))}};
}

double GrainFill::smallestRadius() const {
  double least = radius.value_or(1e300);
  for (const Grain& g : fromFile) least = std::min(least, g.radius);
  return least;
}

double GrainFill::largestRadius() const {
  double most = radiusTo.value_or(radius.value_or(0));
  for (const Grain& g : fromFile) most = std::max(most, g.radius);
  return most;
}

const Material& Scene::material(const std::string& name) const {
  for (const Material& m : materials)
    if (m.name == name) return m;
  throw InputError(
      fmt::format("{}: \"{}\" is no material of this scene; add a section [material.{}]", file.string(), name, name));
}

const ContactPair* Scene::contact(const std::string& a, const std::string& b) const {
  for (const ContactPair& p : contacts)
    if ((p.first == a && p.second == b) || (p.first == b && p.second == a)) return &p;
  return nullptr;
}

Scene readScene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return sceneOf(base::Document::load(file, overrides), file, overrides);
}

Scene readSceneText(std::string_view text, const std::filesystem::path& file,
                    const std::vector<std::string>& overrides) {
  return sceneOf(base::Document::parse(text, file.string(), overrides), file, overrides);
}

std::string resolvedToml(const Scene& scene) {
  std::string text = "version = 1\n" + block("[run]", detail::runTable(), scene.run);
  for (const Material& m : scene.materials) text += block("[material." + key(m.name) + "]", detail::materialTable(), m);
  for (const ContactPair& p : scene.contacts)
    text += block("[contact." + key(p.first + "|" + p.second) + "]", detail::contactTable(), p);
  for (const Grain& g : scene.grains) text += block("[[grain]]", detail::grainTable(), g);
  for (const GrainFill& b : scene.fills) text += block("[[grains]]", detail::fillTable(), b);
  for (const Source& s : scene.sources) text += block("[[source]]", detail::sourceTable(), s);
  text += surfacesToml(scene);
  if (scene.terrain) text += block("[terrain]", detail::terrainTable(), *scene.terrain);
  text += mechanismToml(scene.mechanism);
  if (scene.vehicle) {
    text += block("[vehicle]", detail::vehicleTable(), *scene.vehicle);
    text += block("[driver]", detail::driverTable(), scene.driver);
    if (scene.driver.table) text += block("[driver.table]", detail::speedTable(), *scene.driver.table);
  }
  return text + block("[output]", detail::outputTable(), scene.output) +
         block("[parallel]", detail::parallelTable(), scene.parallel);
}

std::string fieldHelp() {
  std::string text =
      "## Keys of a scene file\n\nEvery file begins with `version = 1`. Only `[run]` is required; a section "
      "that is absent is not built.\n";
  const auto add = [&](const auto& table) { text += "\n" + base::describe(table); };
  add(detail::runTable()), add(detail::materialTable()), add(detail::contactTable());
  add(detail::grainTable()), add(detail::fillTable()), add(detail::sourceTable()), add(detail::planeTable());
  add(detail::boxTable()), add(detail::cylinderTable()), add(detail::meshTable());
  add(detail::terrainTable());
  add(detail::bodyTable()), add(detail::jointTable()), add(detail::springTable());
  add(detail::bushingTable()), add(detail::driveTable()), add(detail::couplingTable());
  add(detail::vehicleTable()), add(detail::driverTable()), add(detail::speedTable()), add(detail::outputTable());
  add(detail::parallelTable());
  return text;
}

} // namespace grouser::scene
