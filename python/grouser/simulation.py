# SPDX-License-Identifier: BSD-3-Clause
"""In-process simulation that Python code steps, reads and controls."""
from __future__ import annotations

import importlib.util
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np

from . import errors
from .errors import briefly
from .scene import Scene

Three = Sequence[float]


def _core() -> ModuleType:
    """The extension module: installed next to this file, else in the checkout's build folder."""
    # GNU OpenMP reads GOMP_SPINCOUNT when it is loaded: idle threads then spin only briefly and free their cores.
    if "OMP_WAIT_POLICY" not in os.environ:
        os.environ.setdefault("GOMP_SPINCOUNT", "5000")
    try:
        from . import _core  # type: ignore[attr-defined]
        return _core
    except ImportError:
        pass
    built = os.environ.get("GROUSER_PYTHON_MODULE")
    folder = Path(built) if built else Path(__file__).resolve().parents[2] / "build/python/grouser"
    for file in sorted(folder.glob("_core*.so")):
        spec = importlib.util.spec_from_file_location("grouser._core", file)
        if spec and spec.loader:
            module = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(module)
            return module
    raise ImportError(f"grouser's extension module is neither installed nor in {folder}; install python3-dev and "
                      "pybind11-dev, then run: cmake --build build")


def _number(name: str, value: Any) -> float:
    if isinstance(value, (int, float, np.number)):
        return float(value)
    raise TypeError(f"{name}: expected a number, not {value!r}")


def _whole(name: str, value: Any) -> int:
    if not isinstance(value, (int, np.integer)) or isinstance(value, bool):
        raise TypeError(f"{name}: expected an integer, not {value!r}")
    if abs(int(value)) >= 2**62:
        raise errors.InputError(f"{name} = {value} is out of range", 2, [], "")
    return int(value)


def _pair(left: Any, right: Any) -> tuple[float, float]:
    left = _number("left", left)
    return left, left if right is None else _number("right", right)


def _three(name: str, value: Any) -> list[float]:
    if isinstance(value, str) or not hasattr(value, "__len__") or len(value) != 3:
        raise TypeError(f"{name}: expected three numbers (x, y, z), not {value!r}")
    return [_number(name, v) for v in value]


class Simulation:
    """Runs a scene in this process. The constructor settles the bed and places the vehicle; then call `step()`.

        with grouser.Simulation("runs/scenes/rigid_control.toml") as sim:
            while sim.time < 2:
                sim.set_sprocket_speed(2.0 + 4 * (0.5 - sim.vehicle.speed))
                sim.step(100)

    scene: a Scene or a scene file. folder: output folder, as of `grouser run`; None: no output. device: "auto", "cpu"
    or "cuda"; None: as in the scene. threads: number of CPU threads, 0: all available cores, at most
    OMP_NUM_THREADS; None: as in the scene. overwrite: replace existing results in `folder`. cache: reuse settled beds
    and mesh spheres from earlier runs. settling: callback(time [s], kinetic energy ratio), called while the bed
    settles. checkpoint: file from which the simulation continues; the scene must be the same, but a branch (another
    folder, or none) may change the drive and the hitch.

    An input takes effect at the next step and remains in effect until it is set again or released. Inputs are stored
    with their steps in checkpoints and results; therefore `grouser run --replay FOLDER` reproduces the run without the
    script, with the same state hash, on a CPU or a GPU. Setters raise InputError if the scene does not support the
    input.

    `warnings` lists warnings and notes on the scene. The scene's run.duration does not end the simulation. Sprocket and
    engine inputs take effect when the drive starts (`vehicle.drive_start`), after the vehicle has come to rest.

    Several simulations can exist at the same time; only one thread at a time may use each of them. Start processes with
    multiprocessing's "spawn" method: a forked process cannot run the threads of a simulation. `step()` releases the
    GIL; Ctrl-C interrupts it between two steps. When the interpreter exits, it ends steps in daemon threads between two
    steps, and these threads with SystemExit. Methods raise InputError, SimulationError and DeviceError.
    """

    __slots__ = ("__weakref__", "_run", "_seen", "warnings")

    @briefly
    def __init__(self, scene: Scene | str | os.PathLike, folder: str | os.PathLike | None = None, *,
                 device: str | None = None, threads: int | None = None, overwrite: bool = False, cache: bool = True,
                 settling: Callable[[float, float], Any] | None = None, checkpoint: str | os.PathLike | None = None):
        if settling is not None and not callable(settling):
            raise TypeError(f"settling: expected a function of time and energy ratio, not {settling!r}")
        if not isinstance(scene, Scene):
            scene = Scene.read(scene)
        place = scene.folder / f"{scene.name}.toml"
        self._run = _core().Simulation(scene.text(), place, device or "",
                                       None if threads is None else _whole("threads", threads),
                                       str(folder) if folder else "", overwrite, cache, settling,
                                       Path(checkpoint) if checkpoint else None)
        self._seen: tuple[int, Any] = (-1, None)
        self.warnings: list[str] = self._run.warnings()

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, kind: Any, value: Any, trace: Any) -> None:
        """Calls finish() unless the block raised an exception, then close()."""
        if kind is None and self._run.open:
            self.finish()
        self.close()

    def __reduce__(self) -> Any:
        raise TypeError("a simulation cannot be pickled; save() a checkpoint and create another simulation from it")

    def __repr__(self) -> str:
        if not self._run.open:
            return "<grouser.Simulation, closed>"
        if self._run.busy:
            return "<grouser.Simulation, used by another thread>"
        return f"<grouser.Simulation at {self.time:.6g} s, {self.grain_count} grains, {self.device}>"

    # Steps.
    @briefly
    def step(self, count: int = 1) -> None:
        """Advances by `count` steps, or by fewer if the scene's [stop] ends the run (see `ended`). InputError if the
        run has already ended."""
        self._seen = (-1, None)
        self._run.step(_whole("count", count))

    def step_for(self, seconds: float) -> None:
        """Advances by `seconds` > 0, rounded to a whole number of steps, at least one."""
        if not 0 < seconds <= 1e9:
            raise errors.InputError(f"step_for({seconds}): the time must be in (0, 1e9] s", 2, [], "")
        self.step(max(1, round(seconds / self.time_step)))

    @property
    def time(self) -> float:
        """Simulation time [s], from the end of settling."""
        return self._run.time

    @property
    def time_step(self) -> float:
        """Length of a step [s]."""
        return self._run.time_step

    @property
    def steps(self) -> int:
        return self._run.steps

    @property
    def ended(self) -> str:
        """Reason why [stop] ended the run; empty while it continues."""
        return self._run.ended

    @property
    def device(self) -> str:
        return self._run.device

    # Observations. All arrays are read-only.
    @property
    def grain_count(self) -> int:
        return self._run.grain_count

    @property
    def positions(self) -> np.ndarray:
        """Grain positions sorted by id [m], [grains, 3] float64, read-only. An array keeps its values as long as you
        keep a reference to it; otherwise its buffer is reused after the next step. To modify values, copy the array."""
        return self._run.positions()

    def grains(self) -> SimpleNamespace:
        """State of the grains, sorted by id: position [m] (see `positions`), copies of velocity [m/s] and spin [rad/s]
        ([grains, 3] float32), radius [m], id."""
        return SimpleNamespace(position=self.positions, **self._run.grains())

    @property
    @briefly
    def vehicle(self) -> SimpleNamespace:
        """Copy of the current state of the vehicle: time [s], position (middle of the sprocket axle line) [m], centre
        (of mass of the hull) [m] and its velocity [m/s], speed [m/s], heading (from x to y, continuous over turns),
        pitch (nose up), roll (right side down) [rad], turn_rate (to the left) [rad/s], ground_force, drawbar_pull [N],
        drive_start [s] (None until known), and `left` and `right`, each with sprocket_speed [rad/s], drive_torque
        [N m], drive_power [W], speed [m/s], slip [-] (NaN while the sprocket is stopped) and, per shoe: tension
        (pull along the chain in the pin ahead), normal_force, shear_force [N], sinkage [m]. Torques, powers and forces
        (except tension) are means over the last step() call; before the first call and after restore() they are
        unknown (zero or NaN).
        """
        if self._seen[0] != self.steps:
            self._seen = (self.steps, self._run.vehicle())
        state = dict(self._seen[1])  # a copy: changes by the caller remain in it
        for side in ("left", "right"):
            state[side] = SimpleNamespace(**state[side]) if state[side] else None
        return SimpleNamespace(**state)

    @property
    @briefly
    def vehicle_mass(self) -> float:
        """Mass of the vehicle [kg]."""
        return self._run.vehicle_constants()[0]

    @property
    @briefly
    def pitch_radius(self) -> float:
        """Pitch radius of the sprockets [m]: track speed = sprocket speed x pitch radius."""
        return self._run.vehicle_constants()[1]

    def bodies(self) -> dict[str, SimpleNamespace]:
        """Copies of the bodies of a vehicle or mechanism, by name: mass [kg], position [m], orientation (w, x, y, z,
        body to world), velocity [m/s], spin [rad/s]."""
        return {body["name"]: SimpleNamespace(**body) for body in self._run.bodies()}

    def energies(self) -> SimpleNamespace:
        """Energy ledger since the first step [J]: kinetic, potential, elastic, dissipated, work, integration_error,
        residual."""
        return SimpleNamespace(**self._run.energies())

    # Control inputs.
    @briefly
    def set_sprocket_speed(self, left: float, right: float | None = None) -> None:
        """Sets sprocket speeds [rad/s], forward positive; right defaults to left. With driver.drive = "engine", the
        values are governor speeds."""
        self._run.set_sprocket_speed(*_pair(left, right))

    @briefly
    def set_sprocket_torque(self, left: float, right: float | None = None) -> None:
        """Sets sprocket torques [N m], forward positive; requires driver.drive = "torque"."""
        self._run.set_sprocket_torque(*_pair(left, right))

    @briefly
    def set_throttle(self, left: float, right: float | None = None) -> None:
        """Sets throttles in [-1, 1]: a fraction of the full-load torque, or of the brake torque if it opposes the
        rotation. Requires driver.drive = "engine". Throttle and governor speed are mutually exclusive: the last one set
        takes effect."""
        self._run.set_throttle(*_pair(left, right))

    def release_sprockets(self) -> None:
        """Returns control of the sprockets to the scene's driver."""
        self._run.release_sprockets()

    @briefly
    def set_hitch_force(self, force: float) -> None:
        """Sets the hitch force that resists the vehicle [N]; requires [hitch] kind = "force"."""
        self._run.set_hitch_force(_number("force", force))

    @briefly
    def set_hitch_speed(self, speed: float) -> None:
        """Sets the speed of the towing carriage [m/s]; requires [hitch] kind = "speed"."""
        self._run.set_hitch_speed(_number("speed", speed))

    def release_hitch(self) -> None:
        self._run.release_hitch()

    @briefly
    def set_gravity(self, gravity: Three) -> None:
        """Sets the gravity vector [m/s2]."""
        self._run.set_gravity(_three("gravity", gravity))

    def release_gravity(self) -> None:
        self._run.release_gravity()

    @briefly
    def set_load(self, body: str, force: Three, torque: Three = (0, 0, 0)) -> None:
        """Applies a force [N] and a torque about the centre of mass [N m] to a body, in world axes."""
        self._run.set_load(body, _three("force", force), _three("torque", torque))

    @briefly
    def release_load(self, body: str) -> None:
        self._run.release_load(body)

    # Checkpoints.
    @briefly
    def save(self, file: str | os.PathLike) -> None:
        """Writes a checkpoint for `checkpoint=`, `restore()` and `grouser run --resume`."""
        self._run.save(Path(file))

    @briefly
    def restore(self, file: str | os.PathLike) -> None:
        """Restores the state from a checkpoint of the same scene. Not supported with an output folder."""
        self._run.restore(Path(file))
        self._seen = (-1, None)

    def hash(self) -> str:
        """Hash of the state; equal states have equal hashes."""
        return self._run.hash()

    @briefly
    def finish(self) -> None:
        """Ends the run; writes the last row, checkpoint, plots and summary (manifest.json) to the output folder."""
        self._run.finish()

    def close(self) -> None:
        """Closes the simulation and frees its memory."""
        if self._run.open:
            self._run.close()


def library_version() -> str:
    """Version and commit of the extension module."""
    core = _core()
    return f"{core.version} {core.commit}"


__all__ = ["Simulation", "library_version", "errors"]
