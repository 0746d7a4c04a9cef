"""Laws of batches, threads and signals."""
import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy

import sprung
from common import cloth, rope, simulator


def futures(count, n=10):
    """Simulators of one scene that differ by their gravity."""
    scene = sprung.load(cloth(n))
    simulators = [scene.simulator() for _ in range(count)]
    for k, one in enumerate(simulators):
        one.gravity = [0.1 * k, -9.81, 0]
    return simulators


class Batches(unittest.TestCase):
    def test_each_gets_the_bits_that_it_gets_alone(self):
        together, alone = futures(7), futures(7)
        sprung.Batch(together).step(60)
        for one in alone:
            one.step(60)
        for a, b in zip(together, alone):
            self.assertEqual(a.state(), b.state())

    def test_one_large_simulator_gets_the_same_bits(self):
        together, alone = simulator(cloth(48)), simulator(cloth(48))
        sprung.Batch([together]).step(20)
        alone.step(20)
        self.assertEqual(together.state(), alone.state())

    def test_frames_end_together(self):
        simulators = futures(3)
        simulators[1].step(3)
        batch = sprung.Batch(simulators)
        batch.frame()
        self.assertEqual({one.frame_number for one in simulators}, {2})
        self.assertEqual((len(batch), batch.simulators[1] is simulators[1]), (3, True))

    def test_takes_over_what_was_written(self):
        simulators = futures(2)
        views = [one.bodies["cloth"].velocities for one in simulators]
        views[0][:] = 0.5
        sprung.Batch(simulators).step()
        self.assertGreater(abs(views[0]).max(), 0.4)
        numpy.testing.assert_array_equal(views[1], simulators[1].state().velocities)
        views[1][5] = numpy.nan
        states = [one.state() for one in (simulators[0], simulators[0])]
        with self.assertRaises(sprung.InputError):
            sprung.Batch(simulators).step()
        self.assertEqual(simulators[0].state(), states[0])

    def test_calls_forces_of_python(self):
        together, alone = futures(4), futures(4)
        for one in together + alone:
            one.add_force(lambda x, v, t: -0.05 * v)
        sprung.Batch(together).step(20)
        for one in alone:
            one.step(20)
        for a, b in zip(together, alone):
            self.assertEqual(a.state(), b.state())

    def test_the_first_error_is_raised_and_the_others_go_on(self):
        simulators = futures(3)

        def force(x, v, t):
            if t > 0:
                raise KeyError("of one")
            return 0 * x
        simulators[1].add_force(force)
        with self.assertRaises(KeyError):
            sprung.Batch(simulators).step(10)
        self.assertLess(simulators[1].time, 3 * simulators[1].step_length)
        self.assertAlmostEqual(simulators[2].time, 10 * simulators[2].step_length, 12)
        simulators[1].remove_force(force)
        simulators[1].step()

    def test_a_simulator_is_there_once(self):
        one = simulator(rope())
        for wrong in ([one, one], [one, None], [3]):
            with self.assertRaises(sprung.InputError):
                sprung.Batch(wrong)


class Threads(unittest.TestCase):
    def test_the_lock_is_given_back_during_steps(self):
        one = simulator(cloth(32))
        worker = threading.Thread(target=one.step, args=(400,))
        counted = 0
        worker.start()
        while worker.is_alive():
            counted += 1
        worker.join()
        self.assertGreater(counted, 1000)

    def test_a_simulator_that_steps_is_refused_to_others(self):
        one = simulator(cloth(32))
        worker = threading.Thread(target=one.step, args=(400,))
        worker.start()
        refused = 0
        while worker.is_alive():
            try:
                one.state()
            except RuntimeError as error:
                self.assertIn("in use", str(error))
                refused += 1
            time.sleep(0.001)
        worker.join()
        self.assertGreater(refused, 0)
        one.step()


class Exit(unittest.TestCase):
    def test_a_thread_that_still_steps_ends_with_the_program(self):
        program = """
import threading, sys, time
from common import cloth, simulator
one = simulator(cloth(16))
if sys.argv[1] == "force":
    one.add_force(lambda x, v, t: 0 * x)
threading.Thread(target=lambda: [one.step(3) for _ in range(10 ** 9)], daemon=True).start()
time.sleep(0.2)
print("leaving")
"""
        for what in ("force", "none"):
            done = subprocess.run([sys.executable, "-c", program, what], capture_output=True, text=True, timeout=60)
            self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "leaving\n", ""))


class Signals(unittest.TestCase):
    def interrupt(self, call, after=0.3):
        timer = threading.Timer(after, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            call()
        timer.join()
        return time.monotonic() - begin - after

    def test_ctrl_c_stops_and_the_simulator_goes_on(self):
        one = simulator(cloth(24))
        late = self.interrupt(lambda: one.step(10 ** 9))
        self.assertLess(late, 2.0)
        self.assertEqual(len(one.bodies["cloth"].particles), 576)
        self.assertTrue(numpy.isfinite(one.bodies["cloth"].particles).all())
        time_then = one.time
        self.assertGreater(time_then, 0.0)
        one.step(10)
        self.assertAlmostEqual(one.time, time_then + 10 * one.step_length, 9)

    def test_ctrl_c_stops_a_batch(self):
        simulators = futures(4)
        late = self.interrupt(lambda: sprung.Batch(simulators).step(10 ** 9))
        self.assertLess(late, 2.0)
        for one in simulators:
            one.step()


if __name__ == "__main__":
    unittest.main()
