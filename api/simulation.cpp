// SPDX-License-Identifier: BSD-3-Clause
#include <grouser/simulation.hpp>
#include <grouser/version.hpp>

#include "api/detail/run.hpp"
#include "runs/setup/run_warnings.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/support/build_info.hpp"
#include "terrain/grain_checkpoint.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <utility>

namespace grouser {

namespace {

Vec3 outside(const base::Vec3d& v) { return {v.x, v.y, v.z}; }

} // namespace

const char* version() {
  static const std::string text = support::buildInfo().version;
  return text.c_str();
}

const char* commit() {
  static const std::string text = support::buildInfo().commit;
  return text.c_str();
}

Ranks::Ranks(int& argc, char**& argv) : data_(std::make_unique<detail::RanksData>(argc, argv)) {}
Ranks::~Ranks() = default;
int Ranks::rank() const { return data_->ranks.comm().rank(); }
int Ranks::size() const { return data_->ranks.comm().size(); }
void Ranks::abort(int code) const { data_->ranks.abort(code); }

Simulation::Simulation(std::unique_ptr<detail::Run> run) : run_(std::move(run)) {}
Simulation::Simulation(const Scene& scene, const Options& options)
    : run_(detail::translated([&] { return std::make_unique<detail::Run>(scene, options, std::nullopt); })) {}
Simulation Simulation::resumed(const Scene& scene, const std::filesystem::path& checkpoint, const Options& options) {
  return Simulation(detail::translated([&] { return std::make_unique<detail::Run>(scene, options, checkpoint); }));
}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

void Simulation::step(std::int64_t count, const std::function<bool()>& keepGoing) { run_->step(count, keepGoing); }

void Simulation::stepFor(double seconds) {
  constexpr double kLongest = 1e9; // [s]
  if (!(seconds > 0) || seconds > kLongest)
    throw InputError(fmt::format("stepFor({:g}): the time must be in (0, {:g}] s", seconds, kLongest));
  step(std::max<std::int64_t>(1, std::llround(seconds / run_->now().timeStep())));
}

std::string Simulation::ended() const { return run_->now().vehicle() ? run_->now().vehicle()->ended() : ""; }

double Simulation::time() const { return run_->now().time(); }
double Simulation::timeStep() const { return run_->now().timeStep(); }
std::int64_t Simulation::steps() const { return run_->now().steps(); }
std::string Simulation::device() const { return base::describe(run_->exec); }
bool Simulation::hasVehicle() const { return run_->now().vehicle() != nullptr; }

Vehicle Simulation::vehicle() {
  run_->rig();
  return Vehicle(*run_);
}

std::size_t Simulation::grainCount() const {
  const auto& grains = run_->now().ground().grains;
  return grains ? grains->count() : 0;
}

Grains Simulation::grains() const {
  Grains out;
  const auto& grains = run_->now().ground().grains;
  if (!grains) return out;
  return detail::translated([&] {
    const terrain::GrainSnapshot s = grains->snapshot();
    out.id.assign(s.id.begin(), s.id.end());
    for (const base::Vec3d& p : s.position) out.position.push_back(outside(p));
    for (const base::Vec3f& v : s.velocity) out.velocity.insert(out.velocity.end(), {v.x, v.y, v.z});
    for (const base::Vec3f& w : s.spin) out.spin.insert(out.spin.end(), {w.x, w.y, w.z});
    out.radius = s.radius;
    if (out.radius.empty()) out.radius.assign(s.id.size(), static_cast<float>(grains->model().radius));
    return out;
  });
}

std::size_t Simulation::ownGrainCount() const {
  const auto& grains = run_->now().ground().grains;
  if (!grains || run_->comm().alone()) return grainCount();
  return detail::translated([&] { return grains->snapshot().id.size(); });
}

void Simulation::readPositions(std::span<Vec3> positions) const {
  const auto& grains = run_->now().ground().grains;
  if (positions.size() != ownGrainCount())
    throw InputError(fmt::format("readPositions(): the buffer has {} elements, but there are {} grains",
                                 positions.size(), ownGrainCount()));
  if (!grains || positions.empty()) return;
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  detail::translated([&] {
    if (run_->comm().alone()) return terrain::GrainCheckpoint::readPositions(grains->system(), &positions.front().x);
    const terrain::GrainSnapshot s = grains->snapshot();
    std::transform(s.position.begin(), s.position.end(), positions.begin(), outside);
  });
}

std::vector<Body> Simulation::bodies() const {
  const coupling::Simulation& s = run_->now();
  const multibody::Model* model = s.vehicle() ? &s.vehicle()->assembly().model : nullptr;
  const multibody::State* state = s.vehicle() ? &s.vehicle()->state() : nullptr;
  if (s.mechanism()) model = &s.mechanism()->model(), state = &s.mechanism()->state();
  std::vector<Body> bodies;
  for (std::size_t b = 0; model && b < model->bodies().size(); ++b) {
    const multibody::Body& body = model->bodies()[b];
    const base::Quat& q = state->pose[b].orientation;
    bodies.push_back({body.name,
                      body.mass,
                      outside(state->pose[b].position),
                      {q.w, q.x, q.y, q.z},
                      outside(state->twist[b].v),
                      outside(state->twist[b].w)});
  }
  return bodies;
}

Energies Simulation::energies() const {
  run_->act();
  const coupling::Ledger l = detail::translated([&] { return run_->now().ledger(); });
  return {l.kinetic, l.potential, l.elastic, l.dissipated.total(), l.driveWork, l.integrationError, l.residual};
}

void Simulation::setGravity(const Vec3& g) {
  run_->set({{0, coupling::InputKind::gravity, 0, false, {g.x, g.y, g.z}}});
}
void Simulation::releaseGravity() { run_->release({coupling::InputKind::gravity}); }

void Simulation::setLoad(std::string_view body, const Vec3& f, const Vec3& t) {
  const auto index = detail::translated([&] { return coupling::bodyIndex(run_->now(), std::string(body)); });
  run_->set({{0, coupling::InputKind::bodyLoad, index, false, {f.x, f.y, f.z, t.x, t.y, t.z}}});
}

void Simulation::releaseLoad(std::string_view body) {
  const auto index = detail::translated([&] { return coupling::bodyIndex(run_->now(), std::string(body)); });
  run_->release({coupling::InputKind::bodyLoad}, index);
}

std::vector<std::string> warningsOf(const Simulation& simulation) {
  const detail::Run& run = *simulation.run_;
  std::vector<std::string> texts;
  for (const setup::Notice& notice : detail::translated([&] { return setup::noticesOf(run.scene, run.now()); }))
    texts.push_back(notice.text);
  if (run.exec.threads > 1 && !std::getenv("GOMP_SPINCOUNT") && !std::getenv("OMP_WAIT_POLICY"))
    texts.emplace_back("idle threads spin; steps become many times slower if other programs use the cores: set "
                       "GOMP_SPINCOUNT=5000 in the environment before this program starts, or use one thread");
  return texts;
}

void Simulation::save(const std::filesystem::path& checkpoint) const {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::absolute(checkpoint, error).parent_path();
  if (!std::filesystem::is_directory(folder, error) || std::filesystem::is_directory(checkpoint, error))
    throw InputError(fmt::format("save(\"{}\"): {}", checkpoint.string(),
                                 std::filesystem::is_directory(checkpoint, error)
                                     ? "this is a folder; specify a file name"
                                     : "the folder does not exist; create it first"));
  if (!run_->failed.empty())
    throw InputError("save(): the simulation has failed and its state is invalid. The cause: " + run_->failed);
  run_->act();
  detail::translated([&] {
    storage::writeCheckpoint(checkpoint, session::checkpointOf(run_->now(), run_->record.provenance), run_->comm());
  });
}

void Simulation::restore(const std::filesystem::path& checkpoint) {
  detail::Run& run = *run_;
  if (run.session)
    throw InputError("restore(): not supported with an output folder (rows would be duplicated); create the simulation "
                     "without a folder, or use Simulation::resumed() with another folder");
  const session::RunRequest before = run.request;
  run.request.resume = checkpoint, run.request.branch = true;
  try {
    detail::translated([&] { run.goOn(); });
  } catch (...) {
    run.request = before;
    throw;
  }
  run.simulation->restartMeans(coupling::Means::watch);
  run.finished = false, run.failed.clear();
}

std::string Simulation::hash() const {
  run_->act();
  return detail::translated([&] { return run_->now().stateHash(); });
}

void Simulation::finish() { run_->finish(); }

} // namespace grouser
