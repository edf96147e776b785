#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Steps a simulation in this process and controls the hull's speed, like tests/install/example/example.cpp.

    python/examples/hello_world.py [SCENE]        # default: runs/scenes/rigid_control.toml
"""
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))  # if the package is not installed
import grouser  # noqa: E402


def main(scene: str = str(ROOT / "runs/scenes/rigid_control.toml")) -> str:
    with grouser.Simulation(scene) as sim:
        while sim.time < 1:
            sim.set_sprocket_speed(2 + 4 * (0.3 - sim.vehicle.speed))  # [rad/s]
            sim.step_for(0.01)
        print(f"{sim.vehicle.speed:.3f} m/s, state hash {sim.hash()}")
        return sim.hash()


if __name__ == "__main__":
    main(*sys.argv[1:])
