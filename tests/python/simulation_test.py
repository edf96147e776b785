#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""In-process simulation: steps, observations, control, replay, views, errors and threads."""
import os
import gc
import pickle
import signal
import subprocess
import sys
import threading
import time
import unittest
import weakref

import numpy
from fixture import ROOT, FolderTest

import grouser

FALL = {
    "version": 1,
    "run": {"duration": 0.1, "time_step": 1e-3},
    "material": {"glass": {"stiffness": 1e3}},
    "plane": [{"material": "glass"}],
    "grain": [{"position": [0, 0, 1], "radius": 0.01, "material": "glass"},
              {"position": [1, 0, 2], "radius": 0.02, "material": "glass"}],
}


def vehicle_scene() -> grouser.Scene:
    """A scene with rigid ground, coarse spheres, and a drive that starts at 40 ms."""
    scene = grouser.Scene.read(ROOT / "tests/scenes/rigid.toml")
    scene["vehicle.sphere_radius"] = 0.03
    scene["driver"] = {"sprocket_speed": 0.0, "tension_ramp": 0.02, "weight_ramp": 0.02, "drive_start": 0.04,
                       "drive_ramp": 0.01}
    scene["output.plots"] = False
    return scene


class Grains(FolderTest):
    def test_fall_as_symplectic_euler_has_it(self):
        with grouser.Simulation(grouser.Scene(FALL)) as sim:
            sim.step(100)
            self.assertAlmostEqual(sim.time, 0.1)
            numpy.testing.assert_allclose(sim.positions[:, 2], [1 - 9.81e-6 * 5050, 2 - 9.81e-6 * 5050], atol=1e-9)
            grains = sim.grains()
            numpy.testing.assert_allclose(grains.velocity[:, 2], -0.981, atol=1e-6)
            self.assertEqual(grains.velocity.dtype, numpy.float32)
            numpy.testing.assert_allclose(grains.radius, [0.01, 0.02], rtol=1e-6)
            self.assertAlmostEqual(sim.energies().residual, 0, delta=1e-9)

    def test_positions_are_a_read_only_view_that_no_step_changes_while_it_is_held(self):
        with grouser.Simulation(grouser.Scene(FALL)) as sim:
            held = sim.positions
            self.assertEqual((held.shape, held.dtype), ((2, 3), numpy.float64))
            self.assertIs(sim.positions, held)  # a single step has one array
            before = held.copy()
            with self.assertRaises(ValueError):
                held[0, 0] = 1
            sim.step(10)
            self.assertIsNot(sim.positions, held)
            numpy.testing.assert_array_equal(held, before)
            self.assertLess(sim.positions[0, 2], before[0, 2])
            # No references remain: the memory is reused.
            del held
            address = sim.positions.ctypes.data
            sim.step(1)
            self.assertEqual(sim.positions.ctypes.data, address)

    def test_a_view_outlives_its_simulation(self):
        sim = grouser.Simulation(grouser.Scene(FALL))
        held = sim.positions
        sim.close()
        gc.collect()
        self.assertEqual(held[1, 2], 2)
        with self.assertRaises(grouser.InputError):
            sim.step()

    def test_gravity_may_change(self):
        with grouser.Simulation(grouser.Scene(FALL)) as sim:
            sim.step(50)
            sim.set_gravity([1, 0, 0])
            sim.step(50)
            numpy.testing.assert_allclose(sim.grains().velocity[0], [0.05, 0, -0.4905], atol=1e-6)


class Vehicles(FolderTest):
    def test_are_steered_recorded_and_replayed(self):
        out = self.folder / "steered"
        with grouser.Simulation(vehicle_scene(), out) as sim:
            while sim.steps < 900:
                speed = sim.vehicle.speed
                sim.set_sprocket_speed(2 + 3 * (0.3 - speed), 2.5 + 3 * (0.3 - speed))
                sim.step(100)
            self.assertAlmostEqual(sim.vehicle.right.sprocket_speed - sim.vehicle.left.sprocket_speed, 0.5, delta=1e-9)
            self.assertEqual(sim.vehicle.left.tension.shape, (46,))
            self.assertGreater(sim.vehicle.speed, 0.05)
            sim.set_sprocket_speed(1.0)  # after the last step: part of the final state
        ended = grouser.open_run(out).manifest["state_hash"]
        run = grouser.open_run(out)
        self.assertEqual(run.status, "finished")
        said = grouser.call(["run", "--replay", str(out), "--threads", "2", "--out", str(self.folder / "again")])
        self.assertRegex(said, r"replay +\d+ inputs of .*: same state hash")
        self.assertEqual(grouser.open_run(self.folder / "again").manifest["state_hash"], ended)

    def test_a_checkpoint_goes_on_with_what_acts(self):
        file = self.folder / "state.h5"
        with grouser.Simulation(vehicle_scene()) as sim:
            sim.step(450)
            sim.set_sprocket_speed(2.0)
            sim.set_load("chassis", [0, 0, -200])
            sim.step(50)
            sim.save(file)
            sim.step(100)
            straight = sim.hash()
            sim.restore(file)
            self.assertEqual(sim.steps, 500)
            sim.step(100)
            self.assertEqual(sim.hash(), straight)
        with grouser.Simulation(vehicle_scene(), checkpoint=file, threads=2) as sim:
            sim.step(100)
            self.assertEqual(sim.hash(), straight)

    def test_what_the_scene_lacks_is_an_input_error(self):
        with grouser.Simulation(vehicle_scene()) as sim:
            for call, words in ((lambda: sim.set_throttle(1), "engine"), (lambda: sim.set_sprocket_torque(1), "torque"),
                                (lambda: sim.set_hitch_force(1), "[hitch]"), (lambda: sim.set_load("chasis", [1, 0, 0]),
                                                                              '"chassis"'),
                                (lambda: sim.set_sprocket_speed(1e9), "[-100, 100] [rad/s]"),
                                (lambda: sim.set_sprocket_speed(float("nan")), "nan is not finite")):
                with self.assertRaises(grouser.InputError) as caught:
                    call()
                self.assertIn(words, str(caught.exception))
                self.assertEqual(caught.exception.exit_code, 2)


class Process(FolderTest):
    def test_several_simulations_run_in_threads_and_alike(self):
        hashes = []

        def run():
            with grouser.Simulation(grouser.Scene(FALL), threads=1) as sim:
                sim.step(100)
                hashes.append(sim.hash())
        threads = [threading.Thread(target=run) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(hashes), 3)
        self.assertEqual(len(set(hashes)), 1)

    def test_a_step_leaves_the_interpreter_to_other_threads_but_not_the_simulation(self):
        with grouser.Simulation(vehicle_scene(), threads=1) as sim:
            thread = threading.Thread(target=sim.step, args=(5000,))
            thread.start()
            time.sleep(0.05)
            counted, refused = 0, None
            while thread.is_alive():
                counted += 1
                try:
                    _ = sim.time
                except grouser.InputError as error:
                    refused = error
                time.sleep(0.001)
            thread.join()
            self.assertGreater(counted, 20)
            self.assertIn("another thread", str(refused))

    def test_control_c_ends_a_step(self):
        with grouser.Simulation(vehicle_scene(), threads=1) as sim:
            begun = time.monotonic()
            threading.Timer(0.3, signal.raise_signal, (signal.SIGINT,)).start()
            with self.assertRaises(KeyboardInterrupt):
                sim.step(10_000_000)
            self.assertLess(time.monotonic() - begun, 5)
            sim.step(1)  # the state is valid

    def test_errors_free_what_they_leave(self):
        sim = grouser.Simulation(grouser.Scene(FALL))
        gone = weakref.ref(sim)
        with self.assertRaises(TypeError):
            pickle.dumps(sim)
        with self.assertRaises(grouser.InputError):
            sim.step(0)
        del sim
        gc.collect()
        self.assertIsNone(gone())
        with self.assertRaises(grouser.InputError):
            scene = grouser.Scene(FALL)
            scene["material.glass.stiffness"] = -1.0
            grouser.Simulation(scene)

    def test_an_unsound_simulation_says_so_and_can_be_looked_at(self):
        sim = grouser.Simulation(grouser.Scene(FALL))  # a grain that falls 1 m penetrates so soft a plane
        with self.assertRaises(grouser.SimulationError) as caught:
            sim.step(2000)
        self.assertEqual(caught.exception.exit_code, 3)
        self.assertEqual(sim.positions.shape, (2, 3))
        with self.assertRaisesRegex(grouser.InputError, "has failed"):
            sim.step()
        sim.finish()  # nothing to finish

    def test_positions_are_those_of_the_state_that_was_restored(self):
        with grouser.Simulation(grouser.Scene(FALL)) as sim:
            sim.step(10)
            sim.save(self.folder / "ten.h5")
            there = sim.positions.copy()
            sim.restore(self.folder / "ten.h5")
            sim.set_gravity([1, 0, 0])
            sim.step(10)
            sim.save(self.folder / "aside.h5")
            aside = sim.positions.copy()
            sim.restore(self.folder / "ten.h5")
            self.assertTrue((sim.positions == there).all())
            sim.step(10)
            sim.positions
            sim.restore(self.folder / "aside.h5")  # same step, different state
            self.assertTrue((sim.positions == aside).all())

    def test_a_forked_process_says_that_it_cannot_run_threads(self):
        with grouser.Simulation(vehicle_scene(), threads=2) as sim:
            sim.step(1)
            reader, writer = os.pipe()
            child = os.fork()
            if child == 0:
                try:
                    grouser.Simulation(vehicle_scene(), threads=1)
                except grouser.InputError as error:
                    os.write(writer, str(error).encode())
                os._exit(0)
            os.waitpid(child, 0)
            os.close(writer)
            self.assertIn("spawn", os.read(reader, 1000).decode())
            os.close(reader)

    def test_arguments_of_another_kind_are_named(self):
        with grouser.Simulation(vehicle_scene(), threads=1) as sim:
            for call, words in ((lambda: sim.set_load("chassis", [1, 2]), "force: expected three numbers"),
                                (lambda: sim.step(1.5), "count: expected an integer"),
                                (lambda: sim.set_sprocket_speed("1"), "left: expected a number")):
                self.assertRaisesRegex(TypeError, words, call)
            with self.assertRaises(AttributeError):
                sim.sprocket_speed = 3
        scene = vehicle_scene()
        scene["vehicle.gear_contact_model"] = "samples"  # its shoes are converted to spheres
        with grouser.Simulation(scene, threads=1) as sim:
            self.assertIn("shoe.obj", sim.warnings[0])
        with self.assertRaisesRegex(grouser.InputError, "threads = -1"):
            grouser.Simulation(vehicle_scene(), threads=-1)

    def test_steps_that_cannot_be_are_input_errors(self):
        with grouser.Simulation(grouser.Scene(FALL)) as sim:
            for seconds in (0, -1, float("nan"), float("inf")):
                with self.assertRaises(grouser.InputError):
                    sim.step_for(seconds)
            with self.assertRaises(grouser.InputError):
                sim.step(2**62)
            self.assertEqual(sim.steps, 0)


class Copies(FolderTest):
    def test_the_state_of_a_vehicle_is_a_copy(self):
        with grouser.Simulation(vehicle_scene(), threads=1) as sim:
            sim.step(20)
            held, again = sim.vehicle, sim.vehicle
            self.assertIsNot(held, again)
            kept = {name: numpy.copy(getattr(held, name)) for name in ("position", "velocity", "ground_force")}
            tension, time_ = held.left.tension.copy(), held.time
            again.speed, again.left.slip, again.right = 99.0, 99.0, None
            again.extra = 1
            self.assertNotEqual(held.speed, 99.0)
            self.assertNotEqual(held.left.slip, 99.0)
            self.assertEqual(sim.vehicle.speed, held.speed)
            self.assertEqual(sim.vehicle.right.drive_torque, held.right.drive_torque)
            self.assertFalse(hasattr(sim.vehicle, "extra"))
            sim.step(50)
            self.assertEqual(held.time, time_)
            self.assertGreater(sim.vehicle.time, time_)
            for name, value in kept.items():
                numpy.testing.assert_array_equal(getattr(held, name), value)
            numpy.testing.assert_array_equal(held.left.tension, tension)
            self.assertTrue((sim.vehicle.left.tension != tension).any())

    def test_all_observations_are_copies_that_outlive_the_simulation(self):
        def arrays(*found):
            for one in found:
                for value in vars(one).values():
                    if isinstance(value, numpy.ndarray):
                        yield value
        for scene, arrays_of in ((vehicle_scene(), lambda sim: [*arrays(sim.vehicle, sim.vehicle.left),
                                                                *arrays(*sim.bodies().values())]),
                                 (grouser.Scene(FALL), lambda sim: [sim.positions, sim.positions[:, 2], *arrays(sim.grains())])):
            sim = grouser.Simulation(scene, threads=1)
            sim.step(5)
            held, ledger = arrays_of(sim), sim.energies()
            before, kinetic = [value.copy() for value in held], ledger.kinetic
            self.assertGreater(len(held), 5)
            self.assertFalse(any(value.flags.writeable for value in held))
            sim.step(20)
            sim.energies().kinetic = -1
            self.assertGreater(sim.energies().kinetic, 0)
            sim.close()
            del sim
            gc.collect()
            self.assertEqual(ledger.kinetic, kinetic)
            for value, was in zip(held, before):
                numpy.testing.assert_array_equal(value, was)


#: Threads that are inside the library when the interpreter exits.
INSIDE = """import atexit, sys, threading, time
sys.path[:0] = {path!r}
import grouser
from simulation_test import FALL, vehicle_scene
scene = grouser.Scene(FALL) if {kind!r} == "grains" else vehicle_scene()
if {kind!r} == "grains":
    scene["run.gravity"] = [0, 0, 0]
ready, stopped = threading.Event(), []
def work():
    sim = grouser.Simulation(scene, threads=1)
    try:
        ready.set()
        while True:
            sim.step({count})
    except SystemExit:
        stopped.append(sim.steps)
        raise
thread = threading.Thread(target=work, daemon=True)
other = grouser.Simulation(grouser.Scene(FALL), threads=1)
def at_exit():  # runs after the wait for the thread
    other.step(1)
    print("steps", other.steps, flush=True)
atexit.register(at_exit)
thread.start()
ready.wait()
time.sleep({pause})
{end}
"""


class Exit(FolderTest):
    def ended(self, kind="grains", count=10**9, pause=0.1, end="", code=INSIDE, seconds=60):
        text = code.format(path=sys.path[:2] + [str(ROOT / "tests/python")], kind=kind, count=count, pause=pause, end=end)
        return subprocess.run(["/usr/bin/python3", "-B", "-c", text], capture_output=True, text=True, timeout=seconds)

    def test_a_daemon_thread_in_a_step_does_not_abort_the_process(self):
        for kind in ("grains", "vehicle"):
            for count in (1, 50, 10**9):
                done = self.ended(kind, count)
                self.assertEqual((done.returncode, done.stderr), (0, ""), (kind, count))
                self.assertEqual(done.stdout, "steps 1\n")

    def test_the_exit_code_is_that_of_the_main_thread(self):
        for end, code, words in (("sys.exit(7)", 7, ""), ("raise ValueError('the end')", 1, "ValueError: the end"),
                                 ("import os, signal; os.kill(os.getpid(), signal.SIGINT); time.sleep(9)", -signal.SIGINT,
                                  "KeyboardInterrupt")):
            done = self.ended(end=end)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(words, done.stderr)
            self.assertNotIn("Exception in thread", done.stderr)
            self.assertEqual(done.stdout, "steps 1\n")

    def test_a_bed_that_settles_in_a_daemon_thread_does_not_abort_the_process(self):
        code = """import sys, threading
sys.path[:0] = {path!r}
import grouser
settles = threading.Event()
scene = grouser.Scene.read("{end}")
thread = threading.Thread(target=grouser.Simulation, args=(scene,), daemon=True, kwargs=dict(
    threads=1, cache=False, settling=lambda time, energy: settles.set()))
thread.start()
settles.wait()
"""
        done = self.ended(end=ROOT / "tests/scenes/coupled.toml", code=code)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_a_forked_process_does_not_wait_for_threads_of_its_parent(self):
        end = "import os\nchild = os.fork()\nif child: assert os.waitpid(child, 0)[1] == 0\nelse: atexit.unregister(at_exit)"
        done = self.ended(end=end)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_a_thread_that_does_not_leave_the_library_can_be_interrupted(self):
        code = """import signal, sys, threading, time
sys.path[:0] = {path!r}
import grouser
held = threading.Event()
def settling(time_, energy):
    held.set()
    time.sleep(600)  # a callback that keeps its thread
scene = grouser.Scene.read("{end}")
threading.Thread(target=grouser.Simulation, args=(scene,), daemon=True, kwargs=dict(
    threads=1, cache=False, settling=settling)).start()
held.wait()
timer = threading.Timer(0.5, signal.raise_signal, (signal.SIGINT,))
timer.daemon = True
timer.start()
"""
        done = self.ended(end=ROOT / "tests/scenes/coupled.toml", code=code)
        self.assertEqual(done.returncode, -signal.SIGINT, done.stderr)


if __name__ == "__main__":
    unittest.main()
