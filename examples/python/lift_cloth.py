"""A task for reinforcement learning, with the interface of gymnasium but without the package: lift a cloth by two pins.

A cloth lies on the floor. Two fingers hold two of its corners. An action moves both, and the reward is how high the lowest point of
the cloth is, less how much it is stretched.
"""
import numpy

import sprung

SCENE = {
    "duration": 10,
    "frame_rate": 30,
    "bodies": {"cloth": {
        "shape": {"type": "cloth", "size": [0.5, 0.5], "resolution": [12, 12]},
        "mass": 0.05, "thickness": 0.005, "friction": 0.4,
        "springs": {"structural": {"stiffness": 60, "damping": 0.02}, "shear": {"stiffness": 20}, "bend": {"stiffness": 0.5}},
        "place": {"position": [0, 0.01, 0], "rotation": [-90, 0, 0]},
        "pins": [{"name": "left", "at": "corner", "which": ["min_max"]}, {"name": "right", "at": "corner", "which": ["max_max"]}]}},
    "obstacles": {"floor": {"shape": {"type": "half_space"}, "friction": 0.4}}}


class LiftCloth:
    """reset() -> (observation, info); step(action) -> (observation, reward, terminated, truncated, info).

    The observation are positions of the particles [m], (n, 3) float32. The action is a displacement [m] of each finger in a
    frame, (2, 3), cut to 3 cm.
    """

    MOST = 0.03
    FRAMES = 60

    def __init__(self):
        self._start = sprung.load(SCENE).simulator()
        self.reset()

    def reset(self, *, seed=None, options=None):
        self.simulator = self._start.copy()
        self._cloth = self.simulator.bodies["cloth"]
        self._fingers = [self.simulator.pins[name] for name in ("left", "right")]
        self._frames = 0
        return self._observation(), {}

    def step(self, action):
        moves = numpy.clip(numpy.asarray(action, float).reshape(2, 3), -self.MOST, self.MOST)
        steps = self.simulator.steps_per_frame
        for _ in range(steps):
            for finger, move in zip(self._fingers, moves):
                finger.move_to(finger.position + move / steps)
            self.simulator.step()
        self._frames += 1
        lowest = float(self._cloth.particles[:, 1].min())
        reward = lowest - max(0.0, float(self._cloth.stretch.max()) - 0.1)
        return self._observation(), reward, lowest > 0.3, self._frames >= self.FRAMES, {"lowest": lowest}

    def _observation(self):
        return self._cloth.particles.astype(numpy.float32)


if __name__ == "__main__":
    env = LiftCloth()
    observation, _ = env.reset()
    done, total = False, 0.0
    while not done:
        observation, reward, terminated, truncated, info = env.step([[0, 0.02, 0], [0, 0.02, 0]])
        total += reward
        done = terminated or truncated
    print(f"lifted after {env.simulator.time:.2f} s, reward {total:.2f}")
    assert terminated and observation.shape == (144, 3)
