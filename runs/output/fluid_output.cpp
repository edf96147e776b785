// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/fluid_output.hpp"

namespace grouser::output {

FluidReading fluidReading(coupling::FluidDomain& fluid, const multibody::State* bodies) {
  const fluid::Fluid& f = fluid.fluid();
  return {fluid.totals(), f.model().mass() * static_cast<double>(f.particles()), fluid.probe(),
          fluid.columnLoads(bodies), f.rebuilds()};
}

Columns<FluidReading> fluidColumns(const std::vector<coupling::FluidProbePoint>& probes,
                                   const std::vector<std::string>& loads) {
  using F = FluidReading;
  Columns<F> c("fluid/");
  c.add("kinetic", "J", "of the fluid", [](const F& f) { return f.totals.kinetic; });
  c.add("potential", "J", "of the fluid in the field of gravity, zero at the origin",
        [](const F& f) { return f.totals.potential; });
  c.add("compression", "J", "energy of compression", [](const F& f) { return f.totals.internal; });
  c.add("viscous_loss", "J", "by laminar and artificial viscosity since the start",
        [](const F& f) { return f.totals.viscousLoss; });
  c.add("diffusion_loss", "J", "by density diffusion since the start; gained where negative",
        [](const F& f) { return f.totals.diffusionLoss; });
  c.add("wall_loss", "J", "of compression at walls and bodies, which store none; gained where negative",
        [](const F& f) { return f.totals.wallLoss; });
  c.add("momentum", "N s", "of the fluid", [](const F& f) { return f.totals.momentum; });
  c.add("wall_force", "N", "of the fluid on walls and bodies together, in the last step",
        [](const F& f) { return f.totals.wallForce; });
  c.add("max_speed", "m/s", "fastest particle", [](const F& f) { return f.totals.fastest; });
  c.add("mass", "kg", "of all particles", &F::mass);
  c.add("rebuilds", "-", "neighbour lists built so far", &F::rebuilds);
  for (std::size_t k = 0; k < probes.size(); ++k)
    c.add("probes/" + probes[k].name, probes[k].level ? "m" : "Pa",
          probes[k].level ? "z of the foot plus wetted length of the wire"
                          : "pressure at the probe; 0 where no particle is near",
          [k](const F& f) { return f.probes[k]; });
  for (std::size_t k = 0; k < loads.size(); ++k) {
    const bool track = loads[k].ends_with("_track");
    c.add(loads[k] + "/force", "N",
          track ? "of the fluid on the shoes and wheels of the track, in the last step"
                : "of the fluid on the body, in the last step",
          [k](const F& f) { return f.loads[k].force; });
    c.add(loads[k] + "/torque", "N m",
          track ? "of the fluid on these about the hull's centre of mass"
                : "of the fluid on the body about its centre of mass",
          [k](const F& f) { return f.loads[k].torque; });
  }
  return c;
}

} // namespace grouser::output
