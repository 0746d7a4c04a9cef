"""Installs the add-on of the zip as people do, and makes the scenes of the tests."""
import math
import os
import sys

import bpy
import numpy

OUT = os.environ["SPRUNG_OUT"]


def install():
    bpy.ops.preferences.addon_install(filepath=os.path.join(OUT, "sprung_blender.zip"))
    bpy.ops.preferences.addon_enable(module="sprung")
    return sys.modules["sprung"]


def empty_scene(folder, frames, rate=24):
    """A scene without objects, whose files are in a folder of their own."""
    scene = bpy.context.scene
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    scene.frame_start, scene.frame_end, scene.render.fps = 1, frames, rate
    scene.unit_settings.system, scene.unit_settings.scale_length = "METRIC", 1.0
    scene.gravity = 0.0, 0.0, -9.81
    scene.sprung.folder = os.path.join(OUT, folder)
    scene.sprung.wind = 0.0, 0.0, 0.0
    scene.sprung.gust_speed = 0.0
    scene.sprung.quality, scene.sprung.push_out = "NORMAL", True
    scene.frame_set(1)
    return scene


def add_object(name, vertices, faces=(), edges=(), role="NONE"):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(vertex) for vertex in vertices], [tuple(edge) for edge in edges], [tuple(face) for face in faces])
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    thing.sprung.role = role
    return thing


def grid(columns, rows, size):
    """Vertices and faces of a grid in the x-y plane, centred."""
    vertices = [(size * (i / (columns - 1) - 0.5), size * (j / (rows - 1) - 0.5), 0.0) for j in range(rows) for i in range(columns)]
    faces = [(j * columns + i, j * columns + i + 1, (j + 1) * columns + i + 1, (j + 1) * columns + i)
             for j in range(rows - 1) for i in range(columns - 1)]
    return vertices, faces


def tube(sides, rows, radius_at, heights):
    """Vertices and faces of a surface of revolution about z, open at both ends."""
    vertices = [(radius_at(h) * math.cos(2 * math.pi * k / sides), radius_at(h) * math.sin(2 * math.pi * k / sides), h)
                for h in heights for k in range(sides)]
    faces = [(r * sides + k, r * sides + (k + 1) % sides, (r + 1) * sides + (k + 1) % sides, (r + 1) * sides + k)
             for r in range(rows - 1) for k in range(sides)]
    return vertices, faces


def ball(radius, sides=24, rows=13):
    """Vertices and faces of a closed ball about the origin."""
    inner = [math.pi * (k / (rows - 1)) for k in range(1, rows - 1)]
    vertices, faces = [(0, 0, -radius)], []
    for angle in inner:
        vertices += [(radius * math.sin(angle) * math.cos(2 * math.pi * k / sides),
                      radius * math.sin(angle) * math.sin(2 * math.pi * k / sides), -radius * math.cos(angle)) for k in range(sides)]
    vertices.append((0, 0, radius))
    faces += [(0, 1 + (k + 1) % sides, 1 + k) for k in range(sides)]
    for r in range(len(inner) - 1):
        faces += [(1 + r * sides + k, 1 + r * sides + (k + 1) % sides, 1 + (r + 1) * sides + (k + 1) % sides, 1 + (r + 1) * sides + k)
                  for k in range(sides)]
    last = 1 + (len(inner) - 1) * sides
    faces += [(last + k, last + (k + 1) % sides, len(vertices) - 1) for k in range(sides)]
    return vertices, faces


def add_group(thing, name, vertices):
    thing.vertex_groups.new(name=name).add(list(vertices), 1.0, "REPLACE")


def add_pin(thing, name, vertices, follow=None):
    add_group(thing, name, vertices)
    pin = thing.sprung.pins.add()
    pin.group, pin.follow = name, follow
    return pin


def drape(columns=21):
    """A grid above a sphere."""
    cloth = add_object("Grid", *grid(columns, columns, 1.0), role="CLOTH")
    cloth.location = 0.0, 0.0, 0.35
    sphere = add_object("Sphere", *ball(0.3), role="OBSTACLE")
    return cloth, sphere


def flag():
    """A flag, pinned at the side of the pole, in wind."""
    thing = add_object("Flag", *grid(16, 11, 1.0), role="CLOTH")
    thing.rotation_euler = math.pi / 2, 0.0, 0.0
    thing.location = 0.5, 0.0, 2.0
    thing.sprung.cloth_material = "silk"
    add_pin(thing, "Pole", range(0, 176, 16))
    bpy.context.scene.sprung.wind = 4.0, 1.0, 0.0
    return thing


def mannequin():
    """A body of revolution that an armature bends at the hip, and a skirt whose waist follows it."""
    heights = [k / 12 for k in range(13)]
    vertices, faces = tube(24, 13, lambda h: 0.10 + 0.10 * math.exp(-((h - 0.55) / 0.15) ** 2), heights)
    faces += [tuple(range(24))[::-1], tuple(range(12 * 24, 13 * 24))]
    figure = add_object("Mannequin", vertices, faces, role="OBSTACLE")
    armature = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    previous = None
    for name, bottom, top in (("Legs", 0.0, 0.5), ("Chest", 0.5, 1.0)):
        bone = armature.data.edit_bones.new(name)
        bone.head, bone.tail, bone.parent = (0, 0, bottom), (0, 0, top), previous
        previous = bone
    bpy.ops.object.mode_set(mode="OBJECT")
    for name, low, high in (("Legs", -1.0, 0.5), ("Chest", 0.5, 2.0)):
        add_group(figure, name, [k for k, vertex in enumerate(vertices) if low < vertex[2] <= high])
    figure.modifiers.new("Armature", "ARMATURE").object = armature
    hip = armature.pose.bones["Chest"]
    hip.rotation_mode = "XYZ"
    for frame, angle in ((1, 0.0), (24, 0.5)):
        hip.rotation_euler = angle, 0.3 * angle, 0.0
        hip.keyframe_insert("rotation_euler", frame=frame)
    skirt_heights = [0.62 - 0.06 * k for k in range(8)]
    skirt = add_object("Skirt", *tube(32, 8, lambda h: 0.24 + 0.4 * (0.62 - h), skirt_heights), role="CLOTH")
    skirt.sprung.cloth_material = "cotton"
    add_pin(skirt, "Waist", range(32), follow=figure)
    return figure, skirt


def evaluated(thing):
    """The vertices of an object as they are drawn, in the world."""
    drawn = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = drawn.to_mesh()
    found = numpy.empty(3 * len(mesh.vertices), "f4")
    mesh.vertices.foreach_get("co", found)
    matrix = numpy.array(drawn.matrix_world)
    drawn.to_mesh_clear()
    return found.reshape(-1, 3).astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
