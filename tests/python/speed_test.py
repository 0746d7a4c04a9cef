"""What Python costs, as ratios in one run. Other programs on the machine disturb a measurement, so the best of several counts."""
import json
import os
import subprocess
import tempfile
import time
import unittest

import sprung
from common import cloth, rope


def seconds(call):
    begin = time.perf_counter()
    call()
    return time.perf_counter() - begin


def best_ratio(measure, is_enough, attempts=12):
    """The first ratio that is enough, or the last."""
    for _ in range(attempts):
        ratio = measure()
        if is_enough(ratio):
            break
    print(f"ratio {ratio:.3f}", end=" ", flush=True)
    return ratio


class Speed(unittest.TestCase):
    def test_a_loop_over_steps_costs_at_most_1_3_times_that_of_cpp(self):
        scene = rope(32, sleep=False)
        scene["bodies"]["rope"]["pins"] = [{"indices": [0]}]
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(scene, file)
            file.flush()

            def measure():
                cpp = float(subprocess.run([os.environ["SPRUNG_ROPE_LOOP"], file.name], check=True, capture_output=True).stdout)
                one = sprung.load(file.name).simulator()

                def loop():
                    for _ in range(1000):
                        one.step()
                return min(seconds(loop) for _ in range(15)) / cpp
            self.assertLessEqual(best_ratio(measure, lambda ratio: ratio <= 1.3), 1.3)

    @unittest.skipIf(len(os.sched_getaffinity(0)) < 2, "needs two cores")
    def test_a_batch_on_two_cores_is_1_8_times_as_fast_as_one_after_the_other(self):
        scene = sprung.load(cloth(10))
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:2])

        def measure():
            together = [scene.simulator() for _ in range(16)]
            alone = [scene.simulator() for _ in range(16)]
            batch = sprung.Batch(together)

            def one_after_the_other():
                for one in alone:
                    one.step(200)
            by_clock.append(seconds(one_after_the_other) / seconds(lambda: batch.step(200)))
            return by_clock[-1]
        by_clock = []
        if best_ratio(measure, lambda ratio: ratio >= 1.8, 40) < 1.8 and os.getloadavg()[0] > 1.5:
            self.judge_by_processor_time(scene)
        else:
            self.assertGreaterEqual(by_clock[-1], 1.8)

    def judge_by_processor_time(self, scene):
        """Where other programs take the cores: what the batch costs all cores together, at most 2 / 1.8 of one after the other."""
        simulators = [scene.simulator() for _ in range(32)]
        begin = time.process_time()
        sprung.Batch(simulators[:16]).step(200)
        together = time.process_time() - begin
        for one in simulators[16:]:
            one.step(200)
        alone = time.process_time() - begin - together
        print(f"the machine is busy; processor time {together / alone:.3f}", end=" ", flush=True)
        self.assertLessEqual(together / alone, 2 / 1.8)

    def test_a_copy_costs_less_than_a_step(self):
        one = sprung.load(cloth(64)).simulator()
        one.step(50)
        measure = lambda: min(seconds(one.copy) for _ in range(5)) / min(seconds(one.step) for _ in range(5))  # noqa: E731
        self.assertLess(best_ratio(measure, lambda ratio: ratio < 1.0), 1.0)


if __name__ == "__main__":
    unittest.main()
