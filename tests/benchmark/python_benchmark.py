"""What Python costs, as ratios in one run: python_benchmark.py ROPE_LOOP. Needs PYTHONPATH=BUILD/python:tests/python.

Other programs on the machine disturb a measurement, so the best of several counts, of each side on its own."""
import json
import subprocess
import sys
import tempfile
import time

import sprung
from common import cloth, rope

ATTEMPTS = 12


def seconds(call):
    begin = time.perf_counter()
    call()
    return time.perf_counter() - begin


def seconds_of_loops(rope_loop):
    """1000 steps of a rope of 32 particles: in Python, and in C++."""
    scene = rope(32, sleep=False)
    scene["bodies"]["rope"]["pins"] = [{"indices": [0]}]
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(scene, file)
        file.flush()
        cpp = float(subprocess.run([rope_loop, file.name], check=True, capture_output=True).stdout)
        one = sprung.load(file.name).simulator()

    def loop():
        for _ in range(1000):
            one.step()
    return min(seconds(loop) for _ in range(15)), cpp


def seconds_of_many():
    """200 steps of 16 small cloths, with the copies at their begin: one after the other, and in a batch."""
    scene = sprung.load(cloth(10))
    alone = [scene.simulator() for _ in range(16)]
    batch = sprung.Batch([scene.simulator() for _ in range(16)])
    return seconds(lambda: [one.step(200) for one in alone]), seconds(lambda: batch.step(200))


def seconds_of_copy():
    """A cloth of 64 x 64 particles: a copy, and a step."""
    one = sprung.load(cloth(64)).simulator()
    one.step(50)
    return min(seconds(one.copy) for _ in range(5)), min(seconds(one.step) for _ in range(5))


def ratio_of_best(measure):
    first, second = zip(*(measure() for _ in range(ATTEMPTS)))
    return min(first) / min(second)


print(f"loop in Python / in C++: {ratio_of_best(lambda: seconds_of_loops(sys.argv[1])):.2f}")
print(f"one after the other / batch: {ratio_of_best(seconds_of_many):.2f}")
print(f"copy / step: {ratio_of_best(seconds_of_copy):.4f}")
