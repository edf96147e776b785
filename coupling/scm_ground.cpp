// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/scm_ground.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "coupling/contact_parts.hpp"
#include "coupling/ledger_entries.hpp"
#include "coupling/obstacles.hpp"
#include "coupling/simulation_state.hpp"
#include "spheredecomp/mesh_query.hpp"
#include "vehicle/assembly.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace grouser::coupling {

double ScmSetup::stiffest(double breadth) const {
  const auto slope = [&](double z) {
    return scm::unloadingStiffness(soil, z, soil.modulusAt(breadth) * base::pow(z, soil.exponent));
  };
  return std::max(slope(1e-4), slope(0.1));
}

ScmGround::ScmGround(const ScmSetup& setup, const terrain::HeightField& surface)
    : setup_(setup), laid_(surface),
      map_(setup.spacing, [view = surface.view()](double x, double y) { return view.jet(x, y); }) {}

std::function<double(double, double)> ScmGround::surface() const {
  return [view = laid_.view()](double x, double y) { return view.jet(x, y).h; };
}

GroundTraits ScmGround::traits() const {
  GroundTraits traits;
  traits.hullGround = &laid_;
  traits.onHost = traits.deforms = true;
  return traits;
}

namespace {

std::vector<scm::Pad> padsOf(const PartsOnGround& on) {
  std::vector<scm::Pad> pads;
  if (!on.vehicle) return pads;
  const vehicle::VehicleSpec& spec = on.vehicle->spec;
  const vehicle::ShoeSpec& shoe = spec.shoe;
  const int grousers = !(shoe.grouserHeight > 0) ? 0 : spec.shapes && !(spec.shapes->grouserX > 0) ? 1 : 2;
  scm::Pad pad{.centre = {0, 0, shoe.padBottom},
               .along = {1, 0, 0},
               .across = {0, 1, 0},
               .halfLength = shoe.halfLength,
               .halfWidth = shoe.padHalfWidth,
               .breadth = 2 * shoe.padHalfWidth,
               .pitch = shoe.pitch,
               .grousers = scm::Grousers{grousers, shoe.grouserHeight}};
  for (std::size_t t = 0; t < on.vehicle->tracks.size(); ++t)
    for (const int body : on.vehicle->tracks[t].shoes)
      for (std::size_t c = 0; c < on.parts.count(); ++c)
        if (const ContactPart& part = on.parts.parts[c];
            part.canTouchGround && !part.ofBody && part.body == static_cast<std::size_t>(body)) {
          pad.part = static_cast<int>(c), pad.track = static_cast<int>(t);
          pads.push_back(pad);
        }
  return pads;
}

std::vector<scm::Facet> facetsOf(const spheredecomp::TriangleMesh& mesh, const spheredecomp::MeshQuery& query) {
  std::vector<scm::Facet> facets;
  for (std::uint32_t t = 0; 3 * t < mesh.indices.size(); ++t)
    facets.push_back({{query.vertex(t, 0), query.vertex(t, 1), query.vertex(t, 2)}, query.normal(t)});
  return facets;
}

std::vector<scm::Solid> solidsOf(const PartsOnGround& on, double spacing) {
  std::vector<scm::Solid> solids;
  for (std::size_t c = 0; c < on.parts.count(); ++c) {
    const ContactPart& part = on.parts.parts[c];
    if (!part.canTouchGround || !part.ofBody) continue;
    const int index = static_cast<int>(c), body = static_cast<int>(part.body);
    if (part.mesh)
      solids.push_back({.part = index,
                        .body = body,
                        .half = halfExtent(part.shape),
                        .isConvex = false,
                        .facets = facetsOf(part.mesh->mesh(), *part.mesh)});
    else
      solids.push_back(scm::solidOf(part.shape, spacing, index, body));
  }
  return solids;
}

} // namespace

LoadQuanta ScmGround::meet(const PartsOnGround& on) {
  contacts_ = std::make_unique<scm::SoilContacts>(setup_.soil, setup_.deepest, setup_.displacement, map_, padsOf(on),
                                                  solidsOf(on, setup_.spacing), on.timeStep);
  if (!saved_.empty() && !contacts_->restore(saved_))
    throw base::InputError(
        "the saved state belongs to another vehicle or other bodies; resume with the scene that was run");
  saved_.clear();
  return quanta_ = {on.quanta.force, on.quanta.torque};
}

void ScmGround::computeOnHost(const contact::PartMotion* motion, contact::PartLoad* loads) {
  contacts_->step(motion);
  const auto add = [&](int part, const base::Vec3d& force, const base::Vec3d& torque) {
    loads[part].force += quanta_.force.quantise(force), loads[part].torque += quanta_.torque.quantise(torque);
  };
  const scm::PadContacts& pads = contacts_->pads();
  for (std::size_t k = 0; k < pads.pads().size(); ++k)
    if (pads.loads()[k].pressed > 0) add(pads.pads()[k].part, pads.loads()[k].force, pads.loads()[k].torque);
  const scm::BodyContacts& bodies = contacts_->bodies();
  for (std::size_t k = 0; k < bodies.solids().size(); ++k)
    add(bodies.solids()[k].part, bodies.loads()[k].force, bodies.loads()[k].torque);
}

void ScmGround::addContactsTo(ContactLedger& ledger) const { ledger.soil = contacts_->energy(); }

std::vector<double> ScmGround::surfaceNow() const {
  const terrain::HeightFieldView map = laid_.view();
  std::vector<double> heights;
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column)
      heights.push_back(map.heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(map.columns) +
                                    static_cast<std::size_t>(column)] -
                        map_.rutAt(map.xMin + column * map.dx, map.yMin + row * map.dy));
  return heights;
}

std::optional<GroundFields> ScmGround::fieldsNow() const {
  GroundFields fields{setup_.soil, map_.spacing(), {}, 0};
  if (!contacts_) return fields;
  map_.forEach([&](std::int32_t i, std::int32_t j, const scm::Node& node) {
    if (!node.isLoaded()) return;
    fields.nodes.push_back({i, j, node.rut(), 0, std::max(node.state.pressure, node.loose.pressure), {}});
    fields.deepest = std::max(fields.deepest, node.state.sinkage);
  });
  const auto before = [](const SoilNode& a, const SoilNode& b) { return std::pair(a.j, a.i) < std::pair(b.j, b.i); };
  std::sort(fields.nodes.begin(), fields.nodes.end(), before);
  contacts_->forEachLoaded([&](const scm::NodeStress& stress) {
    SoilNode here;
    here.i = stress.i, here.j = stress.j;
    SoilNode& node = *std::lower_bound(fields.nodes.begin(), fields.nodes.end(), here, before);
    node.sinkage = std::max(node.sinkage, stress.depth);
    node.pressure += stress.pressure, node.shear += stress.shear;
  });
  return fields;
}

void ScmGround::restore(const SimulationState& state) {
  if (!state.ground)
    throw base::InputError("the saved state contains no deformable soil; resume with the scene that was run");
  saved_ = *state.ground;
}

void ScmGround::save(SimulationState& state) const {
  if (contacts_) state.ground = contacts_->save();
}

} // namespace grouser::coupling
