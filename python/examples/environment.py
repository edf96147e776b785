#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A reinforcement-learning environment with the Gymnasium interface: reset, step, observation, reward.

    python/examples/environment.py

The task: drive to a goal ahead and to the left. An action is the two sprocket speeds, -1 to 1, as fractions of the
maximum. The script tries random actions, then a simple rule, and fails if the rule does not earn more. It requires only
grouser and numpy; with gymnasium installed, derive the class from `gymnasium.Env`.
"""
from __future__ import annotations

import math
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))  # if the package is not installed
import grouser  # noqa: E402


class DriveToGoal:
    """Observation: distance to the goal ahead and to the left in the hull's frame [m], speed [m/s], turn rate [rad/s],
    slip of both tracks [-]. Reward: decrease in distance to the goal [m]. The episode ends within 0.1 m of the goal, or
    after `limit` steps."""

    observation_space = SimpleNamespace(shape=(6,), dtype=np.float64)
    action_space = SimpleNamespace(shape=(2,), low=-1.0, high=1.0, dtype=np.float64)

    def __init__(self, goal: tuple[float, float] = (1.0, 0.4), period: float = 0.05, limit: int = 40,
                 fastest: float = 8.0):
        self.goal, self.period, self.limit, self.fastest = np.array(goal), period, limit, fastest
        scene = grouser.Scene.read(ROOT / "runs/scenes/rigid_control.toml")
        scene["vehicle.sphere_radius"] = 0.03  # coarse, for speed
        scene["terrain.size"], scene["vehicle.position"] = [9.0, 6.0], [3.0, 0.0]  # room for wrong turns
        self.sim = grouser.Simulation(scene)
        while self.sim.vehicle.drive_start is None:  # until the vehicle is at rest: start of every episode
            self.sim.step_for(0.02)
        self._folder = tempfile.TemporaryDirectory()
        self._start = Path(self._folder.name) / "start.h5"
        self.sim.save(self._start)

    def reset(self, *, seed: int | None = None, options: dict | None = None) -> tuple[np.ndarray, dict]:
        self.rng = np.random.default_rng(seed)
        self.sim.restore(self._start)
        self.origin, self.taken = self._place(), 0
        return self._observation(), {}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict]:
        before = self._distance()
        left, right = self.fastest * np.clip(action, -1, 1)
        self.sim.set_sprocket_speed(float(left), float(right))
        self.sim.step_for(self.period)
        self.taken += 1
        distance = self._distance()
        return self._observation(), before - distance, distance < 0.1, self.taken >= self.limit, {}

    def close(self) -> None:
        self.sim.close()
        self._folder.cleanup()

    def _place(self) -> np.ndarray:
        # Hull's centre of mass: sim.vehicle.position is at the sprocket axle, which swings out in turns.
        return self.sim.bodies()["chassis"].position[:2]

    def _to_goal(self) -> np.ndarray:
        way, heading = self.origin + self.goal - self._place(), self.sim.vehicle.heading
        c, s = math.cos(heading), math.sin(heading)
        return np.array([c * way[0] + s * way[1], c * way[1] - s * way[0]])

    def _distance(self) -> float:
        return float(np.linalg.norm(self._to_goal()))

    def _observation(self) -> np.ndarray:
        v = self.sim.vehicle
        return np.nan_to_num(np.array([*self._to_goal(), v.speed, v.turn_rate, v.left.slip, v.right.slip]))


def rule(seen: np.ndarray) -> np.ndarray:
    """Drives towards the goal, steering by its bearing."""
    turn = np.clip(2 * math.atan2(seen[1], max(seen[0], 0.05)), -0.8, 0.8)
    return np.array([0.6 - turn, 0.6 + turn])


def episode(env: DriveToGoal, policy) -> float:
    seen, _ = env.reset(seed=1)
    total, done = 0.0, False
    while not done:
        seen, reward, reached, over, _ = env.step(policy(seen))
        total, done = total + reward, reached or over
    return total


def main(limit: int = 40) -> tuple[float, float]:
    env = DriveToGoal(limit=limit)
    random = episode(env, lambda seen: env.rng.uniform(-1, 1, 2))
    ruled, again = episode(env, rule), episode(env, rule)
    env.close()
    print(f"reward: random {random:.3f} m, rule {ruled:.3f} m, repeated {again:.3f} m")
    if not ruled > random + 0.1 or ruled != again:
        raise SystemExit("the rule must earn more than random actions, and the same reward in each run")
    return random, ruled


if __name__ == "__main__":
    main()
