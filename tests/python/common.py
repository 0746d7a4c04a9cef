"""Scenes that the tests share."""
import os

import sprung

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))


def example(name):
    return os.path.join(SOURCE, "examples", name + ".json")


def cloth(n=12, **more):
    """A cloth of 1 m that hangs from two corners."""
    return {
        "duration": 1, "frame_rate": 30,
        "bodies": {"cloth": {
            "shape": {"type": "cloth", "size": [1, 1], "resolution": [n, n]}, "mass": 0.2, "thickness": 0.005,
            "springs": {"structural": {"stiffness": 100, "damping": 0.02}, "shear": {"stiffness": 30}, "bend": {"stiffness": 1}},
            "place": {"rotation": [-90, 0, 0]},
            "pins": [{"name": "hand", "at": "corner", "which": ["min_max", "max_max"]}]}},
        "obstacles": {"ball": {"shape": {"type": "sphere", "radius": 0.2}, "place": {"position": [0, -0.5, 0]}}},
        **more}


def rope(n=8, **more):
    """A rope of 1 m along x, of which nothing is pinned."""
    return {
        "duration": 1, "frame_rate": 50, "step": 0.001,
        "bodies": {"rope": {
            "shape": {"type": "rope", "points": [[0, 0, 0], [1, 0, 0]], "particles": n}, "mass": 0.1, "thickness": 0.005,
            "springs": {"structural": {"stiffness": 100, "damping": 0.05}}}},
        **more}


def simulator(scene, **options):
    return sprung.load(scene, **options).simulator()
