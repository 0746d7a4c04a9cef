"""Finds the stiffness of a rope's springs from a measured sag.

A rope of 1 m and 0.1 kg hangs between two hooks and sags. How stiff are its springs? The simulator answers the question the other
way round, so a solver of scipy asks it for one stiffness after another.
"""
import numpy
import scipy.optimize

import sprung

SCENE = {
    "duration": 1,
    "frame_rate": 50,
    "step": 0.002,
    "integrator": {"type": "verlet", "damping_rate": 6},
    "sleep": False,
    "bodies": {"rope": {
        "shape": {"type": "rope", "points": [[0, 0, 0], [1, 0, 0]], "particles": 12},
        "mass": 0.1,
        "springs": {"structural": {"stiffness": 100, "damping": 0.05}},
        "pins": [{"indices": [0, 11]}]}}}

start = sprung.load(SCENE).simulator()


def sag(stiffness):
    """The depth [m] of the middle at rest, with springs of this stiffness [N/m]."""
    simulator = start.copy()
    rope = simulator.bodies["rope"]
    rope.set_springs(stiffness=stiffness)  # a model of its own
    simulator.step(2000)
    return -rope.particles[:, 1].min()


def fit(measured, low=20.0, high=400.0):
    """The stiffness [N/m] with which the rope sags as measured [m]."""
    return scipy.optimize.brentq(lambda stiffness: sag(stiffness) - measured, low, high, xtol=1e-3)


if __name__ == "__main__":
    TRUE = 137.0
    measured = sag(TRUE)
    found = fit(measured)
    print(f"a sag of {1000 * measured:.2f} mm: {found:.2f} N/m, of {TRUE} N/m")
    assert numpy.isclose(found, TRUE, rtol=1e-3)
