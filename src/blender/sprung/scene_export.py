"""Writes the objects of a Blender scene as a folder that `sprung run` takes: scene.json, and meshes as OBJ files."""
import json
import os
import re
import shutil

import bpy
import numpy

from . import axes as convert
from .axes import Axes
from .point_cache import Detached
from .settings import BODIES, LIMITED

SCENE_FILE = "scene.json"
LINKS_FILE = "blender.json"  # which object is which body, for those who read the frames
MESH_FOLDER = "meshes"

MOVED = 1e-6  # a vertex moves if its path is longer than this share of the mesh
PIN_WEIGHT = 0.5
MAX_STRETCH = {"DRAFT": 0.05, "FINE": 0.005}
MASS_SCALING = {"DRAFT": 0.05, "FINE": False}


class ExportError(Exception):
    """What Sprung cannot simulate, and the name of the object at fault, or None."""

    def __init__(self, text, name=None):
        super().__init__(text)
        self.name = name


def sprung_names(things):
    """Names for the scene file: letters, digits, _ and -, each once, and not those of folders of a run."""
    names, taken = {}, {"obstacles", "animation", "record", "checkpoint"}
    for thing in things:
        base = re.sub(r"[^A-Za-z0-9_-]+", "_", thing.name)[:150] or "object"
        name, number = base, 2
        while name.lower() in taken:
            name, number = f"{base}_{number}", number + 1
        taken.add(name.lower())
        names[thing.name] = name
    return names


def decimal(value):
    """A setting, which Blender keeps as a float, as a person wrote it: 9.81 instead of 9.8100004."""
    return [decimal(part) for part in value] if isinstance(value, list) else float(f"{value:.7g}")


def spread(points):
    return float(numpy.ptp(points, axis=0).max(initial=0.0)) if len(points) else 0.0


def write_json(path, value):
    """Indented, with lists of numbers in a line."""
    text = re.sub(r"\[\s+([-+0-9.e,\s]+?)\s+\]", lambda match: "[" + " ".join(match[1].split()) + "]", json.dumps(value, indent=1))
    with open(path, "w", encoding="ascii") as file:
        file.write(text + "\n")


def write_obj(path, vertices, faces=(), lines=()):
    """Faces and lines are lists of vertex numbers from 0."""
    rows = ["v %.9g %.9g %.9g" % tuple(vertex) for vertex in vertices.tolist()]
    rows += ["f " + " ".join(str(corner + 1) for corner in face) for face in faces]
    rows += ["l %d %d" % (a + 1, b + 1) for a, b in lines]
    with open(path, "w", encoding="ascii") as file:
        file.write("\n".join(rows) + "\n")


def chain_of(count, edges):
    """The vertices of a chain of edges from one end to the other; None if the edges are no single open chain."""
    near = [[] for _ in range(count)]
    for a, b in edges:
        near[a].append(b)
        near[b].append(a)
    ends = [vertex for vertex in range(count) if len(near[vertex]) == 1]
    if len(ends) != 2 or len(edges) != count - 1 or any(len(others) > 2 for others in near):
        return None
    chain, last = [ends[0]], None
    while len(chain) < count:
        following = [vertex for vertex in near[chain[-1]] if vertex != last]
        if not following:
            return None
        last = chain[-1]
        chain.append(following[0])
    return chain


class Sample:
    """An object as it is in the current frame, with its modifiers."""

    def __init__(self, thing, depsgraph, topology=False, groups=()):
        evaluated = thing.evaluated_get(depsgraph)
        mesh = evaluated.to_mesh()
        try:
            self.matrix = numpy.array(evaluated.matrix_world, float)
            found = numpy.empty(3 * len(mesh.vertices), "f4")
            mesh.vertices.foreach_get("co", found)
            self.vertices = found.reshape(-1, 3).astype(float)
            if topology:
                mesh.calc_loop_triangles()
                self.edges = [tuple(edge.vertices) for edge in mesh.edges]
                self.loose = [tuple(edge.vertices) for edge in mesh.edges if edge.is_loose]
                self.faces = [tuple(face.vertices) for face in mesh.polygons]
                self.triangles = [tuple(triangle.vertices) for triangle in mesh.loop_triangles]
            self.groups = {}
            for name in groups:
                group = thing.vertex_groups.get(name)
                self.groups[name] = [] if group is None else [
                    vertex.index for vertex in mesh.vertices
                    if any(own.group == group.index and own.weight >= PIN_WEIGHT for own in vertex.groups)]
        finally:
            evaluated.to_mesh_clear()

    def world(self):
        return convert.to_world(self.matrix, self.vertices)


def rigid_motion(axes, matrices, rate):
    """Keyframes relative to the first matrix, or None if the object does not move. Raises ValueError if it is not rigid."""
    first = matrices[0]
    keyframes, angles = [], [0.0, 0.0, 0.0]
    for number, matrix in enumerate(matrices):
        rotation = convert.rotation_between(convert.linear(first), convert.linear(matrix))
        if rotation is None:
            raise ValueError("the matrices differ by more than a rotation")
        angles = convert.sprung_angles(rotation, angles)
        moved = axes.vector(convert.translation(matrix) - convert.translation(first))
        keyframes.append({"time": number / rate, "position": moved, "rotation": angles})
    if all(numpy.allclose(matrix, first, rtol=0.0, atol=1e-7) for matrix in matrices):
        return None
    return {"keyframes": keyframes}


class ObstacleExport:
    """Collects an obstacle frame by frame: a mesh at rest, a rigid motion, or a sequence of meshes."""

    def __init__(self, thing, name, folder, axes):
        self.thing, self.name, self.folder, self.axes = thing, name, folder, axes
        self.first = None
        self.matrices = []
        self.files = 0  # of the sequence

    def add(self, depsgraph):
        sample = Sample(self.thing, depsgraph, topology=self.first is None)
        if self.first is None:
            if not sample.triangles:
                raise ExportError("the obstacle has no faces", self.thing.name)
            self.first = sample
            mirrored = convert.is_mirrored(sample.matrix)
            self.faces = [face[::-1] for face in sample.triangles] if mirrored else sample.triangles
        if len(sample.vertices) != len(self.first.vertices):
            raise ExportError(f"the number of vertices changes from {len(self.first.vertices)} to {len(sample.vertices)}: keep the "
                              "modifiers that make it from changing with time", self.thing.name)
        deforms = numpy.abs(sample.vertices - self.first.vertices).max() > MOVED * spread(self.first.vertices)
        if deforms or self.files:
            self.write_rest_as_sequence()
            self.write_frame(sample.world())
        self.matrices.append(sample.matrix)

    def write_rest_as_sequence(self):
        """The frames so far, which have the vertices of the first."""
        for matrix in self.matrices[self.files:]:
            self.write_frame(convert.to_world(matrix, self.first.vertices))

    def write_frame(self, world):
        self.files += 1
        folder = os.path.join(self.folder, MESH_FOLDER, self.name)
        os.makedirs(folder, exist_ok=True)
        write_obj(os.path.join(folder, f"{self.name}.{self.files:04}.obj"), self.axes.points(world), self.faces)

    def describe(self, rate):
        """The obstacle's object of scene.json."""
        motion = None
        if not self.files:
            try:
                motion = rigid_motion(self.axes, self.matrices, rate)
            except ValueError:
                self.write_rest_as_sequence()
        settings = self.thing.sprung
        described = {}
        if self.files > 1:
            described["shape"] = {"type": "sequence", "files": f"{MESH_FOLDER}/{self.name}/{self.name}.*.obj"}
        else:
            origin = convert.translation(self.first.matrix)
            file = f"{MESH_FOLDER}/{self.name}.obj"
            write_obj(os.path.join(self.folder, file), self.axes.points(self.first.world() - origin), self.faces)
            described["shape"] = {"type": "mesh", "file": file}
            described["place"] = {"position": self.axes.vector(origin)}
            if motion:
                described["motion"] = motion
        described["friction"] = decimal(settings.friction)
        described["thickness"] = decimal(settings.obstacle_thickness * self.axes.metres)
        return described


class BodyExport:
    """Collects a body: its mesh in the first frame, and the paths of pinned vertices."""

    def __init__(self, thing, name, folder, axes):
        self.thing, self.name, self.folder, self.axes = thing, name, folder, axes
        self.first = None
        self.matrices = []
        self.paths = [[] for _ in thing.sprung.pins]  # of the pinned vertices of each pin, in the world

    def add(self, depsgraph):
        settings = self.thing.sprung
        groups = {pin.group for pin in settings.pins} | {attachment.group for attachment in settings.attachments}
        if self.first is None:
            sample = Sample(self.thing, depsgraph, topology=True, groups=groups)
            self.first = sample
            self.check(groups)
        else:
            sample = Sample(self.thing, depsgraph)
            if self.thing.sprung.pins and len(sample.vertices) != len(self.first.vertices):
                raise ExportError("the number of vertices changes with time, above the modifier Sprung", self.thing.name)
        self.matrices.append(sample.matrix)
        for pin, path in zip(settings.pins, self.paths):
            if not pin.follow:
                path.append(convert.to_world(sample.matrix, sample.vertices[self.first.groups[pin.group]]))

    def check(self, groups):
        if not self.first.edges:
            raise ExportError("the mesh has no edges", self.thing.name)
        for name in groups:
            if not name:
                raise ExportError("choose a vertex group for each pin and attachment", self.thing.name)
            if not self.first.groups[name]:
                raise ExportError(f"no vertex of the group \"{name}\" has a weight of at least {PIN_WEIGHT}", self.thing.name)

    def shape(self):
        """The shape in scene.json, and the Blender vertex of each particle."""
        role = self.thing.sprung.role
        points = self.axes.points(self.first.world() - convert.translation(self.first.matrix))
        order = list(range(len(points)))
        if role == "ROPE":
            chain = chain_of(len(points), self.first.edges)
            if chain:
                return {"type": "rope", "points": points[chain].tolist()}, chain
        elif not self.first.faces:
            raise ExportError(f"a {role.lower()} needs faces", self.thing.name)
        file = f"{MESH_FOLDER}/{self.name}.obj"
        faces = [] if role == "ROPE" else self.first.faces
        if convert.is_mirrored(self.first.matrix):
            faces = [face[::-1] for face in faces]
        lines = {"ROPE": self.first.edges, "CLOTH": self.first.loose, "LATTICE": []}[role]
        write_obj(os.path.join(self.folder, file), points, faces, lines)
        if role == "LATTICE":
            return {"type": "lattice", "file": file, "cells": self.thing.sprung.cells}, order
        return {"type": "mesh", "file": file}, order

    def indices(self, group):
        """Particles of a vertex group."""
        return sorted(self.particle_of[vertex] for vertex in self.first.groups[group])

    def describe(self, rate, first_frame, names):
        settings = self.thing.sprung
        shape, self.order = self.shape()
        self.particle_of = {vertex: particle for particle, vertex in enumerate(self.order)}
        described = {"shape": shape, "material": settings.material(),
                     "place": {"position": self.axes.vector(convert.translation(self.first.matrix))}}
        if settings.role != "LATTICE":
            described["self_contact"] = settings.self_contact
        if settings.role == "CLOTH" and settings.pressure:
            described["pressure"] = decimal(settings.pressure)
        if shape["type"] == "rope" and settings.diameter:
            described["diameter"] = decimal(settings.diameter * self.axes.metres)
        if settings.sets_thickness:
            described["thickness"] = decimal(settings.thickness * self.axes.metres)
        if settings.sets_friction:
            described["friction"] = decimal(settings.friction)
        pins = []
        for pin, path in zip(settings.pins, self.paths):
            pins += self.describe_pin(pin, path, rate, first_frame, names)
        if pins:
            described["pins"] = pins
        return described

    def describe_pin(self, pin, path, rate, first_frame, names):
        common = {}
        if pin.releases:
            if pin.release_frame <= first_frame:
                raise ExportError(f"the pin of \"{pin.group}\" lets go at frame {pin.release_frame}, which is not after the first "
                                  f"frame, {first_frame}", self.thing.name)
            common["until"] = (pin.release_frame - first_frame) / rate
        if pin.follow:
            if pin.follow.name not in names or pin.follow.sprung.role != "OBSTACLE":
                raise ExportError(f"the pin of \"{pin.group}\" follows \"{pin.follow.name}\", which is no obstacle of Sprung",
                                  self.thing.name)
            return [{"indices": self.indices(pin.group), "follow": names[pin.follow.name], **common}]
        path = numpy.array(path)
        if numpy.abs(path - path[0]).max() <= MOVED * max(spread(path[0]), spread(self.first.world())):
            return [{"indices": self.indices(pin.group), **common}]
        motion = self.motion_of_object(path, rate)
        if motion:
            return [{"indices": self.indices(pin.group), "motion": motion, **common}]
        pins = []  # a path for each vertex
        for k, vertex in enumerate(self.first.groups[pin.group]):
            moved = self.axes.points(path[:, k] - path[0, k]).tolist()
            keyframes = [{"time": number / rate, "position": position} for number, position in enumerate(moved)]
            pins.append({"indices": [self.particle_of[vertex]], "motion": {"keyframes": keyframes}, **common})
        return pins

    def motion_of_object(self, path, rate):
        """The motion of the object, if the pinned vertices move with it rigidly; else None."""
        try:
            motion = rigid_motion(self.axes, self.matrices, rate)
        except ValueError:
            return None
        local = convert.to_local(self.matrices[0], path[0])
        carried = numpy.array([convert.to_world(matrix, local) for matrix in self.matrices])
        return motion if motion and numpy.abs(carried - path).max() <= 1e-5 * max(1.0, spread(path.reshape(-1, 3))) else None

    def describe_attachments(self, names):
        described = []
        for attachment in self.thing.sprung.attachments:
            target = attachment.target
            if not target or target.name not in names or target == self.thing:
                raise ExportError(f"the attachment of \"{attachment.group}\" needs another body or obstacle of Sprung",
                                  self.thing.name)
            kind = "obstacle" if target.sprung.role == "OBSTACLE" else "body"
            one = {"first": {"body": self.name, "indices": self.indices(attachment.group)}, "second": {kind: names[target.name]}}
            if attachment.stiffness:
                one["stiffness"] = decimal(attachment.stiffness)
            if attachment.break_force:
                one["break_force"] = decimal(attachment.break_force)
            described.append(one)
        return described

    def link(self):
        """What the frames need to become those of the object."""
        still = all(numpy.array_equal(matrix, self.matrices[0]) for matrix in self.matrices)
        matrices = self.matrices[:1] if still else self.matrices
        return {"object": self.thing.name, "order": self.order, "matrices": [matrix.tolist() for matrix in matrices]}


class SceneExport:
    """The export of a scene into a folder. `steps` is a generator, so that an interface can show how far it is."""

    def __init__(self, scene, view_layer, folder):
        self.scene, self.view_layer, self.folder = scene, view_layer, folder
        self.axes = Axes.of_scene(scene)
        self.rate = scene.render.fps / scene.render.fps_base
        view_layer.update()  # else it lacks objects that a script has just added
        things = [thing for thing in view_layer.objects if thing.type == "MESH" and thing.sprung.role != "NONE"]
        things.sort(key=lambda thing: thing.name)
        self.names = sprung_names(things)
        self.bodies = [self.part(BodyExport, thing) for thing in things if thing.sprung.role in BODIES]
        self.obstacles = [self.part(ObstacleExport, thing) for thing in things if thing.sprung.role == "OBSTACLE"]

    def part(self, kind, thing):
        return kind(thing, self.names[thing.name], self.folder, self.axes)

    def steps(self):
        """Yields the number of frames that are exported, and of all. Raises ExportError."""
        if not self.bodies:
            raise ExportError("no object is a cloth, a rope or a lattice: choose a type in the object properties, panel Sprung")
        for part in self.bodies + self.obstacles:
            if not part.thing.visible_get(view_layer=self.view_layer):
                raise ExportError("the object is hidden, so Blender does not compute how it moves: show it, or set its type to None",
                                  part.thing.name)
        self.clear_folder()
        frames = range(self.scene.frame_start, self.scene.frame_end + 1)
        shown = self.scene.frame_current, self.scene.frame_subframe
        try:
            with Detached([body.thing for body in self.bodies]):
                for number, frame in enumerate(frames, 1):
                    self.scene.frame_set(frame)
                    depsgraph = bpy.context.evaluated_depsgraph_get()
                    for part in self.bodies + self.obstacles:
                        part.add(depsgraph)
                    yield number, len(frames)
        finally:
            self.scene.frame_set(shown[0], subframe=shown[1])
        self.write(len(frames))

    def clear_folder(self):
        """Removes the meshes of an earlier export, and no file of anyone else."""
        meshes = os.path.join(self.folder, MESH_FOLDER)
        if os.path.exists(meshes):
            if not os.path.exists(os.path.join(self.folder, LINKS_FILE)):
                raise ExportError(f"{meshes} exists and no export of this add-on made it; choose another folder")
            shutil.rmtree(meshes)
        os.makedirs(meshes)
        self.write_links({})  # marks the folder as ours

    def write_links(self, bodies):
        links = {"scene": self.scene.name, "first_frame": self.scene.frame_start, "metres": self.axes.metres, "bodies": bodies,
                 "obstacles": {part.name: part.thing.name for part in self.obstacles},
                 "attachments": [body.thing.name for body in self.bodies for _ in body.thing.sprung.attachments]}
        write_json(os.path.join(self.folder, LINKS_FILE), links)

    def write(self, frames):
        write_json(os.path.join(self.folder, SCENE_FILE), self.describe(frames))
        self.write_links({body.name: body.link() for body in self.bodies})

    def describe(self, frames):
        settings = self.scene.sprung
        gravity = decimal(self.axes.vector(self.scene.gravity)) if self.scene.use_gravity else [0.0, 0.0, 0.0]
        described = {"version": 1, "duration": (frames - 1) / self.rate, "frame_rate": self.rate, "gravity": gravity,
                     "contact": {"start": "push_out" if settings.push_out else "refuse"}}
        air = {}
        if any(settings.wind):
            air["wind"] = decimal(self.axes.vector(settings.wind))
        if settings.gust_speed:
            air["gusts"] = {"speed": decimal(settings.gust_speed * self.axes.metres),
                            "length": decimal(settings.gust_length * self.axes.metres)}
        if air:
            described["air"] = air
        if settings.quality in MAX_STRETCH:
            described["mass_scaling"] = MASS_SCALING[settings.quality]
            limited = [body.name for body in self.bodies if body.thing.sprung.material() in LIMITED]
            if limited:
                described["stretch_limit"] = {"max_stretch": MAX_STRETCH[settings.quality], "bodies": limited}
        described["bodies"] = {body.name: body.describe(self.rate, self.scene.frame_start, self.names) for body in self.bodies}
        described["obstacles"] = {part.name: part.describe(self.rate) for part in self.obstacles}
        attachments = [one for body in self.bodies for one in body.describe_attachments(self.names)]
        if attachments:
            described["attachments"] = attachments
        return described
