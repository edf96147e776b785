// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/fluid_datasets.hpp"

#include "base/error.hpp"
#include "runs/output/flat.hpp"
#include "runs/output/xdmf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::output {

namespace {

using Numbers = std::vector<float>;

struct FluidDataset {
  const char* name;
  std::uint64_t width; ///< 1: scalar, 3: vector
  std::vector<base::Vec3f> FluidPoints::*vectors;
  std::vector<float> FluidPoints::*scalars;
  const char *unit, *help;
};
const FluidDataset kDatasets[] = {
    {"position", 3, &FluidPoints::position, nullptr, "m",
     "positions of the fluid particles, ordered by particle number"},
    {"velocity", 3, &FluidPoints::velocity, nullptr, "m/s", "velocities of the particles"},
    {"pressure", 1, nullptr, &FluidPoints::pressure, "Pa", "pressures of the particles"},
};

std::string groupOf(const std::string& frame) { return frame + "/fluid"; }
std::string datasetOf(const std::string& frame, const FluidDataset& d) { return groupOf(frame) + "/" + d.name; }

} // namespace

std::uint64_t bytesOfFluid(const FluidPoints& fluid) {
  constexpr std::uint64_t kOwn = 8192, kNumbers = 7; // overhead of HDF5; numbers per particle
  return kOwn + fluid.position.size() * (kNumbers * sizeof(float) + sizeof(std::uint32_t));
}

void writeFluid(support::Hdf5File& file, const std::string& frame, const FluidPoints& fluid) {
  for (const FluidDataset& d : kDatasets) {
    if (d.scalars)
      file.write(datasetOf(frame, d), fluid.*d.scalars, {(fluid.*d.scalars).size()});
    else
      file.write(datasetOf(frame, d), flat(fluid.*d.vectors), {(fluid.*d.vectors).size(), 3});
  }
  file.attribute(groupOf(frame), "spacing", fluid.spacing);
}

std::uint64_t fluidCount(const support::Hdf5File& file, const std::string& frame) {
  const std::string position = datasetOf(frame, kDatasets[0]);
  return file.has(position) ? file.shape(position).front() : 0;
}

std::string fluidXdmf(const support::Hdf5File& file, const std::string& frame) {
  const std::uint64_t count = fluidCount(file, frame);
  std::string content;
  for (const FluidDataset& d : kDatasets) {
    const std::string dataset = datasetOf(frame, d);
    content += &d == kDatasets ? xdmf::geometry(count, dataset)
                               : xdmf::attribute(d.name, "Node", count, d.width, "Float", dataset);
  }
  return content;
}

std::shared_ptr<const FluidPoints> readFluid(const support::Hdf5File& file, const std::string& frame) {
  const std::uint64_t count = fluidCount(file, frame);
  if (count == 0) return {};
  auto fluid = std::make_shared<FluidPoints>();
  for (const FluidDataset& d : kDatasets) {
    const std::string dataset = datasetOf(frame, d);
    Numbers numbers = file.read<float>(dataset);
    if (numbers.size() != count * d.width || std::any_of(numbers.begin(), numbers.end(), [&](float x) {
          return !std::isfinite(x) || (&d == kDatasets && !isLength(x));
        }))
      throw base::InputError(
          fmt::format("{}: {} must have a finite value for each particle{}; the file is damaged or was written by "
                      "another program; run the scene again, or restore the file from a copy",
                      file.path().string(), dataset, &d == kDatasets ? " up to 1e7 m" : ""));
    if (d.scalars)
      (*fluid).*d.scalars = std::move(numbers);
    else
      for (std::size_t i = 0; i < numbers.size(); i += 3)
        ((*fluid).*d.vectors).push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  }
  fluid->spacing = file.number(groupOf(frame), "spacing");
  if (!(fluid->spacing > 0) || !isLength(static_cast<float>(fluid->spacing)))
    throw base::InputError(
        fmt::format("{}: the attribute spacing of {} must be in (0, 1e7] m; the file is damaged or was "
                    "written by another program; run the scene again, or restore the file from a copy",
                    file.path().string(), groupOf(frame)));
  return fluid;
}

void drawFluid(const FluidPoints& fluid, std::vector<base::Vec3f>& positions, std::vector<float>& radii,
               std::vector<float>& speeds) {
  constexpr double kRadius = 0.75; // [spacings]; leaves no gaps between spheres on a lattice
  positions.insert(positions.end(), fluid.position.begin(), fluid.position.end());
  radii.insert(radii.end(), fluid.position.size(), static_cast<float>(kRadius * fluid.spacing));
  for (const base::Vec3f& v : fluid.velocity) speeds.push_back(norm(v));
}

std::vector<support::FileField> fluidFields(const std::string& frame) {
  std::vector<support::FileField> fields{
      {frame + "fluid@spacing", "float64", "", "m", "initial spacing of the particles"}};
  for (const FluidDataset& d : kDatasets)
    fields.push_back(
        {frame + "fluid/" + d.name, "float32", d.width == 1 ? "[particles]" : "[particles, 3]", d.unit, d.help});
  return fields;
}

} // namespace grouser::output
