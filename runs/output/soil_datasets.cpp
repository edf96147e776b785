// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/soil_datasets.hpp"

#include "base/error.hpp"
#include "runs/output/flat.hpp"
#include "runs/output/xdmf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::output {

namespace {

using Numbers = std::vector<float>;

/// A quantity of each vertex.
struct SoilDataset {
  const char* name;
  std::uint64_t width; ///< 1: scalar, 3: vector
  Numbers (*values)(const SoilSurface&);
  void (*set)(SoilSurface&, Numbers);
  const char *unit, *help;
};

const SoilDataset kSoilDatasets[] = {
    {"position", 3, [](const SoilSurface& s) { return flat(s.mesh.vertices); },
     [](SoilSurface& s, Numbers n) {
       for (std::size_t v = 0; v + 2 < n.size(); v += 3)
         s.mesh.vertices.push_back({double{n[v]}, double{n[v + 1]}, double{n[v + 2]}});
     },
     "m", "vertices of the deformed soil surface, at node spacing where it was touched, coarser elsewhere"},
    {"sinkage", 1, [](const SoilSurface& s) { return s.sinkage; },
     [](SoilSurface& s, Numbers n) { s.sinkage = std::move(n); }, "m",
     "sinkage below the undisturbed surface; negative above it"},
    {"pressure", 1, [](const SoilSurface& s) { return s.pressure; },
     [](SoilSurface& s, Numbers n) { s.pressure = std::move(n); }, "Pa",
     "pressure on the soil without damping, mean over the grid cell of the node"},
    {"max_pressure", 1, [](const SoilSurface& s) { return s.maxPressure; },
     [](SoilSurface& s, Numbers n) { s.maxPressure = std::move(n); }, "Pa", "maximum pressure since the start"},
    {"shear", 1,
     [](const SoilSurface& s) {
       Numbers all;
       for (const base::Vec3f& v : s.shear) all.push_back(norm(v));
       return all;
     },
     [](SoilSurface&, Numbers) {}, "Pa", "magnitude of the shear stress on the soil"},
    {"shear_vector", 3, [](const SoilSurface& s) { return flat(s.shear); },
     [](SoilSurface& s, Numbers n) {
       for (std::size_t v = 0; v + 2 < n.size(); v += 3) s.shear.push_back({n[v], n[v + 1], n[v + 2]});
     },
     "Pa", "shear stress on the soil"},
};

constexpr const char* kTriangles = "/soil/triangles";

std::string datasetOf(const std::string& frame, const SoilDataset& d) { return frame + "/soil/" + d.name; }

} // namespace

std::uint64_t bytesOfSoil(const SoilSurface& soil) {
  constexpr std::uint64_t kOwn = 4096; // overhead of HDF5 for a dataset
  std::uint64_t bytes = kOwn + soil.mesh.indices.size() * sizeof(std::uint32_t);
  for (const SoilDataset& d : kSoilDatasets) bytes += kOwn + soil.mesh.vertices.size() * d.width * sizeof(float);
  return bytes + bytes / 100; // incompressible data grow by less than 1 %
}

void writeSoil(support::Hdf5File& file, const std::string& frame, const SoilSurface& soil) {
  file.write(frame + kTriangles, soil.mesh.indices, {soil.mesh.indices.size() / 3, 3}, true);
  for (const SoilDataset& d : kSoilDatasets) {
    const Numbers numbers = d.values(soil);
    const std::uint64_t vertices = numbers.size() / d.width;
    file.write(datasetOf(frame, d), numbers, d.width == 1 ? std::vector{vertices} : std::vector{vertices, d.width},
               true);
  }
}

std::string soilXdmf(const support::Hdf5File& file, const std::string& frame) {
  if (!file.has(frame + kTriangles)) return {};
  std::string content = xdmf::triangles(file.shape(frame + kTriangles).front(), frame + kTriangles);
  for (const SoilDataset& d : kSoilDatasets) {
    const std::string dataset = datasetOf(frame, d);
    const std::uint64_t vertices = file.shape(dataset).front();
    content += &d == kSoilDatasets ? xdmf::geometry(vertices, dataset)
                                   : xdmf::attribute(d.name, "Node", vertices, d.width, "Float", dataset);
  }
  return xdmf::grid("ground", content);
}

std::shared_ptr<const SoilSurface> readSoil(const support::Hdf5File& file, const std::string& frame) {
  if (!file.has(frame + kTriangles)) return {};
  const auto damaged = [&](const std::string& dataset, const char* why) {
    return base::InputError(fmt::format("{}: {} {}; the file is damaged or was written by another program; run the "
                                        "scene again, or restore the file from a copy",
                                        file.path().string(), dataset, why));
  };
  auto soil = std::make_shared<SoilSurface>();
  soil->mesh.indices = file.read<std::uint32_t>(frame + kTriangles);
  if (soil->mesh.indices.size() % 3 != 0) throw damaged(frame + kTriangles, "is not a list of triangles");
  for (const SoilDataset& d : kSoilDatasets) {
    const std::string dataset = datasetOf(frame, d);
    Numbers numbers = file.read<float>(dataset);
    const bool isPosition = &d == kSoilDatasets;
    if (!isPosition && numbers.size() != soil->mesh.vertices.size() * d.width)
      throw damaged(dataset, "must have one value for each vertex");
    if (std::any_of(numbers.begin(), numbers.end(),
                    [&](float x) { return !std::isfinite(x) || (isPosition && !isLength(x)); }))
      throw damaged(dataset,
                    isPosition ? "has a value that is not finite, or above 1e7 m" : "has a value that is not finite");
    d.set(*soil, std::move(numbers));
  }
  for (const std::uint32_t v : soil->mesh.indices)
    if (v >= soil->mesh.vertices.size()) throw damaged(frame + kTriangles, "has an invalid vertex index");
  return soil;
}

std::vector<support::FileField> soilSurfaceFields(const std::string& frame) {
  std::vector<support::FileField> fields{{frame + "soil/triangles", "uint32", "[triangles, 3]", "-",
                                          "vertex indices of each triangle of the soil surface"}};
  for (const SoilDataset& d : kSoilDatasets)
    fields.push_back(
        {frame + "soil/" + d.name, "float32", d.width == 1 ? "[vertices]" : "[vertices, 3]", d.unit, d.help});
  return fields;
}

} // namespace grouser::output
