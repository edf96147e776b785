# SPDX-License-Identifier: BSD-3-Clause
"""grouser from Python: step and steer simulations; build, change and start scenes; read runs, sweeps, checks, events,
soils and settled beds.

    import grouser
    scene = grouser.Scene.read("runs/scenes/quickstart.toml")
    scene["driver.sprocket_speed"] = 1.0
    with grouser.Simulation(scene) as sim:  # in this process
        sim.set_sprocket_speed(2.0)
        sim.step(100)
        print(sim.vehicle.speed, sim.vehicle.left.slip)
    run = scene.run("out/slow", progress=print)  # in a separate process
    run["vehicle.left.slip"].value          # [rows]; .time [s], .unit, .help
    run.sinkage()["left"].value             # [rows, shoes] [m]

SI units and radians throughout. docs/control.md is the guide; python/examples/ has worked examples.
"""
from .bed import Bed, kept_beds, open_bed
from .calibration import Calibration, Outcome, Trial, open_calibration
from .check import AxisError, BarredSeries, Check, CheckFigure, open_check
from .errors import DeviceError, FileError, GrouserError, InputError, SimulationError, StoppedError
from .events import EventLimit, EventRow, EventRun, Events, open_events
from .fields import FIELDS, Field
from .frames import UNITS, Frame, Frames, Mesh, open_frames, rotation
from .program import Job, Progress, call, find_program
from .run import Run, Surface, open_run
from .scene import Scene, measure_soil
from .series import Estimate, Quantity, Series
from .simulation import Simulation
from .soil import Constant, PlateCurve, ShearCurve, SoilTest, open_soil
from .sweep import Sweep, SweepMean, SweepRun, open_sweep

__version__ = "0.1.0"  # equal to CMakeLists.txt: tests/python/package_test.py compares them

__all__ = [
    "AxisError", "BarredSeries", "Bed", "Calibration", "Check", "CheckFigure", "Constant", "DeviceError", "Estimate",
    "EventLimit", "EventRow", "EventRun", "Events", "FIELDS", "Field", "FileError", "Frame", "Frames", "GrouserError", "InputError", "Job",
    "Mesh", "Outcome", "PlateCurve", "Progress", "Quantity", "Run", "Scene", "Series", "ShearCurve", "Simulation", "SimulationError",
    "SoilTest", "StoppedError", "Surface", "Sweep", "SweepMean", "SweepRun", "Trial", "UNITS", "call", "find_program",
    "kept_beds", "measure_soil", "open_bed", "open_calibration", "open_check", "open_events", "open_frames", "open_run",
    "open_soil", "open_sweep", "rotation",
]
