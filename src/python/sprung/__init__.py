"""Sprung simulates ropes, cloths and elastic solids as networks of masses and damped springs that collide with meshes.

A scene from a file or a dict, its simulator, and its arrays:

    >>> import sprung
    >>> scene = sprung.load("examples/cloth_on_bunny.json")
    >>> simulator = scene.simulator()
    >>> simulator.step(10)
    >>> simulator.bodies["cloth"].particles     # a writable view [m], (n, 3)

SI units throughout: m, kg, s, N. The y axis points up. Arrays of points have a row for each particle.

- load, Scene: scenes. restore: simulators from files.
- Simulator: step(), frame(), bodies, pins, obstacles, forces; copy(), state(), restore().
- sweep: many runs of a scene with other values, each a process, or on Slurm; sweep_results: their table.
- Batch: many simulators at once, on all cores. show: a running simulator in the browser.
- NetworkBuilder: networks particle by particle, or of make_rope(), make_cloth(), make_solid() and make_mesh(), with
  make_sphere(), make_box(), make_ground() and make_mesh_obstacle() as obstacles.
- InputError, StepError, FileError, SprungWarning: what goes wrong, and the remedy.
"""
try:
    from ._core import version as __version__
except ModuleNotFoundError as error:
    if error.name != "sprung._core":
        raise
    import sys as _sys
    raise ImportError(f"sprung was not built for this Python, {_sys.version.split()[0]} of {_sys.executable}; use the Python for which "
                      "it was built (on Debian /usr/bin/python3), or build it with -DPython_EXECUTABLE=PATH") from error
from ._core import (Batch, Body, BodyShape, Network, NetworkBuilder, Obstacle, ObstacleShape, Pin, Scene, Simulator, Springs, State,
                    Viewer, make_box, make_cloth, make_ground, make_mesh, make_mesh_obstacle, make_rope, make_solid, make_sphere,
                    restore, show)
from ._errors import FileError, InputError, Problem, SprungWarning, StepError
from ._scene import load
from ._sweep import sweep, sweep_results

__all__ = [
    "Batch", "Body", "BodyShape", "FileError", "InputError", "Network", "NetworkBuilder", "Obstacle", "ObstacleShape", "Pin",
    "Problem", "Scene", "Simulator", "Springs", "SprungWarning", "State", "StepError", "Viewer", "load", "make_box",
    "make_cloth", "make_ground", "make_mesh", "make_mesh_obstacle", "make_rope", "make_solid", "make_sphere", "restore", "show",
    "sweep", "sweep_results",
]

for _name in __all__:
    globals()[_name].__module__ = "sprung"
del _name
