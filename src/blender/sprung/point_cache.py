"""PC2 files, and the modifier Mesh Cache that plays them."""
import struct

import bpy
import numpy

HEADER = struct.Struct("<12siiffi")  # magic, version, points, first frame, frames a sample, samples
MODIFIER = "Sprung"


def read_pc2(path):
    """Positions of all whole frames: samples x points x 3."""
    with open(path, "rb") as file:
        data = file.read()
    magic, _, points, _, _, samples = HEADER.unpack_from(data)
    if not magic.startswith(b"POINTCACHE2"):
        raise ValueError(f"{path} is no PC2 file")
    samples = min(samples, (len(data) - HEADER.size) // (12 * points)) if points else 0
    return numpy.frombuffer(data, "<f4", 3 * samples * points, HEADER.size).reshape(samples, points, 3)


def write_pc2(path, frames):
    frames = numpy.ascontiguousarray(frames, "<f4")
    with open(path, "wb") as file:
        file.write(HEADER.pack(b"POINTCACHE2\0", 1, frames.shape[1], 0.0, 1.0, frames.shape[0]))
        file.write(frames.tobytes())


def find_modifier(thing):
    modifier = thing.modifiers.get(MODIFIER)
    return modifier if modifier and modifier.type == "MESH_CACHE" else None


def ensure_modifier(thing):
    """The modifier of a body. Its place in the stack is where the simulation happens: modifiers above it make what is simulated,
    those below act on the result."""
    modifier = find_modifier(thing)
    if not modifier:
        modifier = thing.modifiers.new(MODIFIER, "MESH_CACHE")
        modifier.show_viewport = modifier.show_render = False  # until there is a result
    return modifier


def remove_modifier(thing):
    modifier = find_modifier(thing)
    if modifier:
        thing.modifiers.remove(modifier)


def attach(thing, path, first_frame):
    """Lets the object show the frames of a PC2 file, whose positions are in the object's own axes."""
    modifier = ensure_modifier(thing)
    modifier.cache_format = "PC2"
    modifier.filepath = bpy.path.relpath(path) if bpy.data.filepath else path
    modifier.time_mode = "FRAME"
    modifier.play_mode = "SCENE"
    modifier.frame_start = first_frame
    modifier.frame_scale = 1.0
    modifier.forward_axis, modifier.up_axis = "POS_Y", "POS_Z"  # as the file: no change of axes
    modifier.flip_axis = set()
    modifier.interpolation = "LINEAR"
    modifier.deform_mode = "OVERWRITE"
    modifier.show_viewport = modifier.show_render = True
    thing.update_tag()


class Detached:
    """While it lasts, bodies look as before the simulation: the modifier and those below it are off."""

    def __init__(self, things):
        self.off = []
        for thing in things:
            names = [modifier.name for modifier in thing.modifiers]
            own = find_modifier(thing)
            if own:
                self.off += [(thing, name) for name in names[names.index(own.name):] if thing.modifiers[name].show_viewport]

    def __enter__(self):
        for thing, name in self.off:
            thing.modifiers[name].show_viewport = False
        return self

    def __exit__(self, *_):
        for thing, name in self.off:
            thing.modifiers[name].show_viewport = True
