"""What Python costs, as ratios in one run: python_benchmark.py ROPE_LOOP. Needs PYTHONPATH=BUILD/python:tests/python.

Other programs on the machine disturb a measurement, so the best of several counts."""
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


def loop_over_cpp(rope_loop):
    """1000 steps of a rope of 32 particles, over those of a loop in C++."""
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
    return min(seconds(loop) for _ in range(15)) / cpp


def one_after_the_other_over_batch():
    """200 steps of 16 small cloths, one after the other, over those of a batch."""
    scene = sprung.load(cloth(10))
    together = [scene.simulator() for _ in range(16)]
    alone = [scene.simulator() for _ in range(16)]
    batch = sprung.Batch(together)

    def one_after_the_other():
        for one in alone:
            one.step(200)
    return seconds(one_after_the_other) / seconds(lambda: batch.step(200))


def copy_over_step():
    """A copy of a cloth of 64 x 64 particles, over a step."""
    one = sprung.load(cloth(64)).simulator()
    one.step(50)
    return min(seconds(one.copy) for _ in range(5)) / min(seconds(one.step) for _ in range(5))


print(f"loop in Python / in C++: {min(loop_over_cpp(sys.argv[1]) for _ in range(ATTEMPTS)):.2f}")
print(f"one after the other / batch: {max(one_after_the_other_over_batch() for _ in range(ATTEMPTS)):.2f}")
print(f"copy / step: {min(copy_over_step() for _ in range(ATTEMPTS)):.3f}")
