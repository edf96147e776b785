# SPDX-License-Identifier: BSD-3-Clause
"""A simulation in this process: stepped, read and steered from Python."""
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
    """The compiled part: beside this file where installed, else that of the checkout's build folder."""
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
    raise ImportError(f"the compiled part of grouser is neither installed nor in {folder}: build it (cmake --build build), "
                      "which takes the packages python3-dev and pybind11-dev")


class Simulation:
    """A scene that runs in this process. Built settled, the vehicle set down; then `step()`.

        with grouser.Simulation("runs/scenes/rigid_control.toml") as sim:
            while sim.time < 2:
                sim.set_sprocket_speed(2.0 + 4 * (0.5 - sim.vehicle.speed))
                sim.step(100)

    scene: a Scene, or a scene file. folder: of results as `grouser run` leaves them; None: nothing is written. device:
    "auto", "cpu" or "cuda"; threads: of the CPU, 0 for all; None: as the scene says. overwrite: a folder that holds
    results. cache: take settled beds and cut meshes from earlier runs. settling: called with time [s] and kinetic energy
    ratio while a bed settles. checkpoint: file of the same scene to go on from; [driver] and [hitch] may differ unless
    `folder` is that of the checkpoint.

    What is set acts from the next step on until it is set again or released. It is part of the answer: kept with its
    step in checkpoints and results, so that `grouser run --replay FOLDER` repeats the run without this program, to the
    same state hash, on a CPU or a GPU. Setters raise InputError where the scene has nothing of the kind.

    Several may be alive at a time, each used by one thread at a time; `step()` releases the interpreter's lock, and
    Ctrl-C ends it after a step. Errors are those of the package: InputError, SimulationError, DeviceError.
    """

    @briefly
    def __init__(self, scene: Scene | str | os.PathLike, folder: str | os.PathLike | None = None, *,
                 device: str | None = None, threads: int | None = None, overwrite: bool = False, cache: bool = True,
                 settling: Callable[[float, float], Any] | None = None, checkpoint: str | os.PathLike | None = None):
        if not isinstance(scene, Scene):
            scene = Scene.read(scene)
        place = scene.folder / f"{scene.name}.toml"
        self._run = _core().Simulation(scene.text(), place, device or "", -1 if threads is None else threads,
                                       str(folder) if folder else "", overwrite, cache, settling,
                                       Path(checkpoint) if checkpoint else None)
        self._seen: tuple[int, Any] = (-1, None)

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, kind: Any, value: Any, trace: Any) -> None:
        """Finishes the run, unless an exception ends it; then frees its memory."""
        if kind is None and self._run.open:
            self.finish()
        self.close()

    def __reduce__(self) -> Any:
        raise TypeError("a simulation cannot be pickled; save() a checkpoint and make another from it")

    def __repr__(self) -> str:
        if not self._run.open:
            return "<grouser.Simulation, closed>"
        return f"<grouser.Simulation at {self.time:.6g} s, {self.grain_count} grains, {self.device}>"

    # Steps.
    @briefly
    def step(self, count: int = 1) -> None:
        """Takes `count` steps, or fewer where the scene's [stop] ends the run: see `ended`; InputError behind that."""
        self._seen = (-1, None)
        self._run.step(count)

    def step_for(self, seconds: float) -> None:
        """The number of steps that is nearest to this time > 0, at least one."""
        if not 0 < seconds <= 1e9:
            raise errors.InputError(f"step_for({seconds}): is outside (0, 1e9] s", 2, [], "")
        self.step(max(1, round(seconds / self.time_step)))

    @property
    def time(self) -> float:
        """Since the bed has settled [s]."""
        return self._run.time

    @property
    def time_step(self) -> float:
        """[s]"""
        return self._run.time_step

    @property
    def steps(self) -> int:
        return self._run.steps

    @property
    def ended(self) -> str:
        """Why the scene's [stop] has ended the run; empty while it goes on."""
        return self._run.ended

    @property
    def device(self) -> str:
        return self._run.device

    # What is seen. All arrays are read-only.
    @property
    def grain_count(self) -> int:
        return self._run.grain_count

    @property
    def positions(self) -> np.ndarray:
        """Of the grains, by id [m], [grains, 3] float64. A view of memory that the next step's positions use again,
        unless the array is still held then: it keeps the values of its step. Copy to change them."""
        return self._run.positions()

    def grains(self) -> SimpleNamespace:
        """Copies by id: velocity [m/s], spin [rad/s] ([grains, 3] float32), radius [m], id."""
        return SimpleNamespace(position=self.positions, **self._run.grains())

    @property
    @briefly
    def vehicle(self) -> SimpleNamespace:
        """The vehicle now, as copies: time, position [m] and velocity of the middle of the sprockets' axle line, speed
        [m/s], heading, pitch, roll [rad], turn_rate [rad/s], ground_force, drawbar_pull [N], drive_start [s] (None
        while it is lowered), and `left` and `right`, each with sprocket_speed [rad/s], drive_torque [N m],
        drive_power [W], speed [m/s], slip [-] and, shoe by shoe, tension, normal_force, shear_force [N], sinkage [m].
        Forces, torques and powers are means over the last step().
        """
        if self._seen[0] != self.steps:
            state = self._run.vehicle()
            for side in ("left", "right"):
                state[side] = SimpleNamespace(**state[side]) if state[side] else None
            self._seen = (self.steps, SimpleNamespace(**state))
        return self._seen[1]

    @property
    @briefly
    def vehicle_mass(self) -> float:
        """[kg]"""
        return self._run.vehicle_constants()[0]

    @property
    @briefly
    def pitch_radius(self) -> float:
        """Of the sprockets [m]: speed of the track = sprocket speed x pitch radius."""
        return self._run.vehicle_constants()[1]

    def bodies(self) -> dict[str, SimpleNamespace]:
        """Copies by name, of the vehicle or mechanism: mass [kg], position [m], orientation (w, x, y, z, body to world),
        velocity [m/s], spin [rad/s]."""
        return {body["name"]: SimpleNamespace(**body) for body in self._run.bodies()}

    def energies(self) -> SimpleNamespace:
        """Since the first step [J]: kinetic, potential, elastic, dissipated, work, integration_error, residual."""
        return SimpleNamespace(**self._run.energies())

    # What is set.
    @briefly
    def set_sprocket_speed(self, left: float, right: float | None = None) -> None:
        """[rad/s], forward positive; right: as left. With driver.drive = "engine" the governors' set points."""
        self._run.set_sprocket_speed(left, left if right is None else right)

    @briefly
    def set_sprocket_torque(self, left: float, right: float | None = None) -> None:
        """[N m], forward positive; driver.drive = "torque"."""
        self._run.set_sprocket_torque(left, left if right is None else right)

    @briefly
    def set_throttle(self, left: float, right: float | None = None) -> None:
        """-1 to 1, of the engines' full load or of their brakes; driver.drive = "engine"."""
        self._run.set_throttle(left, left if right is None else right)

    def release_sprockets(self) -> None:
        """Back to the scene's driver."""
        self._run.release_sprockets()

    @briefly
    def set_hitch_force(self, force: float) -> None:
        """That holds the vehicle back [N]; [hitch] kind = "force"."""
        self._run.set_hitch_force(force)

    @briefly
    def set_hitch_speed(self, speed: float) -> None:
        """Of the carriage that holds it [m/s]; [hitch] kind = "speed"."""
        self._run.set_hitch_speed(speed)

    def release_hitch(self) -> None:
        self._run.release_hitch()

    @briefly
    def set_gravity(self, gravity: Three) -> None:
        """[m/s2]"""
        self._run.set_gravity([float(g) for g in gravity])

    def release_gravity(self) -> None:
        self._run.release_gravity()

    @briefly
    def set_load(self, body: str, force: Three, torque: Three = (0, 0, 0)) -> None:
        """Force [N] and torque about the centre of mass [N m] on a body, in world axes."""
        self._run.set_load(body, [float(f) for f in force], [float(t) for t in torque])

    @briefly
    def release_load(self, body: str) -> None:
        self._run.release_load(body)

    # The state as a whole.
    @briefly
    def save(self, file: str | os.PathLike) -> None:
        """A checkpoint, for `checkpoint=`, `restore()` and `grouser run --resume`."""
        self._run.save(Path(file))

    @briefly
    def restore(self, file: str | os.PathLike) -> None:
        """Goes back, or on, to a checkpoint of the same scene; not while a folder is written."""
        self._run.restore(Path(file))
        self._seen = (-1, None)

    def hash(self) -> str:
        """Of the state: equal bits, equal hash."""
        return self._run.hash()

    @briefly
    def finish(self) -> None:
        """Ends the run: last row, checkpoint, plots and summary of its folder."""
        self._run.finish()

    def close(self) -> None:
        """Frees its memory."""
        if self._run.open:
            self._run.close()


def library_version() -> str:
    """Version and commit of the compiled part."""
    core = _core()
    return f"{core.version} {core.commit}"


__all__ = ["Simulation", "library_version", "errors"]
