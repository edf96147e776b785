// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/render_command.hpp"

#include "base/error.hpp"
#include "runs/jobs/shared_work.hpp"
#include "runs/render/film.hpp"
#include "runs/render/frame_painter.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/output_place.hpp"
#include "runs/support/progress.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <tuple>

namespace grouser::commands {

namespace fs = std::filesystem;

namespace {

constexpr int kSmallest = 16, kLargest = 16384; ///< width and height of a picture [pixels]

/// Indices of the frames to render, ascending.
std::vector<std::size_t> chosenFrames(const output::FramesReader& reader, const RenderCommand& c) {
  const std::size_t count = reader.count();
  const std::string held = fmt::format("{} contains frames 0 to {}, from t = {:g} s to {:g} s", reader.path().string(),
                                       count - 1, reader.time(0), reader.time(count - 1));
  std::vector<std::size_t> frames = c.frame;
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  if (!frames.empty() && frames.back() >= count)
    throw base::InputError(fmt::format("--frame {}: {}", frames.back(), held));
  if (!frames.empty()) return frames;
  // Output times are sums of time steps: the tolerance covers their rounding errors.
  const double hair = 1e-9 * std::max(1.0, std::fabs(reader.time(count - 1)));
  std::size_t inRange = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (reader.time(i) < c.from - hair || (c.to && reader.time(i) > *c.to + hair)) continue;
    if (inRange++ % c.every == 0) frames.push_back(i);
  }
  if (frames.empty()) throw base::InputError(fmt::format("no frames between --from and --to: {}", held));
  return frames;
}

render::LookAt lookAtOf(const std::string& text, bool hasVehicle, base::Vec3d& point) {
  if (text.empty()) return hasVehicle ? render::LookAt::Vehicle : render::LookAt::All;
  if (text == "vehicle") return render::LookAt::Vehicle;
  if (text == "all") return render::LookAt::All;
  const char *at = text.data(), *end = at + text.size();
  for (int k = 0; k < 3; ++k) {
    const auto [stop, error] = std::from_chars(at, end, point[k]);
    const bool isLast = k == 2;
    if (error != std::errc{} || !std::isfinite(point[k]) || (isLast ? stop != end : stop == end || *stop != ','))
      throw base::InputError(
          fmt::format("--look-at {}: must be vehicle, all or a point X,Y,Z in metres, e.g. 1.5,0,0.2", text));
    at = stop + 1;
  }
  return render::LookAt::Point;
}

render::PaintOptions paintOptions(const RenderCommand& c, bool hasVehicle) {
  render::PaintOptions o;
  render::FrameView& v = o.view;
  v.lookAt = lookAtOf(c.lookAt, hasVehicle, v.point);
  v.azimuth = c.azimuth, v.elevation = c.elevation, v.distance = c.distance;
  std::tie(v.width, v.height) = pictureSize(c.size);
  const std::optional<render::GroundQuantity> ground = render::groundQuantity(c.color);
  if (ground)
    o.ground = *ground;
  else
    o.quantity = render::grainQuantity(c.color);
  if (!c.range.empty()) {
    if (!ground && o.quantity != render::GrainQuantity::Depth && o.quantity != render::GrainQuantity::Speed)
      throw base::InputError(fmt::format(
          "--range: applies to --color depth, speed, sinkage, pressure and shear only, not to {}", c.color));
    if (!(c.range[0] < c.range[1]))
      throw base::InputError(fmt::format("--range {:g} {:g}: put the lower end first", c.range[0], c.range[1]));
    o.range = render::ValueRange{c.range[0], c.range[1]};
  }
  o.borders = render::bordersOf(c.borders);
  o.labels = c.labels;
  return o;
}

fs::path picturePath(const fs::path& folder, std::size_t frame) {
  return folder / fmt::format("frame_{:06}.png", frame);
}

fs::path unfinished(const fs::path& picture) {
  return picture.parent_path() / fmt::format(".{}.part", picture.filename().string());
}

/// Throws if a picture or the film already exists or cannot be written.
void checkTargets(const RenderCommand& c, const fs::path& folder, const std::vector<std::size_t>& frames) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    throw base::InputError(fmt::format("--out {}: is a file; set a folder for the pictures", folder.string()));
  if (!c.film.empty()) render::checkFilm(c.film);
  if (c.force) return;
  for (const std::size_t frame : frames)
    if (const fs::path file = picturePath(folder, frame); fs::exists(file, error))
      throw base::InputError(fmt::format(
          "{}: already exists; overwrite it with --force, or choose another folder with --out", file.string()));
  if (!c.film.empty() && fs::exists(c.film, error))
    throw base::InputError(
        fmt::format("--film {}: already exists; overwrite it with --force, or choose another file", c.film));
}

/// Removes unfinished pictures after an error or a signal.
class Sweeper {
public:
  explicit Sweeper(std::vector<fs::path> pictures) : pictures_(std::move(pictures)) {}
  ~Sweeper() {
    std::error_code error;
    for (const fs::path& picture : pictures_) fs::remove(unfinished(picture), error);
  }
  Sweeper(const Sweeper&) = delete;
  Sweeper& operator=(const Sweeper&) = delete;

private:
  std::vector<fs::path> pictures_;
};

/// Renders the frames of this rank, divided among its processes.
void paintShare(const RenderCommand& c, const render::FramePainter& painter, const std::vector<std::size_t>& frames,
                const fs::path& folder) {
  std::vector<std::size_t> mine;
  std::vector<fs::path> pictures;
  for (std::size_t i = static_cast<std::size_t>(c.comm.rank()); i < frames.size();
       i += static_cast<std::size_t>(c.comm.size()))
    mine.push_back(frames[i]), pictures.push_back(picturePath(folder, frames[i]));
  const Sweeper sweeper(pictures);
  const int processes = std::max(1, std::min(c.processes, static_cast<int>(mine.size())));
  const int threads = c.threads > 0 ? c.threads : std::max(1, support::threadsOfRank(c.comm) / processes);
  support::Progress progress("pictures", c.comm.first());
  std::size_t done = 0;
  const auto paint = [&](std::size_t i) {
    omp_set_num_threads(threads);
    render::writePng(painter.paint(mine[i]), unfinished(pictures[i]));
    fs::rename(unfinished(pictures[i]), pictures[i]);
  };
  jobs::shareWork(processes, mine.size(), paint, [&] {
    ++done;
    progress.update(static_cast<double>(done) / static_cast<double>(mine.size()),
                    fmt::format("{} of {}", done, mine.size()));
  });
}

} // namespace

std::pair<int, int> pictureSize(const std::string& text) {
  int width = 0, height = 0;
  const char* end = text.data() + text.size();
  const auto [middle, error] = std::from_chars(text.data(), end, width);
  bool isGood = error == std::errc{} && middle != end && *middle == 'x';
  if (isGood) {
    const auto [stop, fault] = std::from_chars(middle + 1, end, height);
    isGood = fault == std::errc{} && stop == end;
  }
  if (!isGood || std::min(width, height) < kSmallest || std::max(width, height) > kLargest)
    throw base::InputError(fmt::format("--size {}: expected WIDTHxHEIGHT in pixels, each from {} to {}, e.g. 1600x900",
                                       text, kSmallest, kLargest));
  return {width, height};
}

void renderCommand(const RenderCommand& c) {
  const output::FramesReader reader(c.frames);
  const render::PaintOptions options = paintOptions(c, reader.hasVehicle());
  const std::vector<std::size_t> frames = chosenFrames(reader, c);
  const fs::path folder =
      c.folder.empty() ? fs::absolute(c.frames).lexically_normal().parent_path() / "pictures" : fs::path(c.folder);
  support::requireFolder(folder);
  checkTargets(c, folder, frames);
  const render::FramePainter painter(reader, options);
  c.comm.wait(); // all ranks have checked the targets before the first of them writes
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder, error))
    throw base::InputError(fmt::format("--out {}: cannot create the folder: {}", folder.string(), error.message()));

  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  paintShare(c, painter, frames, folder);
  c.comm.wait();
  if (!c.comm.first()) return;
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  const int workers = std::min<int>(c.comm.size() * c.processes, static_cast<int>(frames.size()));
  fmt::print("pictures  {} of {} x {} in {}\n", frames.size(), options.view.width, options.view.height,
             folder.string());
  fmt::print("speed     {:.2f} frames/s: {:.2f} s with {} process{}\n", static_cast<double>(frames.size()) / seconds,
             seconds, workers, workers == 1 ? "" : "es");
  if (c.film.empty()) return;
  std::vector<fs::path> pictures;
  for (const std::size_t frame : frames) pictures.push_back(picturePath(folder, frame));
  render::makeFilm(pictures, c.framesPerSecond, c.film);
  fmt::print("film      {}: {:g} frames/s, {:.2f} s\n", c.film, c.framesPerSecond,
             static_cast<double>(frames.size()) / c.framesPerSecond);
}

} // namespace grouser::commands
