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
  c.add("kinetic", "J", "kinetic energy of the fluid", [](const F& f) { return f.totals.kinetic; });
  c.add("potential", "J", "potential energy of the fluid in the field of gravity, zero at the origin",
        [](const F& f) { return f.totals.potential; });
  c.add("compression", "J", "energy of compression", [](const F& f) { return f.totals.internal; });
  c.add("viscous_loss", "J", "energy dissipated by laminar and artificial viscosity since the start",
        [](const F& f) { return f.totals.viscousLoss; });
  c.add("diffusion_loss", "J", "energy dissipated by density diffusion since the start; negative: energy gain",
        [](const F& f) { return f.totals.diffusionLoss; });
  c.add("wall_loss", "J", "compression energy dissipated at walls and bodies; negative: energy gain",
        [](const F& f) { return f.totals.wallLoss; });
  c.add("momentum", "N s", "momentum of the fluid", [](const F& f) { return f.totals.momentum; });
  c.add("wall_force", "N", "total force of the fluid on walls and bodies in the last step",
        [](const F& f) { return f.totals.wallForce; });
  c.add("max_speed", "m/s", "speed of the fastest particle", [](const F& f) { return f.totals.fastest; });
  c.add("mass", "kg", "mass of all particles", &F::mass);
  c.add("rebuilds", "-", "rebuilds of the neighbour lists since the start", &F::rebuilds);
  for (std::size_t k = 0; k < probes.size(); ++k)
    c.add("probes/" + probes[k].name, probes[k].level ? "m" : "Pa",
          probes[k].level ? "fluid level: z of the lower end of the wire plus its wetted length"
                          : "pressure at the probe; 0 if no particles are nearby",
          [k](const F& f) { return f.probes[k]; });
  for (std::size_t k = 0; k < loads.size(); ++k) {
    const bool track = loads[k].ends_with("_track");
    c.add(loads[k] + "/force", "N",
          track ? "force of the fluid on the shoes and wheels of the track, in the last step"
                : "force of the fluid on the body, in the last step",
          [k](const F& f) { return f.loads[k].force; });
    c.add(loads[k] + "/torque", "N m",
          track ? "torque of the fluid on shoes and wheels about the hull's centre of mass"
                : "torque of the fluid on the body about its centre of mass",
          [k](const F& f) { return f.loads[k].torque; });
  }
  return c;
}

} // namespace grouser::output
