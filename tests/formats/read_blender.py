"""Run by Blender: imports the OBJ and glTF files, lays the point caches over the OBJ mesh, and compares vertices with record.bin.
Arguments after --: the folder of a run, and that of its exports."""
import os
import sys
import traceback

import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from record import Record  # noqa: E402

# The importer of Debian's Blender 3.4 asks for a name that its NumPy 1.24 has no more.
numpy.bool = bool

ROUNDING = 2.0 ** -22  # of a float, through Blender's change of axes


def clear():
    bpy.ops.wm.read_factory_settings(use_empty=True)


def evaluated(thing):
    """The vertices of an object as they are drawn, in Sprung's axes: Y is up."""
    mesh = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    found = numpy.empty(3 * len(mesh.vertices), "f4")
    mesh.vertices.foreach_get("co", found)
    matrix = numpy.array(thing.matrix_world)
    world = found.reshape(-1, 3).astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
    return world[:, [0, 2, 1]] * [1.0, 1.0, -1.0]


def close(found, wanted, what):
    assert found.shape == wanted.shape, f"{what}: shape {found.shape}, expected {wanted.shape}"
    error = numpy.abs(found - wanted).max(initial=0.0)
    assert error <= ROUNDING * max(1.0, numpy.abs(wanted).max(initial=0.0)), f"{what}: off by {error}"


def import_obj(path):
    bpy.ops.wm.obj_import(filepath=path, forward_axis="NEGATIVE_Z", up_axis="Y")
    return bpy.context.selected_objects[0]


def check_caches(record, exports, name, wanted_in, frames):
    for ending in ("pc2", "mdd"):
        clear()
        thing = import_obj(f"{exports}/{name}.obj")
        close(evaluated(thing), wanted_in(1), f"{name}.obj")
        cache = thing.modifiers.new("cache", "MESH_CACHE")
        cache.cache_format = ending.upper()
        cache.filepath = os.path.abspath(f"{exports}/{name}.{ending}")
        cache.frame_start = 1.0
        cache.play_mode = "SCENE"
        for frame in frames:
            bpy.context.scene.frame_set(frame)
            close(evaluated(thing), wanted_in(frame), f"{name}.{ending}, frame {frame}")


def check(run, exports):
    record = Record(run)
    frames = sorted({1, (record.frames + 1) // 2, record.frames})
    for b, body in enumerate(record.bodies):
        check_caches(record, exports, body["name"], lambda frame, b=b: record.vertices(b, frame), frames)
    clear()
    bpy.context.scene.render.fps = round(1.0 / record.frame_array("time", 2)[0, 0]) if record.frames > 1 else 30
    bpy.ops.import_scene.gltf(filepath=f"{exports}/animation.glb", merge_vertices=False)
    things = {thing.name: thing for thing in bpy.context.scene.objects if thing.type == "MESH"}
    begin = record.frame_array("time", 1)[0, 0]
    for frame in frames:
        seconds = record.frame_array("time", frame)[0, 0] - begin
        bpy.context.scene.frame_set(round(seconds * bpy.context.scene.render.fps))
        for b, body in enumerate(record.bodies):
            found = evaluated(things[body["name"]])
            wanted = record.vertices(b, frame)
            close(found[:len(wanted)], wanted, f"{body['name']} in glTF, frame {frame}")  # copies for UVs come after
        for k, obstacle in enumerate(record.obstacles):
            close(evaluated(things[obstacle["name"]]), record.obstacle_vertices(k, frame), f"{obstacle['name']} in glTF, frame {frame}")
    print(f"{len(record.bodies)} bodies, {len(record.obstacles)} obstacles, frames {frames}: equal")


try:
    check(*sys.argv[sys.argv.index("--") + 1:][:2])
except BaseException:
    traceback.print_exc()
    sys.stdout.flush()
    os._exit(1)
