// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/frames_file.hpp"

#include "runs/output/field_datasets.hpp"
#include "runs/output/flat.hpp"
#include "runs/output/fluid_datasets.hpp"
#include "runs/output/soil_datasets.hpp"
#include "runs/output/xdmf.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string_view>

namespace grouser::output {

namespace {

/// Number of vertex indices that are written at a time.
constexpr std::size_t kVertexBlock = std::size_t{1} << 20;

using xdmf::attribute, xdmf::geometry, xdmf::grid, xdmf::item, xdmf::triangles;

std::vector<float> speedsOf(const Frame& frame) {
  std::vector<float> speeds;
  speeds.reserve(frame.velocities.size());
  for (const base::Vec3f& v : frame.velocities) speeds.push_back(norm(v));
  return speeds;
}

/// A quantity of each grain in frames.h5, besides its id.
struct GrainDataset {
  const char* name;                           ///< in the file and in ParaView
  std::uint64_t width;                        ///< number of components
  std::vector<float> (*values)(const Frame&); ///< all grains of this rank; empty if the frame lacks the quantity
  const char *unit, *help;
};
constexpr const char* kPosition = "position"; // in ParaView, the points themselves
const GrainDataset kGrainDatasets[] = {
    {kPosition, 3, [](const Frame& f) { return flat(f.positions); }, "m", "position of the centre"},
    {"radius", 1, [](const Frame& f) { return f.radii; }, "m", "grain radius"},
    {"speed", 1, speedsOf, "m/s", "speed of the centre"},
    {"velocity", 3, [](const Frame& f) { return flat(f.velocities); }, "m/s", "velocity of the centre"},
    {"contact_force", 3, [](const Frame& f) { return flat(f.contactForces); }, "N",
     "resultant contact force; NaN before the first step, 0 for fixed grains"},
    {"fixed", 1, [](const Frame& f) { return f.fixed; }, "-", "1 for fixed grains, 0 for others"},
};

/// Whether frames of this kind have the dataset; equal on all ranks, including ranks without grains.
bool hasDataset(std::string_view name, const Frame& frame) {
  return name == "contact_force" ? frame.withContactForces : name != "fixed" || frame.withFixed;
}

std::vector<std::uint64_t> shapeOf(std::uint64_t grains, std::uint64_t width) {
  return width == 1 ? std::vector{grains} : std::vector{grains, width};
}

std::string groupOf(std::int64_t frame) { return fmt::format("/{:06}", frame); }

} // namespace

FramesFile::FramesFile(const std::filesystem::path& folder, std::vector<FramePart> parts,
                       const base::TriangleMesh& ground, const base::Comm& comm)
    : FramesFile(folder, comm.first() ? std::optional(support::Hdf5File::create(folder / "frames.h5")) : std::nullopt,
                 std::move(parts), ground, comm) {}

FramesFile::FramesFile(const std::filesystem::path& folder, std::optional<support::Hdf5File> file,
                       std::vector<FramePart> parts, const base::TriangleMesh& ground, const base::Comm& comm)
    : folder_(folder), comm_(comm), file_(std::move(file)), parts_(std::move(parts)) {
  if (!file_) return;
  std::vector<std::uint32_t> corners, partOf, kindOf;
  std::vector<std::string> names, kinds;
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const FramePart& part = parts_[p];
    const std::string_view word = base::wordOf(part.kind);
    const auto kind = std::find(kinds.begin(), kinds.end(), word) - kinds.begin();
    if (kind == static_cast<std::ptrdiff_t>(kinds.size())) kinds.emplace_back(word);
    names.push_back(part.name);
    for (const std::uint32_t i : part.mesh.indices) corners.push_back(static_cast<std::uint32_t>(partVertices_) + i);
    partOf.insert(partOf.end(), part.mesh.indices.size() / 3, static_cast<std::uint32_t>(p));
    kindOf.insert(kindOf.end(), part.mesh.indices.size() / 3, static_cast<std::uint32_t>(kind));
    partVertices_ += part.mesh.vertices.size();
  }
  partTriangles_ = corners.size() / 3;
  if (partTriangles_ && !file_->has("/parts/triangles")) {
    file_->write("/parts/triangles", corners, {partTriangles_, 3});
    file_->write("/parts/part", partOf, {partTriangles_});
    file_->write("/parts/kind", kindOf, {partTriangles_});
    file_->attribute("/parts/part", "names", names);
    file_->attribute("/parts/kind", "names", kinds);
  }
  groundVertices_ = ground.vertices.size(), groundTriangles_ = ground.indices.size() / 3;
  if (groundTriangles_ && !file_->has("/ground/position")) {
    file_->write("/ground/position", flat(ground.vertices), {groundVertices_, 3});
    file_->write("/ground/triangles", ground.indices, {groundTriangles_, 3});
  }
}

FramesFile FramesFile::goOn(const std::filesystem::path& folder, std::vector<FramePart> parts,
                            const base::TriangleMesh& ground, std::int64_t kept, const base::Comm& comm) {
  FramesFile frames(folder,
                    comm.first() ? std::optional(support::Hdf5File::openToChange(folder / "frames.h5")) : std::nullopt,
                    std::move(parts), ground, comm);
  if (!frames.file_) {
    frames.count_ = kept;
    return frames;
  }
  std::set<std::string> counts; // numbers of grains of the kept frames
  for (std::int64_t i = 0; frames.file_->has(groupOf(i)); ++i) {
    const std::string group = groupOf(i);
    if (i >= kept) {
      frames.file_->remove(group);
      continue;
    }
    const std::string position = group + "/grains/position";
    const std::uint64_t grains = frames.file_->has(position) ? frames.file_->shape(position)[0] : 0;
    if (grains) counts.insert(std::to_string(grains));
    if (const std::uint64_t particles = fluidCount(*frames.file_, group)) counts.insert(std::to_string(particles));
    frames.describe(grains, static_cast<std::int64_t>(frames.file_->number(group, "step")),
                    frames.file_->number(group, "time"));
  }
  // Removes lists of vertices that only removed frames used, including a list that a killed run left incomplete.
  for (const std::string& list : frames.file_->members("/vertices"))
    if (!counts.contains(list)) frames.file_->remove("/vertices/" + list);
  if (counts.empty() && frames.file_->has("/vertices")) frames.file_->remove("/vertices");
  frames.file_->flush();
  if (!frames.steps_.empty()) frames.writeXdmf();
  return frames;
}

std::int64_t FramesFile::framesUpTo(const std::filesystem::path& folder, std::int64_t lastStep, std::int64_t most) {
  const support::Hdf5File file = support::Hdf5File::open(folder / "frames.h5");
  std::int64_t count = 0;
  for (const char* shared : {"/parts", "/ground", "/vertices"}) readThrough(file, shared);
  support::Progress progress("reading frames"); // minutes for many grains
  for (; count < most && file.has(groupOf(count)); ++count) {
    progress.update(static_cast<double>(count) / static_cast<double>(most), fmt::format("frame {} of {}", count, most));
    if (!(file.number(groupOf(count), "step") <= static_cast<double>(lastStep))) break;
    readThrough(file, groupOf(count));
  }
  for (std::int64_t later = count; file.has(groupOf(later)); ++later) readThrough(file, groupOf(later), false);
  return count;
}

void FramesFile::add(const Frame& frame) {
  const std::size_t grains = frame.positions.size();
  if (frame.radii.size() != grains || frame.velocities.size() != grains || frame.ids.size() != grains ||
      frame.contactForces.size() != (frame.withContactForces ? grains : 0) ||
      frame.fixed.size() != (frame.withFixed ? grains : 0) || frame.partPoses.size() != parts_.size())
    throw std::logic_error("a frame's arrays differ in length");
  const std::string group = groupOf(count_);
  const auto total = static_cast<std::uint64_t>(comm_.sumOf(static_cast<std::int64_t>(grains)));
  if (file_) requireRoom(*file_, bytesOf(frame, total));
  if (file_) writeAllButGrains(frame, group, total);
  if (total > 0 && comm_.alone()) writeGrains(*file_, frame, group);
  if (total > 0 && !comm_.alone()) {
    file_.reset(); // closed by the first rank, then opened by all ranks
    comm_.wait();
    std::optional<support::Hdf5File> shared = support::Hdf5File::openShared(folder_ / "frames.h5", comm_);
    writeGrains(*shared, frame, group);
    shared.reset();
    comm_.wait();
    if (comm_.first()) file_ = support::Hdf5File::openShared(folder_ / "frames.h5", base::Comm());
  }
  if (!file_) {
    ++count_;
    return;
  }
  describe(total, frame.step, frame.time);
  file_->flush();
  if (!steps_.empty()) writeXdmf();
}

/// Upper bound of the size of a frame [bytes], including the overhead of HDF5.
std::uint64_t FramesFile::bytesOf(const Frame& frame, std::uint64_t grains) const {
  constexpr std::uint64_t kOwn = 32768, kAName = 64;
  std::uint64_t aGrain = 2 * sizeof(std::uint32_t); // id and list of vertices
  for (const GrainDataset& d : kGrainDatasets) aGrain += d.width * sizeof(float);
  std::uint64_t cuts = 0;
  for (const std::vector<double>& places : frame.borders) cuts += places.size();
  return kOwn + (frame.fields ? output::bytesOfFields(frame.fields->grid.count()) : 0) +
         (frame.soil ? bytesOfSoil(*frame.soil) : 0) + (frame.fluid ? bytesOfFluid(*frame.fluid) : 0) +
         kAName * static_cast<std::uint64_t>(count_) + grains * aGrain + partVertices_ * 3 * sizeof(float) +
         cuts * sizeof(double);
}

void FramesFile::writeAllButGrains(const Frame& frame, const std::string& group, std::uint64_t grains) {
  file_->makeGroup(group);
  file_->attribute(group, "time", frame.time);
  file_->attribute(group, "step", static_cast<double>(frame.step));
  if (grains > 0) {
    const std::string at = group + "/grains";
    for (const GrainDataset& d : kGrainDatasets)
      if (hasDataset(d.name, frame)) file_->reserve<float>(at + "/" + d.name, shapeOf(grains, d.width));
    file_->reserve<std::uint32_t>(at + "/id", {grains});
  }
  if (partTriangles_) {
    std::vector<base::Vec3d> world;
    world.reserve(partVertices_);
    for (std::size_t p = 0; p < parts_.size(); ++p)
      for (const base::Vec3d& v : parts_[p].mesh.vertices) world.push_back(frame.partPoses[p].toWorld(v));
    file_->write(group + "/parts/position", flat(world), {partVertices_, 3});
    std::vector<double> poses;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      const base::Pose& pose = frame.partPoses[p];
      for (const double v : {pose.position.x, pose.position.y, pose.position.z, pose.orientation.w, pose.orientation.x,
                             pose.orientation.y, pose.orientation.z})
        poses.push_back(v);
    }
    file_->write(group + "/parts/pose", poses, {parts_.size(), 7});
    file_->attribute(group + "/parts/pose", "columns", std::vector<std::string>{"x", "y", "z", "qw", "qx", "qy", "qz"});
  }
  if (frame.fields) writeFields(*file_, group, *frame.fields);
  if (frame.soil) writeSoil(*file_, group, *frame.soil);
  if (frame.fluid) writeFluid(*file_, group, *frame.fluid);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const std::vector<double>& places = frame.borders[axis]; !places.empty())
      file_->write(group + "/partition/" + "xyz" [axis], places, { places.size() });
}

/// Rows of this rank's grains in the datasets.
void FramesFile::writeGrains(support::Hdf5File& file, const Frame& frame, const std::string& group) const {
  const std::size_t grains = frame.positions.size();
  const auto first = static_cast<std::uint64_t>(comm_.sumBelow(static_cast<std::int64_t>(grains)));
  const std::string at = group + "/grains";
  for (const GrainDataset& d : kGrainDatasets)
    if (hasDataset(d.name, frame)) file.writeRows(at + "/" + d.name, first, d.values(frame));
  file.writeRows(at + "/id", first, frame.ids);
}

/// The list 0, 1, 2... of `grains` vertices, shared by all frames with this number of grains. Not every reader can
/// generate this list.
std::string FramesFile::listVertices(std::size_t grains) {
  std::string list = fmt::format("/vertices/{}", grains);
  if (file_->has(list)) return list;
  file_->reserve<std::uint32_t>(list, {grains, 1});
  std::vector<std::uint32_t> block;
  for (std::size_t first = 0; first < grains; first += block.size()) {
    block.resize(std::min(kVertexBlock, grains - first));
    std::iota(block.begin(), block.end(), static_cast<std::uint32_t>(first));
    file_->writeRows(list, first, block);
  }
  return list;
}

std::string FramesFile::pointsTopology(std::size_t points) {
  return fmt::format(
      "        <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\">{}</Topology>\n",
      points, item(fmt::format("{} 1", points), "UInt", 4, listVertices(points)));
}

void FramesFile::describe(std::size_t grains, std::int64_t step, double time) {
  const std::string group = groupOf(count_++);
  std::string grids;
  if (grains) {
    const std::string at = group + "/grains";
    std::string attributes;
    for (const GrainDataset& d : kGrainDatasets)
      if (d.name != kPosition && file_->has(at + "/" + d.name))
        attributes += attribute(d.name, "Node", grains, d.width, "Float", at + "/" + d.name);
    grids += grid("grains", pointsTopology(grains) + geometry(grains, at + "/" + kPosition) + attributes +
                                attribute("id", "Node", grains, 1, "UInt", at + "/id"));
  }
  if (const std::uint64_t particles = fluidCount(*file_, group))
    grids += grid("fluid", pointsTopology(particles) + fluidXdmf(*file_, group));
  if (partTriangles_)
    grids += grid("parts", triangles(partTriangles_, "/parts/triangles") +
                               geometry(partVertices_, group + "/parts/position") +
                               attribute("part", "Cell", partTriangles_, 1, "UInt", "/parts/part") +
                               attribute("kind", "Cell", partTriangles_, 1, "UInt", "/parts/kind"));
  if (const std::string soil = soilXdmf(*file_, group); !soil.empty())
    grids += soil; // replaces the undisturbed ground
  else if (groundTriangles_)
    grids += grid("ground",
                  triangles(groundTriangles_, "/ground/triangles") + geometry(groundVertices_, "/ground/position"));
  grids += fieldsXdmf(*file_, group);
  if (grids.empty()) return;
  steps_ += fmt::format("    <Grid Name=\"step {}\" GridType=\"Collection\" CollectionType=\"Spatial\">\n      <Time "
                        "Value=\"{}\"/>\n{}    </Grid>\n",
                        step, time, grids);
}

std::vector<support::FileField> frameFields() {
  const std::string frame = "FRAME/", grains = frame + "grains/";
  std::vector<support::FileField> fields{
      {"FRAME@time", "float64", "", "s", "time of the frame; FRAME is the frame number with at least six digits"},
      {"FRAME@step", "float64", "", "-", "step number of the frame"},
      {grains + "id", "uint32", "[grains]", "-", "identifier of each grain, constant during the run"}};
  for (const GrainDataset& d : kGrainDatasets)
    fields.push_back(
        {grains + d.name, "float32", d.width == 1 ? "[grains]" : fmt::format("[grains, {}]", d.width), d.unit, d.help});
  for (const auto& more : {soilFieldFields(frame), soilSurfaceFields(frame), fluidFields(frame)})
    fields.insert(fields.end(), more.begin(), more.end());
  const char* corners = "vertex indices of each triangle";
  const std::vector<support::FileField> others{
      {frame + "parts/pose", "float64", "[parts, 7]", "m, -",
       "position and orientation quaternion (scalar first) of each part in the world frame"},
      {frame + "parts/pose@columns", "texts", "[7]", "", "names of the seven columns"},
      {frame + "parts/position", "float32", "[vertices, 3]", "m", "world positions of the vertices of all parts"},
      {frame + "partition/AXIS", "float64", "[borders]", "m",
       "positions of the borders between subdomains along x, y and z"},
      {"parts/triangles", "uint32", "[triangles, 3]", "-", corners},
      {"parts/part", "uint32", "[triangles]", "-", "index into names: part of each triangle"},
      {"parts/part@names", "texts", "[parts]", "", "names of the parts"},
      {"parts/kind", "uint32", "[triangles]", "-", "index into names: kind of part of each triangle"},
      {"parts/kind@names", "texts", "[kinds]", "", "names of the kinds"},
      {"ground/position", "float32", "[vertices, 3]", "m", "vertices of rigid ground and planes"},
      {"ground/triangles", "uint32", "[triangles, 3]", "-", corners},
      {"vertices/NUMBER", "uint32", "[NUMBER, 1]", "-",
       "0, 1, 2... for frames with this number of grains; required by ParaView"}};
  fields.insert(fields.end(), others.begin(), others.end());
  return fields;
}

void FramesFile::writeXdmf() const {
  constexpr const char* kHead =
      "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"2.0\">\n<Domain>\n  <Grid Name=\"run\" GridType=\"Collection\" "
      "CollectionType=\"Temporal\">\n";
  support::replaceTextFile(folder_ / "frames.xdmf", kHead + steps_ + "  </Grid>\n</Domain>\n</Xdmf>\n");
}

} // namespace grouser::output
