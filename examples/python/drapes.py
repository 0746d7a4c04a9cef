"""A data set of 100 drapes: cloths of different stiffness fall on balls of different sizes, all at once.

drapes.py FILE.npz [COUNT]: writes positions [m], (count, particles, 3), and what each drape was made of.
"""
import sys

import numpy

import sprung

RESOLUTION = 14
SECONDS = 0.8


def scene(stiffness, radius, shift):
    return {
        "duration": SECONDS,
        "bodies": {"cloth": {
            "shape": {"type": "cloth", "size": [0.6, 0.6], "resolution": [RESOLUTION, RESOLUTION]},
            "mass": 0.06, "thickness": 0.006, "friction": 0.8,
            "springs": {"structural": {"stiffness": stiffness, "damping": 0.01}, "shear": {"stiffness": 0.3 * stiffness},
                        "bend": {"stiffness": 0.02 * stiffness}},
            "place": {"position": [shift[0], radius + 0.02, shift[1]], "rotation": [-90, 0, 0]}}},
        "obstacles": {"ball": {"shape": {"type": "sphere", "radius": radius}, "friction": 0.8}}}


def main(path, count=100):
    random = numpy.random.default_rng(1)
    stiffness = random.uniform(20, 80, count)  # [N/m]
    radius = random.uniform(0.1, 0.2, count)  # [m]
    shift = random.uniform(-0.04, 0.04, (count, 2))  # [m]
    simulators = [sprung.load(scene(*each)).simulator() for each in zip(stiffness, radius, shift)]
    batch = sprung.Batch(simulators)
    while simulators[0].time < SECONDS - 1e-9:
        batch.frame()
    positions = numpy.stack([one.bodies["cloth"].particles for one in simulators])
    distances = numpy.linalg.norm(positions, axis=2).min(axis=1)
    assert (distances >= radius).all(), "a cloth is inside its ball"
    numpy.savez_compressed(path, positions=positions, faces=simulators[0].bodies["cloth"].faces, stiffness=stiffness, radius=radius,
                           shift=shift)
    print(f"{path}: {count} drapes of {positions.shape[1]} particles")


if __name__ == "__main__":
    main(sys.argv[1], *map(int, sys.argv[2:3]))
