// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/field_datasets.hpp"

#include "base/error.hpp"
#include "runs/output/xdmf.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace grouser::output {

namespace {

using terrain::SoilFields;
using Numbers = std::vector<float>;

Numbers ofScalars(const std::vector<double>& values) { return {values.begin(), values.end()}; }
Numbers ofVectors(const std::vector<base::Vec3d>& values) {
  Numbers all;
  for (const base::Vec3d& v : values)
    for (int a = 0; a < 3; ++a) all.push_back(static_cast<float>(v[a]));
  return all;
}
Numbers ofTensors(const std::vector<terrain::Tensor6>& values) {
  Numbers all;
  for (const terrain::Tensor6& t : values)
    for (const double v : t) all.push_back(static_cast<float>(v));
  return all;
}

/// A quantity of each cell.
struct FieldDataset {
  const char* name;
  std::uint64_t width; ///< 1: scalar, 3: vector, 6: symmetric tensor xx, xy, xz, yy, yz, zz (order of XDMF)
  Numbers (*values)(const SoilFields&);
  const char *unit, *help;
};
const FieldDataset kFieldDatasets[] = {
    {"stress", 6, [](const SoilFields& f) { return ofTensors(f.stress); }, "Pa",
     "Love-Weber stress xx, xy, xz, yy, yz, zz, mean over the cell including pores; negative in compression"},
    {"strain_rate", 6, [](const SoilFields& f) { return ofTensors(f.strainRate); }, "1/s",
     "strain rate xx, xy, xz, yy, yz, zz of a linear velocity field fitted to the grains of the cell; NaN if the cell "
     "contains too few grains"},
    {"velocity", 3, [](const SoilFields& f) { return ofVectors(f.velocity); }, "m/s",
     "mass-weighted mean velocity of the grains; NaN in a cell without grains"},
    {"porosity", 1, [](const SoilFields& f) { return ofScalars(f.porosity); }, "-",
     "porosity: pore volume / cell volume"},
    {"coordination", 1, [](const SoilFields& f) { return ofScalars(f.coordination); }, "-",
     "mean number of contacts per grain; NaN in a cell without grains"},
    {"mechanical_coordination", 1, [](const SoilFields& f) { return ofScalars(f.mechanicalCoordination); }, "-",
     "mean number of contacts per grain, over grains with two or more contacts"},
};

constexpr std::uint64_t kMaxCells = 1'000'000'000; ///< along an axis, in a file that is not damaged
constexpr const char *kOrigin = "/fields/origin", *kSpacing = "/fields/spacing";

std::vector<std::uint64_t> cellShape(const terrain::FieldGrid& grid, std::uint64_t width) {
  std::vector<std::uint64_t> shape;
  for (std::size_t a = 3; a-- > 0;) shape.push_back(static_cast<std::uint64_t>(grid.cells[a]));
  if (width > 1) shape.push_back(width);
  return shape;
}

/// Reads the grid of a frame's fields.
terrain::FieldGrid gridIn(const support::Hdf5File& file, const std::string& frame) {
  terrain::FieldGrid grid;
  const std::vector<double> low = file.numbers(frame + kOrigin), cell = file.numbers(frame + kSpacing);
  const std::vector<std::uint64_t> shape = file.shape(frame + "/fields/porosity");
  bool isGrid = low.size() == 3 && cell.size() == 3 && shape.size() == 3;
  for (std::size_t a = 0; isGrid && a < 3; ++a)
    isGrid = std::isfinite(low[a]) && std::isfinite(cell[a]) && cell[a] > 0 && shape[a] > 0 && shape[a] <= kMaxCells;
  if (!isGrid)
    throw base::InputError(
        fmt::format("{}: {}/fields is not a grid of cells; the file is damaged; run the scene again, "
                    "or restore the file from a copy",
                    file.path().string(), frame));
  grid.low = {low[0], low[1], low[2]}, grid.cell = {cell[0], cell[1], cell[2]};
  for (std::size_t a = 0; a < 3; ++a) grid.cells[a] = static_cast<int>(shape[2 - a]);
  return grid;
}

} // namespace

std::uint64_t bytesOfFields(std::size_t cells) {
  constexpr std::uint64_t kOwn = 4096; // overhead of HDF5 for a dataset
  std::uint64_t bytes = 0;
  for (const FieldDataset& d : kFieldDatasets) bytes += kOwn + cells * d.width * sizeof(float);
  return bytes;
}

void writeFields(support::Hdf5File& file, const std::string& frame, const SoilFields& fields) {
  const terrain::FieldGrid& g = fields.grid;
  file.write(frame + kOrigin, std::vector{g.low.x, g.low.y, g.low.z}, {3});
  file.write(frame + kSpacing, std::vector{g.cell.x, g.cell.y, g.cell.z}, {3});
  for (const FieldDataset& d : kFieldDatasets)
    file.write(frame + "/fields/" + d.name, d.values(fields), cellShape(g, d.width));
}

std::string fieldsXdmf(const support::Hdf5File& file, const std::string& frame) {
  if (!file.has(frame + kOrigin)) return {};
  const terrain::FieldGrid g = gridIn(file, frame);
  const auto inXml = [](const base::Vec3d& v) { // z first, like the cells
    return fmt::format("<DataItem Dimensions=\"3\" NumberType=\"Float\" Precision=\"8\" Format=\"XML\">{} {} "
                       "{}</DataItem>",
                       v.z, v.y, v.x);
  };
  std::string content = fmt::format("        <Topology TopologyType=\"3DCoRectMesh\" NumberOfElements=\"{} {} {}\"/>\n"
                                    "        <Geometry GeometryType=\"ORIGIN_DXDYDZ\">{}{}</Geometry>\n",
                                    g.cells[2] + 1, g.cells[1] + 1, g.cells[0] + 1, inXml(g.low), inXml(g.cell));
  for (const FieldDataset& d : kFieldDatasets) {
    const std::string dataset = frame + "/fields/" + d.name;
    const char* type = d.width == 1 ? "Scalar" : d.width == 3 ? "Vector" : "Tensor6";
    content +=
        fmt::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Cell\">{}</Attribute>\n", d.name,
                    type, xdmf::item(fmt::format("{}", fmt::join(cellShape(g, d.width), " ")), "Float", 4, dataset));
  }
  return xdmf::grid("fields", content);
}

std::optional<terrain::FieldGrid> formerFieldGrid(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder / "frames.h5")) return {};
  const support::Hdf5File file = support::Hdf5File::open(folder / "frames.h5");
  const std::string first = "/000000";
  return file.has(first + kOrigin) ? std::optional(gridIn(file, first)) : std::nullopt;
}

std::vector<support::FileField> soilFieldFields(const std::string& frame) {
  std::vector<support::FileField> fields{
      {frame + "fields/origin", "float64", "[3]", "m", "lower corner of the grid of output.fields_cell"},
      {frame + "fields/spacing", "float64", "[3]", "m", "size of a cell along x, y, z"}};
  for (const FieldDataset& d : kFieldDatasets)
    fields.push_back({frame + "fields/" + d.name, "float32",
                      d.width == 1 ? "[z, y, x]" : fmt::format("[z, y, x, {}]", d.width), d.unit, d.help});
  return fields;
}

} // namespace grouser::output
