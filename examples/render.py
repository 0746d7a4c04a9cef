"""Run by Blender: renders frames of a run with Cycles. Called by render.sh, which explains the options."""
import argparse
import glob
import json
import math
import os
import re
import sys
import traceback

import bmesh
import bpy
import mathutils
import numpy

SEED = 0
FLOOR = (0.80, 0.79, 0.77)
HORIZON = (0.93, 0.94, 0.96)
STONE = (0.30, 0.29, 0.28)

# Colour, roughness, sheen, weave and size of its threads [m], larger than real ones so that one sees them; depth of the weave [1].
FABRICS = {
    "cotton": dict(color=(0.50, 0.075, 0.04), roughness=0.85, sheen=0.4, weave="plain", thread=0.006, depth=0.35),
    "silk": dict(color=(0.02, 0.24, 0.27), roughness=0.28, sheen=0.2, specular=0.7, weave="plain", thread=0.002, depth=0.02),
    "wool": dict(color=(0.42, 0.30, 0.16), roughness=1.0, sheen=0.3, weave="twill", thread=0.009, depth=0.5),
    "denim": dict(color=(0.045, 0.085, 0.22), second=(0.13, 0.19, 0.33), roughness=0.9, sheen=0.2, weave="twill", thread=0.005, depth=0.4),
    "jersey": dict(color=(0.34, 0.36, 0.40), roughness=0.95, sheen=0.6, weave="plain", thread=0.008, depth=0.3),
    "leather": dict(color=(0.16, 0.06, 0.025), roughness=0.45, weave="grain", thread=0.012, depth=0.3),
    "felt": dict(color=(0.06, 0.24, 0.10), roughness=1.0, sheen=1.0, weave="noise", thread=0.004, depth=0.3),
    "paper": dict(color=(0.88, 0.86, 0.80), roughness=0.7, weave="noise", thread=0.003, depth=0.06, flat=True),
    "rubber_sheet": dict(color=(0.02, 0.021, 0.024), roughness=0.32, specular=0.6, weave="none"),
    "hemp": dict(color=(0.45, 0.31, 0.15), roughness=0.95, sheen=0.5, weave="none"),
    "nylon": dict(color=(0.05, 0.20, 0.55), roughness=0.4, weave="none"),
    "steel_cable": dict(color=(0.55, 0.56, 0.58), roughness=0.3, metallic=1.0, weave="none"),
    "hair": dict(color=(0.07, 0.035, 0.015), roughness=0.4, weave="none"),
    "soft_jelly": dict(color=(0.75, 0.06, 0.10), roughness=0.12, glow=0.25, weave="none"),
    "firm_jelly": dict(color=(0.85, 0.38, 0.03), roughness=0.18, glow=0.2, weave="none"),
    "foam": dict(color=(0.85, 0.72, 0.36), roughness=1.0, weave="noise", thread=0.006, depth=0.5),
    "rubber_block": dict(color=(0.03, 0.03, 0.035), roughness=0.5, weave="none"),
}
# Of bodies without a material, one after the other.
COLORS = [(0.45, 0.055, 0.03), (0.03, 0.14, 0.32), (0.62, 0.34, 0.04), (0.06, 0.24, 0.12), (0.28, 0.08, 0.26)]


def arguments():
    parser = argparse.ArgumentParser(prog="render.sh", usage="render.sh DIR [OPTION...] [FRAME...]")
    parser.add_argument("folder")
    parser.add_argument("frames", nargs="*", type=int, metavar="FRAME")
    parser.add_argument("--pictures", required=True)
    parser.add_argument("--size", default="960x720")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--camera", default="")
    parser.add_argument("--azimuth", type=float, default=30.0)
    parser.add_argument("--elevation", type=float, default=18.0)
    parser.add_argument("--zoom", type=float, default=1.0)
    parser.add_argument("--hide", default="")
    parser.add_argument("--obstacles", default="")
    parser.add_argument("--radius", type=float, default=0.0)
    parser.add_argument("--threads", type=int, default=0)
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:])


def kind_of(name):
    """The name without number, letter or side; bodies of one kind get one colour."""
    return re.sub(r"(\d+|[_-]([a-z]|left|right|east|west|north|south|front|back))$", "", name, flags=re.IGNORECASE).rstrip("_-")


def numbers_of(text, count, option, example, separator=","):
    """The numbers of an option. Exits if they are not so many."""
    try:
        numbers = [float(word) for word in text.split(separator)]
    except ValueError:
        numbers = []
    if len(numbers) != count or not all(map(math.isfinite, numbers)):
        raise SystemExit(f"render.sh: {option} {text}: must be {count} numbers, as in {example}")
    return numbers


def linear(color):
    """#RRGGBB as Blender has colours."""
    if not re.fullmatch(r"#[0-9a-fA-F]{6}", color):
        raise SystemExit(f"render.sh: --obstacles {color}: not a colour; write it as #RRGGBB")
    return mathutils.Color(int(color[k:k + 2], 16) / 255.0 for k in (1, 3, 5)).from_srgb_to_scene_linear()


def to_blender(points):
    """Y up to Z up."""
    return points[:, [0, 2, 1]] * [1.0, -1.0, 1.0]


class Shape:
    """Vertices (Z up), faces and lines of an OBJ file."""

    def __init__(self, path):
        vertices, self.faces, self.lines = [], [], []
        with open(path, encoding="utf-8", errors="replace") as file:
            for line in file:
                words = line.split()
                if not words:
                    continue
                if words[0] == "v":
                    vertices.append(words[1:4])
                elif words[0] == "f":
                    self.faces.append([int(word.split("/")[0]) - 1 for word in words[1:]])
                elif words[0] == "l":
                    chain = [int(word.split("/")[0]) - 1 for word in words[1:]]
                    self.lines += list(zip(chain[:-1], chain[1:]))
        self.vertices = to_blender(numpy.array(vertices, float).reshape(-1, 3))


def files_of(folder):
    """The files of a sequence by frame."""
    found = {}
    for path in glob.glob(os.path.join(glob.escape(folder), "*.obj")):
        number = re.search(r"\.(\d+)\.obj$", path)
        if number:
            found[int(number[1])] = path
    return found


class Run:
    """The folder of a run: bodies and obstacles, each a file or a file for each frame."""

    def __init__(self, folder, hidden):
        with open(os.path.join(folder, "run.json"), encoding="utf-8") as file:
            self.scene = json.load(file)["scene"]
        for name in hidden:
            if name not in self.scene["bodies"] and name not in self.scene.get("obstacles", {}):
                raise SystemExit(f"render.sh: --hide {name}: no such body or obstacle")
        self.bodies = {name: files_of(os.path.join(folder, name)) for name in self.scene["bodies"] if name not in hidden}
        if not all(self.bodies.values()):
            raise SystemExit(f"render.sh: {folder} has no OBJ files of a body; make them with: sprung export {folder} --format obj")
        if not self.bodies:
            raise SystemExit("render.sh: --hide: no body is left to show")
        self.frames = sorted(set.intersection(*(set(files) for files in self.bodies.values())))
        self.obstacles = {}
        for name in self.scene.get("obstacles", {}):
            sequence = files_of(os.path.join(folder, "obstacles", name))
            if name not in hidden and not self.is_floor(name):
                self.obstacles[name] = sequence or {0: os.path.join(folder, "obstacles", name + ".obj")}
                if not all(os.path.isfile(path) for path in self.obstacles[name].values()):
                    raise SystemExit(f"render.sh: {folder} has no OBJ file of obstacle {name}; make it with: sprung export {folder} --format obj")

    def is_floor(self, name):
        """A half-space that looks straight up: the floor of the picture stands for it."""
        shape = self.scene["obstacles"][name]["shape"]
        normal = shape.get("normal", [0, 1, 0])
        return shape["type"] == "half_space" and normal[1] > 0 and abs(normal[0]) + abs(normal[2]) < 1e-9 * normal[1]

    def floors(self):
        """Heights [m] of such obstacles."""
        heights = []
        for name, obstacle in self.scene.get("obstacles", {}).items():
            if self.is_floor(name):
                heights.append(obstacle["shape"].get("offset", 0.0) + obstacle.get("place", {}).get("position", [0, 0, 0])[1])
        return heights

    def shape(self, files, frame):
        return Shape(files[frame] if frame in files else files[max(files)])

    def points(self, frames):
        """What the camera has to show."""
        found = [self.shape(files, frame).vertices for frame in frames for files in self.bodies.values()]
        found += [self.shape(files, frame).vertices for files in self.obstacles.values() for frame in (frames[0], frames[-1])]
        return numpy.concatenate(found)


def quads_of(faces):
    """Faces of a cloth of a scene: the two triangles of each cell become one face again."""
    joined, k = [], 0
    while k < len(faces):
        following = faces[k + 1] if k + 1 < len(faces) else []
        if len(faces[k]) == 3 and len(following) == 3 and len(set(faces[k]) & set(following)) == 2:
            first, second = faces[k], following
            lone = next(corner for corner in second if corner not in first)
            at = next(i for i in range(3) if first[i] in second and first[(i + 1) % 3] in second)
            joined.append(first[:at + 1] + [lone] + first[at + 1:])
            k += 2
        else:
            joined.append(faces[k])
            k += 1
    return joined


def new_object(name, data, collection):
    thing = bpy.data.objects.new(name, data)
    collection.objects.link(thing)
    return thing


def mesh_object(name, shape, faces, rest, collection):
    """A smooth mesh. Its UVs are lengths [m] in the first frame, where a cloth is mostly flat."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(shape.vertices.tolist(), [], faces)
    mesh.validate()
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    corners = numpy.empty(len(mesh.loops), "i4")
    mesh.loops.foreach_get("vertex_index", corners)
    totals = numpy.empty(len(mesh.polygons), "i4")
    mesh.polygons.foreach_get("loop_total", totals)
    mesh.uv_layers.new(name="rest").data.foreach_set("uv", rest_uv(rest.vertices, corners, totals).ravel())
    return new_object(name, mesh, collection)


def rest_uv(vertices, corners, totals):
    """For each corner of a face its place [m] in the plane of the cloth, or in the coordinate plane that is nearest to the face."""
    begins = numpy.cumsum(totals) - totals
    a, b, c = (vertices[corners[begins + k]] for k in range(3))
    normals = numpy.cross(b - a, c - a)
    mean = normals.sum(0)
    if numpy.linalg.norm(mean) > 0.9 * numpy.linalg.norm(normals, axis=1).sum():
        first = numpy.cross(mean, [0.0, 0.0, 1.0] if abs(mean[2]) < 0.9 * numpy.linalg.norm(mean) else [0.0, 1.0, 0.0])
        second = numpy.cross(mean, first)
        axes = numpy.stack([first / numpy.linalg.norm(first), second / numpy.linalg.norm(second)], 1)
        return vertices[corners] @ axes
    along = numpy.abs(normals).argmax(1).repeat(totals)
    keep = numpy.array([[1, 2], [0, 2], [0, 1]])[along]
    return numpy.take_along_axis(vertices[corners], keep, 1)


def tubes(name, shape, radius, material, beads, collection):
    """Lines as round ropes; with beads they are masses on springs."""
    curve = bpy.data.curves.new(name, "CURVE")
    curve.dimensions, curve.bevel_depth, curve.bevel_resolution, curve.use_fill_caps = "3D", radius, 4, True
    for chain in chains_of(shape.lines):
        spline = curve.splines.new("POLY")
        spline.points.add(len(chain) - 1)
        spline.points.foreach_set("co", numpy.c_[shape.vertices[chain], numpy.ones(len(chain))].ravel())
        spline.use_smooth = True
    new_object(name, curve, collection).data.materials.append(material)
    if beads:
        for point in shape.vertices:
            ball = bpy.data.meshes.new(name)
            add_ball(ball, 2.5 * radius)
            ball.materials.append(material)
            new_object(name, ball, collection).location = point


def add_ball(mesh, radius):
    made = bmesh.new()
    bmesh.ops.create_uvsphere(made, u_segments=32, v_segments=16, radius=radius)
    made.to_mesh(mesh)
    made.free()
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))


def chains_of(lines):
    """Consecutive lines that share an end, as chains."""
    chains = []
    for a, b in lines:
        if chains and chains[-1][-1] == a:
            chains[-1].append(b)
        else:
            chains.append([a, b])
    return chains


class Nodes:
    """Makes the nodes of a material."""

    def __init__(self, name):
        self.material = bpy.data.materials.new(name)
        self.material.use_nodes = True
        self.tree = self.material.node_tree
        self.surface = self.tree.nodes["Principled BSDF"]

    def add(self, kind, **values):
        node = self.tree.nodes.new(kind)
        for name, value in values.items():
            setattr(node, name, value)
        return node

    def link(self, output, target):
        self.tree.links.new(output, target)

    def math(self, operation, a, b=0.0):
        node = self.add("ShaderNodeMath", operation=operation)
        for socket, value in zip(node.inputs, (a, b)):
            if isinstance(value, (int, float)):
                socket.default_value = value
            else:
                self.link(value, socket)
        return node.outputs[0]


def weave_height(nodes, kind, thread):
    """The height of the weave, from 0 to 1, by the place in the cloth."""
    place = nodes.add("ShaderNodeUVMap", uv_map="rest").outputs[0]
    if kind in ("noise", "grain"):
        texture = nodes.add("ShaderNodeTexNoise" if kind == "noise" else "ShaderNodeTexVoronoi")
        texture.inputs["Scale"].default_value = 1.0 / thread
        nodes.link(place, texture.inputs["Vector"])
        return texture.outputs["Fac" if kind == "noise" else "Distance"]
    parts = nodes.add("ShaderNodeSeparateXYZ")
    nodes.link(place, parts.inputs[0])
    u = nodes.math("MULTIPLY", parts.outputs[0], math.pi / thread)
    v = nodes.math("MULTIPLY", parts.outputs[1], math.pi / thread)
    if kind == "twill":
        wave = nodes.math("SINE", nodes.math("ADD", u, nodes.math("MULTIPLY", v, 0.6)))
    else:
        wave = nodes.math("MULTIPLY", nodes.math("SINE", u), nodes.math("SINE", v))
    return nodes.math("ADD", nodes.math("MULTIPLY", wave, 0.5), 0.5)


def body_material(name, preset, color):
    look = FABRICS.get(preset, dict(color=color, roughness=0.8, sheen=0.3, weave="none"))
    nodes = Nodes(name)
    base = (*look["color"], 1.0)
    values = {"Base Color": base, "Roughness": look["roughness"], "Sheen": look.get("sheen", 0.0), "Metallic": look.get("metallic", 0.0),
              "Specular": look.get("specular", 0.3), "Subsurface": look.get("glow", 0.0), "Subsurface Color": base}
    for key, value in values.items():
        nodes.surface.inputs[key].default_value = value
    nodes.surface.inputs["Subsurface Radius"].default_value = (0.05, 0.02, 0.02)
    if look["weave"] != "none":
        height = weave_height(nodes, look["weave"], look["thread"])
        bump = nodes.add("ShaderNodeBump")
        bump.inputs["Strength"].default_value = look["depth"]
        bump.inputs["Distance"].default_value = 0.3 * look["thread"]
        nodes.link(height, bump.inputs["Height"])
        nodes.link(bump.outputs[0], nodes.surface.inputs["Normal"])
        mix = nodes.add("ShaderNodeMixRGB")
        mix.inputs[1].default_value = tuple(channel * (1.0 - 0.5 * look["depth"]) for channel in look["color"]) + (1.0,)
        mix.inputs[2].default_value = (*look.get("second", look["color"]), 1.0)
        nodes.link(height, mix.inputs[0])
        nodes.link(mix.outputs[0], nodes.surface.inputs["Base Color"])
    return nodes.material


def plain_material(name, color, roughness):
    nodes = Nodes(name)
    nodes.surface.inputs["Base Color"].default_value = (*color, 1.0)
    nodes.surface.inputs["Roughness"].default_value = roughness
    nodes.surface.inputs["Specular"].default_value = 0.25
    return nodes.material


def floor_material(extent):
    """A floor that fades into the light of the horizon."""
    nodes = Nodes("floor")
    nodes.surface.inputs["Base Color"].default_value = (*FLOOR, 1.0)
    nodes.surface.inputs["Roughness"].default_value = 0.9
    nodes.surface.inputs["Specular"].default_value = 0.1
    length = nodes.add("ShaderNodeVectorMath", operation="LENGTH")
    nodes.link(nodes.add("ShaderNodeTexCoord").outputs["Object"], length.inputs[0])
    fade = nodes.add("ShaderNodeMapRange", interpolation_type="SMOOTHSTEP")
    fade.inputs["From Min"].default_value, fade.inputs["From Max"].default_value = 0.7 * extent, 3.0 * extent
    nodes.link(length.outputs["Value"], fade.inputs["Value"])
    sky = nodes.add("ShaderNodeEmission")
    sky.inputs["Color"].default_value = (*HORIZON, 1.0)
    mix = nodes.add("ShaderNodeMixShader")
    nodes.link(fade.outputs[0], mix.inputs[0])
    nodes.link(nodes.surface.outputs[0], mix.inputs[1])
    nodes.link(sky.outputs[0], mix.inputs[2])
    nodes.link(mix.outputs[0], nodes.tree.nodes["Material Output"].inputs["Surface"])
    return nodes.material


def add_floor(height, center, extent):
    mesh = bpy.data.meshes.new("floor")
    far = 40.0 * extent
    mesh.from_pydata([(-far, -far, 0), (far, -far, 0), (far, far, 0), (-far, far, 0)], [], [(0, 1, 2, 3)])
    mesh.materials.append(floor_material(extent))
    new_object("floor", mesh, bpy.context.scene.collection).location = (*center[:2], height)


def add_light(center, direction, distance, size, power):
    data = bpy.data.lights.new("light", "AREA")
    data.size, data.energy = size, power
    thing = new_object("light", data, bpy.context.scene.collection)
    toward = mathutils.Vector(direction).normalized()
    thing.location = mathutils.Vector(center) + toward * distance
    thing.rotation_euler = toward.to_track_quat("Z", "Y").to_euler()


def add_lights(center, extent, azimuth):
    """A large key light beside the camera, a weak one across, and one from behind that draws edges."""
    def around(degrees, up):
        angle = math.radians(azimuth + degrees)
        return math.sin(angle), -math.cos(angle), up
    unit = extent * extent  # so that a scene of any size is lit alike
    add_light(center, around(-60, 1.1), 2.2 * extent, 0.9 * extent, 40.0 * unit)
    add_light(center, around(75, 0.5), 2.6 * extent, 2.0 * extent, 4.0 * unit)
    add_light(center, around(160, 0.9), 2.4 * extent, 1.0 * extent, 22.0 * unit)
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    tree = world.node_tree
    sky = tree.nodes["Background"]
    sky.inputs["Color"].default_value = (*HORIZON, 1.0)
    # The camera sees the horizon as bright as the far floor; surfaces get less light from it.
    ray = tree.nodes.new("ShaderNodeLightPath")
    strength = tree.nodes.new("ShaderNodeMapRange")
    strength.inputs["To Min"].default_value, strength.inputs["To Max"].default_value = 0.16, 1.0
    tree.links.new(ray.outputs["Is Camera Ray"], strength.inputs["Value"])
    tree.links.new(strength.outputs[0], sky.inputs["Strength"])
    bpy.context.scene.world = world


def add_camera(options, points, aspect):
    """Shows all points, from --azimuth and --elevation; or stands where --camera says."""
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.sensor_width = "HORIZONTAL", 36.0
    data.lens = 60.0
    thing = new_object("camera", data, bpy.context.scene.collection)
    bpy.context.scene.camera = thing
    if options.camera:
        numbers = numpy.array(numbers_of(options.camera, 6, "--camera", "3,2,3,0,1,0"))
        position, target = to_blender(numbers.reshape(2, 3))
        toward = position - target
    else:
        azimuth, elevation = math.radians(options.azimuth), math.radians(options.elevation)
        toward = numpy.array([math.sin(azimuth) * math.cos(elevation), -math.cos(azimuth) * math.cos(elevation), math.sin(elevation)])
        position = None
    rotation = mathutils.Vector(toward).to_track_quat("Z", "Y")
    if position is None:
        right, up, back = numpy.array(rotation.to_matrix()).T
        across = 18.0 / data.lens / (1.12 / options.zoom)
        seen = numpy.stack([points @ right, points @ up, -points @ back], 1)  # the last: how far away
        place, distance = numpy.zeros(3), 0.0
        for axis, slope in ((0, across), (1, across / aspect)):
            high = (seen[:, axis] - slope * seen[:, 2]).max() + 2.5 * options.radius  # that of the beads of ropes
            low = (seen[:, axis] + slope * seen[:, 2]).min() - 2.5 * options.radius
            place[axis] = 0.5 * (high + low)
            distance = max(distance, (high - low) / (2.0 * slope))
        position = place[0] * right + place[1] * up + distance * back
    thing.location, thing.rotation_euler = position, rotation.to_euler()
    data.clip_end = 1e4


def set_up_cycles(options):
    scene = bpy.context.scene
    width, height = (int(number) for number in numbers_of(options.size, 2, "--size", "960x720", "x"))
    if min(width, height) < 4 or options.samples < 1 or options.zoom <= 0.0:
        raise SystemExit("render.sh: --size, --samples and --zoom must be positive, and a picture has at least 4 x 4 pixels")
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples, scene.cycles.seed = options.samples, SEED
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    scene.cycles.max_bounces, scene.cycles.diffuse_bounces, scene.cycles.glossy_bounces = 4, 3, 2
    scene.cycles.sample_clamp_indirect = 4.0
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    scene.render.image_settings.file_format, scene.render.image_settings.color_mode = "PNG", "RGB"
    scene.render.image_settings.color_depth, scene.render.image_settings.compression = "8", 90
    scene.render.use_stamp = scene.render.use_persistent_data = False
    scene.view_settings.view_transform = "Filmic"
    scene.view_settings.look = "High Contrast"
    scene.view_settings.exposure = 0.1
    if options.threads:
        scene.render.threads_mode, scene.render.threads = "FIXED", options.threads
    return width / height


def set_up_denoising():
    """Debian's Blender has no denoiser. A bilateral blur smooths the diffuse light, but not across edges of the surface's normal, and
    leaves colours and reflections as they are."""
    scene, layer = bpy.context.scene, bpy.context.view_layer
    layer.use_pass_diffuse_direct = layer.use_pass_diffuse_indirect = layer.use_pass_diffuse_color = layer.use_pass_normal = True
    scene.use_nodes = True
    tree = scene.node_tree
    passes, result = tree.nodes["Render Layers"].outputs, tree.nodes["Composite"].inputs["Image"]

    def mix(operation, a, b):
        node = tree.nodes.new("CompositorNodeMixRGB")
        node.blend_type = operation
        tree.links.new(a, node.inputs[1])
        tree.links.new(b, node.inputs[2])
        return node.outputs[0]

    light = mix("ADD", passes["DiffDir"], passes["DiffInd"])
    blur = tree.nodes.new("CompositorNodeBilateralblur")
    blur.iterations, blur.sigma_color, blur.sigma_space = 2, 0.1, 4.0
    tree.links.new(light, blur.inputs["Image"])
    tree.links.new(passes["Normal"], blur.inputs["Determinator"])
    change = mix("MULTIPLY", passes["DiffCol"], mix("SUBTRACT", blur.outputs[0], light))
    tree.links.new(mix("ADD", passes["Image"], change), result)


def clear(collection):
    for thing in list(collection.objects):
        data = thing.data
        bpy.data.objects.remove(thing)
        (bpy.data.curves if isinstance(data, bpy.types.Curve) else bpy.data.meshes).remove(data)


class Stage:
    """Puts the bodies and obstacles of a frame before the camera."""

    def __init__(self, run, extent, radius, obstacles):
        self.run, self.radius = run, radius or 0.008 * extent
        self.collection = bpy.data.collections.new("frame")
        bpy.context.scene.collection.children.link(self.collection)
        self.stone = plain_material("stone", linear(obstacles) if obstacles else STONE, 0.75)
        self.rest, self.materials = {}, {}
        kinds = list(dict.fromkeys(kind_of(name) for name in run.bodies))
        for name, files in run.bodies.items():
            self.rest[name] = run.shape(files, run.frames[0])
            preset = run.scene["bodies"][name].get("material", "")
            self.materials[name] = body_material(name, preset, COLORS[kinds.index(kind_of(name)) % len(COLORS)])
        self.beads = sum(len(shape.vertices) for shape in self.rest.values()) <= 12

    def set(self, frame):
        clear(self.collection)
        for name, files in self.run.bodies.items():
            self.add_body(name, self.run.shape(files, frame))
        for name, files in self.run.obstacles.items():
            shape = self.run.shape(files, frame)
            thing = mesh_object(name, shape, shape.faces, shape, self.collection)
            self.keep_edges(thing)
            thing.data.materials.append(self.stone)

    def add_body(self, name, shape):
        described = self.run.scene["bodies"][name]
        kind, preset = described["shape"]["type"], described.get("material", "")
        material = self.materials[name]
        if shape.lines:
            radius = 0.5 * described.get("diameter", 0.0) or described.get("thickness", 0.0) or self.radius
            tubes(name, shape, max(radius, 0.5 * self.radius), material, self.beads, self.collection)
        if not shape.faces:
            return
        faces = quads_of(shape.faces) if kind == "cloth" else shape.faces
        thing = mesh_object(name, shape, faces, self.rest[name], self.collection)
        thing.data.materials.append(material)
        if kind in ("solid", "lattice", "tetrahedra"):
            self.keep_edges(thing)
            return
        if not FABRICS.get(preset, {}).get("flat") and len(shape.vertices) < 60000:
            finer = thing.modifiers.new("finer", "SUBSURF")
            finer.levels = finer.render_levels = 1
            finer.boundary_smooth = "PRESERVE_CORNERS"
        thick = thing.modifiers.new("thick", "SOLIDIFY")
        thick.thickness, thick.offset = max(0.001, min(0.003, described.get("thickness", 0.002))), 0.0

    def keep_edges(self, thing):
        thing.data.use_auto_smooth, thing.data.auto_smooth_angle = True, math.radians(40.0)


def render():
    options = arguments()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    run = Run(options.folder, options.hide.split())
    missing = sorted(set(options.frames) - set(run.frames))
    if missing:
        raise SystemExit(f"render.sh: {options.folder} has no frame {missing[0]}; it has {run.frames[0]} to {run.frames[-1]}")
    frames = options.frames or run.frames
    aspect = set_up_cycles(options)
    set_up_denoising()
    points = run.points(sorted(frames)[::max(1, len(frames) // 12)] + [max(frames)])
    low, high = points.min(0), points.max(0)
    center, extent = 0.5 * (low + high), float(numpy.linalg.norm(high - low))
    height = max(run.floors(), default=float(low[2]) - 0.03 * extent)
    add_floor(height, center, extent)
    add_lights(center, extent, options.azimuth)
    add_camera(options, points, aspect)
    stage = Stage(run, extent, options.radius, options.obstacles)
    for frame in frames:
        path = os.path.join(options.pictures, f"{frame:04}.png")
        stage.set(frame)
        bpy.context.scene.render.filepath = path
        bpy.ops.render.render(write_still=True)
        print(f"render.sh: frame {frame} is rendered", file=sys.stderr)


try:
    render()
except SystemExit as end:
    if isinstance(end.code, str):
        print(end, file=sys.stderr)
    sys.stderr.flush()
    os._exit(2)
except BaseException:
    traceback.print_exc()
    sys.stderr.flush()
    os._exit(1)
