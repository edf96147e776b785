// SPDX-License-Identifier: BSD-3-Clause
// In-process simulation for Python: grouser._core, based on the public C++ interface only. The user interface is
// python/grouser/simulation.py.
#include <grouser/grouser.hpp>

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <thread>
#include <unistd.h>
#include <utility>

namespace py = pybind11;

namespace {

using grouser::Vec3;

static_assert(sizeof(Vec3) == 3 * sizeof(double), "an array of positions is an array of doubles");

/// Sets the Python exception `name` of grouser.errors for an error of the library.
void raise(const char* name, int code, const char* message) {
  const py::object kind = py::module_::import("grouser.errors").attr(name);
  PyErr_SetObject(kind.ptr(), kind(message, code, py::list(), "").ptr());
}

template <class T> py::array frozen(py::array_t<T> array) {
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// A read-only copy.
template <class T> py::array copied(const std::vector<T>& values, py::ssize_t columns = 0) {
  const auto n = static_cast<py::ssize_t>(values.size());
  py::array_t<T> array = columns > 0 ? py::array_t<T>({n / columns, columns}) : py::array_t<T>(n);
  if (n > 0) std::memcpy(array.mutable_data(), values.data(), values.size() * sizeof(T));
  return frozen(std::move(array));
}

py::array vector(const Vec3& v) { return copied(std::vector<double>{v.x, v.y, v.z}); }

Vec3 threeOf(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

/// The interpreter exits, and ends daemon threads. Becomes SystemExit, which ends a thread without a message.
struct Exiting : std::exception {
  const char* what() const noexcept override { return "the interpreter exits"; }
};

/// Threads inside the library, which run without the GIL. When the interpreter exits, it ends each other thread that
/// requests the GIL, by an exception that C++ code must not stop: the process would abort. Therefore wait(), an exit
/// function of Python, lets these threads leave the library first. Afterwards only the exiting thread may enter it.
class ExitGuard {
public:
  /// Held by a thread inside the library; constructed and destroyed with the GIL.
  class Inside {
  public:
    explicit Inside(ExitGuard& guard) : guard_(guard) { guard_.requireEntry(), ++guard_.inside_; }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;
    ~Inside() { --guard_.inside_; }

  private:
    ExitGuard& guard_;
  };

  /// Whether this thread must leave the library; with or without the GIL.
  bool mustLeave() const { return exits_ && std::this_thread::get_id() != exiting_; }
  void requireEntry() const {
    if (mustLeave()) throw Exiting();
  }

  /// Waits until the other threads have left the library. Ctrl-C ends the process at once.
  void wait() {
    if (getpid() != process_) return; // a forked process has no copy of these threads
    exiting_ = std::this_thread::get_id(), exits_ = true;
    const auto start = std::chrono::steady_clock::now();
    for (bool isNoted = false; inside_ > 0;) {
      {
        py::gil_scoped_release release;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      if (PyErr_CheckSignals() != 0) std::signal(SIGINT, SIG_DFL), std::raise(SIGINT);
      if (isNoted || std::chrono::steady_clock::now() - start < std::chrono::seconds(5)) continue;
      isNoted = true;
      PySys_WriteStderr("grouser: waiting for a simulation in another thread; Ctrl-C ends the process\n");
    }
  }

private:
  const pid_t process_ = getpid();
  std::atomic<bool> exits_{false};
  std::thread::id exiting_;
  std::atomic<int> inside_{0};
};

ExitGuard& exitGuard() {
  static ExitGuard guard;
  return guard;
}

/// A simulation used by one thread at a time.
class Simulation {
public:
  Simulation(const std::string& scene, const std::filesystem::path& place, grouser::Options options,
             const std::optional<std::filesystem::path>& checkpoint) {
    const grouser::Scene of = grouser::Scene::fromText(scene, place.parent_path(), place.filename().string());
    const ExitGuard::Inside inside(exitGuard());
    py::gil_scoped_release release;
    run_.emplace(checkpoint ? grouser::Simulation::resumed(of, *checkpoint, options)
                            : grouser::Simulation(of, options));
  }

  void step(std::int64_t count) {
    bool interrupted = false;
    filledAt_ = -1;
    free([&](grouser::Simulation& run) {
      run.step(count, [&] {
        if (exitGuard().mustLeave()) return false;
        py::gil_scoped_acquire acquire;
        interrupted = PyErr_CheckSignals() != 0;
        return !interrupted;
      });
    });
    if (interrupted) throw py::error_already_set();
    exitGuard().requireEntry();
  }

  /// A view of a buffer that is refilled after a step, or replaced if Python still references the old view.
  py::array positions() {
    grouser::Simulation& run = used();
    if (positions_ && filledAt_ == run.steps()) return *positions_;
    const auto n = static_cast<py::ssize_t>(run.ownGrainCount());
    if (!positions_ || positions_->ref_count() > 1 || positions_->shape(0) != n)
      positions_ = py::array_t<double>({n, py::ssize_t{3}});
    auto* first = reinterpret_cast<Vec3*>(const_cast<double*>(positions_->data()));
    free([&](grouser::Simulation& r) { r.readPositions({first, static_cast<std::size_t>(n)}); });
    frozen(*positions_);
    filledAt_ = run.steps();
    return *positions_;
  }

  grouser::Grains grains() {
    grouser::Grains grains;
    free([&](grouser::Simulation& run) { grains = run.grains(); });
    return grains;
  }

  void restore(const std::filesystem::path& file) {
    filledAt_ = -1;
    free([&](grouser::Simulation& run) { run.restore(file); });
  }

  std::string hash() {
    std::string hash;
    free([&](grouser::Simulation& run) { hash = run.hash(); });
    return hash;
  }

  template <class Call> void free(const Call& call) {
    grouser::Simulation& run = used();
    const ExitGuard::Inside inside(exitGuard());
    const Busy busy(busy_);
    py::gil_scoped_release release;
    call(run);
  }

  grouser::Simulation& used() {
    if (!run_) throw grouser::InputError("the simulation is closed");
    if (busy_) throw grouser::InputError("another thread is using this simulation; use it from one thread at a time");
    return *run_;
  }
  void close() { used(), run_.reset(), positions_.reset(); }
  bool isOpen() const { return run_.has_value(); }
  bool isBusy() const { return busy_; }

private:
  struct Busy {
    explicit Busy(std::atomic<bool>& flag) : flag_(flag) { flag_ = true; }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;
    ~Busy() { flag_ = false; }
    std::atomic<bool>& flag_;
  };

  std::optional<grouser::Simulation> run_;
  std::atomic<bool> busy_{false};
  std::optional<py::array_t<double>> positions_;
  std::int64_t filledAt_ = -1;
};

py::dict trackOf(const grouser::Track& t) {
  using namespace py::literals;
  return py::dict("sprocket_speed"_a = t.sprocketSpeed, "drive_torque"_a = t.driveTorque,
                  "drive_power"_a = t.drivePower, "speed"_a = t.speed, "slip"_a = t.slip,
                  "tension"_a = copied(t.tension), "sinkage"_a = copied(t.sinkage),
                  "normal_force"_a = copied(t.normalForce), "shear_force"_a = copied(t.shearForce));
}

py::dict vehicleOf(Simulation& simulation) {
  using namespace py::literals;
  const grouser::VehicleState s = simulation.used().vehicle().state();
  py::dict all("time"_a = s.time, "position"_a = vector(s.position), "centre"_a = vector(s.centre),
               "velocity"_a = vector(s.velocity), "speed"_a = s.speed, "heading"_a = s.heading, "pitch"_a = s.pitch,
               "roll"_a = s.roll, "turn_rate"_a = s.turnRate, "ground_force"_a = vector(s.groundForce),
               "drawbar_pull"_a = s.drawbarPull, "drive_start"_a = s.driveStart, "left"_a = trackOf(s.left));
  all["right"] = s.right.tension.empty() ? py::object(py::none()) : py::object(trackOf(s.right));
  return all;
}

py::list bodiesOf(Simulation& simulation) {
  using namespace py::literals;
  py::list all;
  for (const grouser::Body& b : simulation.used().bodies())
    all.append(py::dict("name"_a = b.name, "mass"_a = b.mass, "position"_a = vector(b.position),
                        "orientation"_a = copied(
                            std::vector<double>{b.orientation.w, b.orientation.x, b.orientation.y, b.orientation.z}),
                        "velocity"_a = vector(b.velocity), "spin"_a = vector(b.spin)));
  return all;
}

py::dict energiesOf(Simulation& simulation) {
  using namespace py::literals;
  const grouser::Energies e = simulation.used().energies();
  return py::dict("kinetic"_a = e.kinetic, "potential"_a = e.potential, "elastic"_a = e.elastic,
                  "dissipated"_a = e.dissipated, "work"_a = e.work, "integration_error"_a = e.integrationError,
                  "residual"_a = e.residual);
}

py::dict grainsOf(Simulation& simulation) {
  using namespace py::literals;
  const grouser::Grains g = simulation.grains();
  return py::dict("velocity"_a = copied(g.velocity, 3), "spin"_a = copied(g.spin, 3), "radius"_a = copied(g.radius),
                  "id"_a = copied(g.id));
}

} // namespace

PYBIND11_MODULE(_core, m) {
  m.attr("version") = grouser::version();
  m.attr("commit") = grouser::commit();
  exitGuard();
  py::module_::import("atexit").attr("register")(py::cpp_function([] { exitGuard().wait(); }));
  py::register_exception_translator([](std::exception_ptr thrown) { // NOLINT(performance-unnecessary-value-param)
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Exiting&) {
      PyErr_SetNone(PyExc_SystemExit);
    } catch (const grouser::InputError& error) {
      raise("InputError", 2, error.what());
    } catch (const grouser::SimulationError& error) {
      raise("SimulationError", 3, error.what());
    } catch (const grouser::DeviceError& error) {
      raise("DeviceError", 4, error.what());
    }
  });
  py::class_<Simulation>(m, "Simulation")
      .def(py::init([](const std::string& scene, const std::filesystem::path& place, const std::string& device,
                       std::optional<int> threads, const std::filesystem::path& folder, bool overwrite, bool cache,
                       const std::function<void(double, double)>& settling,
                       const std::optional<std::filesystem::path>& checkpoint) {
        grouser::Options o;
        o.device = device, o.threads = threads, o.folder = folder, o.overwrite = overwrite, o.cache = cache;
        o.settling = [settling](double time, double energy) {
          exitGuard().requireEntry();
          py::gil_scoped_acquire acquire;
          if (PyErr_CheckSignals() != 0) throw py::error_already_set();
          if (settling) settling(time, energy);
        };
        return std::make_unique<Simulation>(scene, place, o, checkpoint);
      }))
      .def("step", &Simulation::step)
      .def("finish", [](Simulation& s) { s.free([](grouser::Simulation& run) { run.finish(); }); })
      .def("close", &Simulation::close)
      .def_property_readonly("open", &Simulation::isOpen)
      .def_property_readonly("ended", [](Simulation& s) { return s.used().ended(); })
      .def_property_readonly("time", [](Simulation& s) { return s.used().time(); })
      .def_property_readonly("time_step", [](Simulation& s) { return s.used().timeStep(); })
      .def_property_readonly("steps", [](Simulation& s) { return s.used().steps(); })
      .def_property_readonly("busy", &Simulation::isBusy)
      .def("warnings", [](Simulation& s) { return grouser::warningsOf(s.used()); })
      .def_property_readonly("device", [](Simulation& s) { return s.used().device(); })
      .def_property_readonly("has_vehicle", [](Simulation& s) { return s.used().hasVehicle(); })
      .def_property_readonly("grain_count", [](Simulation& s) { return s.used().grainCount(); })
      .def("positions", &Simulation::positions)
      .def("grains", &grainsOf)
      .def("bodies", &bodiesOf)
      .def("vehicle", &vehicleOf)
      .def("vehicle_constants",
           [](Simulation& s) {
             const grouser::Vehicle v = s.used().vehicle();
             return py::make_tuple(v.mass(), v.pitchRadius(), v.shoes());
           })
      .def("energies", &energiesOf)
      .def("hash", &Simulation::hash)
      .def("save", [](Simulation& s,
                      const std::filesystem::path& file) { s.free([&](grouser::Simulation& run) { run.save(file); }); })
      .def("restore", &Simulation::restore)
      .def("set_sprocket_speed", [](Simulation& s, double l, double r) { s.used().vehicle().setSprocketSpeed(l, r); })
      .def("set_sprocket_torque", [](Simulation& s, double l, double r) { s.used().vehicle().setSprocketTorque(l, r); })
      .def("set_throttle", [](Simulation& s, double l, double r) { s.used().vehicle().setThrottle(l, r); })
      .def("release_sprockets", [](Simulation& s) { s.used().vehicle().releaseSprockets(); })
      .def("set_hitch_force", [](Simulation& s, double force) { s.used().vehicle().setHitchForce(force); })
      .def("set_hitch_speed", [](Simulation& s, double speed) { s.used().vehicle().setHitchSpeed(speed); })
      .def("release_hitch", [](Simulation& s) { s.used().vehicle().releaseHitch(); })
      .def("set_gravity", [](Simulation& s, const std::array<double, 3>& g) { s.used().setGravity(threeOf(g)); })
      .def("release_gravity", [](Simulation& s) { s.used().releaseGravity(); })
      .def("set_load", [](Simulation& s, const std::string& body, const std::array<double, 3>& f,
                          const std::array<double, 3>& t) { s.used().setLoad(body, threeOf(f), threeOf(t)); })
      .def("release_load", [](Simulation& s, const std::string& body) { s.used().releaseLoad(body); });
}
