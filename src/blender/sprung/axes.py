"""Blender's axes and units to Sprung's and back. All other code of the add-on calls this file to convert."""
import math

import mathutils
import numpy

# Blender has Z up, Sprung Y up: x, y, z of Blender are x, -z, y of Sprung.
TO_SPRUNG = numpy.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


class Axes:
    """Converts between the world of a Blender scene and that of Sprung. `metres` is the length of a Blender unit [m]."""

    def __init__(self, metres=1.0):
        self.metres = metres

    @classmethod
    def of_scene(cls, scene):
        units = scene.unit_settings
        return cls(1.0 if units.system == "NONE" else units.scale_length)

    def points(self, world):
        """Positions of Blender's world, n x 3, as Sprung's [m]."""
        return numpy.asarray(world, float) @ TO_SPRUNG.T * self.metres

    def vector(self, world):
        """A velocity, an acceleration or a position of Blender's world as a list for a scene file."""
        return self.points(numpy.asarray(world, float)[None])[0].tolist()

    def to_world(self, points):
        """Positions of Sprung [m], n x 3, as those of Blender's world."""
        return numpy.asarray(points, float) @ TO_SPRUNG / self.metres


def linear(matrix):
    """The rotation, scale and shear of a 4 x 4 matrix."""
    return numpy.asarray(matrix, float)[:3, :3]


def translation(matrix):
    return numpy.asarray(matrix, float)[:3, 3]


def to_world(matrix, local):
    """Positions of an object, n x 3, in Blender's world. This is where the scale of an object counts."""
    return numpy.asarray(local, float) @ linear(matrix).T + translation(matrix)


def to_local(matrix, world):
    """Positions of Blender's world in the axes of an object; the inverse of to_world."""
    return numpy.linalg.solve(linear(matrix), (numpy.asarray(world, float) - translation(matrix)).T).T


def is_mirrored(matrix):
    """Whether the object's scale turns its faces inside out."""
    return numpy.linalg.det(linear(matrix)) < 0.0


def rotation_between(first, second, tolerance=1e-5):
    """The rotation in Blender's axes that takes the 3 x 3 matrix `first` to `second`; None if there is none."""
    rotation = numpy.linalg.solve(first.T, second.T).T
    off = numpy.abs(rotation @ rotation.T - numpy.eye(3)).max()
    return rotation if off <= tolerance and numpy.linalg.det(rotation) > 0.0 else None


def sprung_angles(rotation, previous):
    """Angles [degrees] about Sprung's fixed axes x, then y, then z, of a rotation in Blender's axes. They are near the angles
    `previous`, so that what turns on does not jump by 360 degrees."""
    matrix = mathutils.Matrix((TO_SPRUNG @ rotation @ TO_SPRUNG.T).tolist())
    near = mathutils.Euler([math.radians(angle) for angle in previous], "XYZ")
    return [math.degrees(angle) for angle in matrix.to_euler("XYZ", near)]
