"""What the .blend keeps: settings of objects and of the scene, and messages of the last run."""
import os
import shutil

import bpy
from bpy.props import (BoolProperty, CollectionProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty,
                       PointerProperty, StringProperty)

from . import point_cache

# The presets of `sprung materials`; a test compares both. Bodies of the materials in LIMITED have a stretch limit of 2 %.
MATERIALS = {
    "CLOTH": ["cotton", "silk", "wool", "denim", "jersey", "leather", "felt", "paper", "rubber_sheet"],
    "ROPE": ["hemp", "nylon", "steel_cable", "hair"],
    "LATTICE": ["soft_jelly", "firm_jelly", "foam", "rubber_block"],
}
LIMITED = {"cotton", "silk", "wool", "denim", "leather", "felt", "paper", "hemp", "nylon", "steel_cable", "hair"}
BODIES = set(MATERIALS)


def material_items(role):
    return [(name, name.replace("_", " ").capitalize(), "") for name in MATERIALS[role]]


def role_changed(self, _context):
    thing = self.id_data
    if self.role in BODIES:
        point_cache.ensure_modifier(thing)
    else:
        point_cache.remove_modifier(thing)


class SprungMessage(bpy.types.PropertyGroup):
    level: EnumProperty(items=[("ERROR", "Error", ""), ("WARNING", "Warning", "")])
    text: StringProperty()


class SprungPin(bpy.types.PropertyGroup):
    group: StringProperty(name="Vertex Group", description="Vertices with a weight of at least 0.5 are pinned")
    follow: PointerProperty(type=bpy.types.Object, name="Follow",
                            description="Obstacle with which the pinned vertices move. Without one they move as the object is "
                                        "animated, by keyframes, armature or shape keys; or rest")
    releases: BoolProperty(name="Release", description="The pin lets go at a frame")
    release_frame: IntProperty(name="Frame", default=50, description="Frame at which the pin lets go")


class SprungAttachment(bpy.types.PropertyGroup):
    group: StringProperty(name="Vertex Group", description="Vertices with a weight of at least 0.5 are attached")
    target: PointerProperty(type=bpy.types.Object, name="To",
                            description="Body or obstacle of Sprung. Each vertex is attached to the nearest point of its surface")
    stiffness: FloatProperty(name="Stiffness", min=0.0, default=0.0,
                             description="Stiffness of springs [N/m]; 0: rods, whose length does not change")
    break_force: FloatProperty(name="Break Force", min=0.0, default=0.0,
                               description="Force beyond which a rod or spring breaks [N]; 0: never")


class SprungObject(bpy.types.PropertyGroup):
    role: EnumProperty(name="Type", update=role_changed, items=[
        ("NONE", "None", "Sprung ignores the object"),
        ("CLOTH", "Cloth", "A particle for each vertex, springs along and across the faces"),
        ("ROPE", "Rope", "A particle for each vertex, springs along the edges"),
        ("LATTICE", "Lattice", "Cubes of an elastic solid fill the closed mesh"),
        ("OBSTACLE", "Obstacle", "Bodies collide with the object, which moves as it is animated")])
    cloth_material: EnumProperty(name="Material", items=material_items("CLOTH"))
    rope_material: EnumProperty(name="Material", items=material_items("ROPE"))
    lattice_material: EnumProperty(name="Material", items=material_items("LATTICE"))
    diameter: FloatProperty(name="Diameter", min=0.0, default=0.0, precision=4, unit="LENGTH",
                            description="Diameter of a rope that is a chain of edges; 0: that of the material")
    cells: IntProperty(name="Cells", min=1, max=1024, default=12, description="Cubes along the longest side")
    sets_thickness: BoolProperty(name="Own Thickness", description="Another thickness than the material's")
    thickness: FloatProperty(name="Thickness", min=0.0, default=0.002, precision=4, unit="LENGTH",
                             description="The object's share of the gap at contact")
    sets_friction: BoolProperty(name="Own Friction", description="Another friction than the material's")
    friction: FloatProperty(name="Friction", min=0.0, soft_max=1.0, default=0.4, description="Coefficient of friction")
    obstacle_thickness: FloatProperty(name="Thickness", min=0.0, default=0.0, precision=4, unit="LENGTH",
                                      description="The obstacle's share of the gap at contact")
    self_contact: BoolProperty(name="Self-Contact", default=True, description="The body collides with itself")
    pressure: FloatProperty(name="Pressure", default=0.0,
                            description="Excess pressure of the gas in a closed cloth [Pa], as in a balloon; 0: none")
    pins: CollectionProperty(type=SprungPin)
    attachments: CollectionProperty(type=SprungAttachment)
    messages: CollectionProperty(type=SprungMessage)

    def material(self):
        return getattr(self, self.role.lower() + "_material")


class SprungScene(bpy.types.PropertyGroup):
    folder: StringProperty(name="Folder", subtype="DIR_PATH", default="//sprung",
                           description="Where the exported scene, the run and the caches are. // is the folder of the .blend file")
    wind: FloatVectorProperty(name="Wind", unit="VELOCITY", description="Mean velocity of the air")
    gust_speed: FloatProperty(name="Gusts", min=0.0, unit="VELOCITY", description="Root mean square of random gusts; 0: none")
    gust_length: FloatProperty(name="Gust Size", min=0.001, default=1.0, unit="LENGTH", description="Correlation length of the gusts")
    quality: EnumProperty(name="Quality", default="NORMAL", items=[
        ("DRAFT", "Draft", "Cloths and ropes stretch by up to 5 %; short edges may gain mass so that steps are longer"),
        ("NORMAL", "Normal", "Cloths and ropes stretch by up to 2 %"),
        ("FINE", "Fine", "Cloths and ropes stretch by up to 0.5 %; no edge gains mass")])
    push_out: BoolProperty(name="Push Out at the Start", default=True,
                           description="Bodies that intersect obstacles or each other in the first frame are moved apart; else that is "
                                       "an error")
    messages: CollectionProperty(type=SprungMessage)
    status: StringProperty()
    progress: FloatProperty(min=0.0, max=100.0, subtype="PERCENTAGE", name="Progress", precision=0, options={"SKIP_SAVE"})


class SprungPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__
    program: StringProperty(name="Program", subtype="FILE_PATH", description="The program sprung. Empty: the one of the environment "
                                                                            "variable SPRUNG_PROGRAM, or the one on the PATH")

    def draw(self, _context):
        self.layout.prop(self, "program")
        found = find_program()
        self.layout.label(text=found or "The program sprung was not found: give its path", icon="CHECKMARK" if found else "ERROR")


def find_program():
    """The path of the program sprung, or None."""
    addon = bpy.context.preferences.addons.get(__package__)
    given = addon.preferences.program if addon and addon.preferences else ""
    wanted = bpy.path.abspath(given) or os.environ.get("SPRUNG_PROGRAM") or "sprung"
    return shutil.which(wanted)


def folder_of(scene):
    """Where the files of a scene are. A .blend that is not saved yet has no folder: then they are temporary."""
    folder = scene.sprung.folder
    if folder.startswith("//") and not bpy.data.filepath:
        return os.path.join(bpy.app.tempdir, folder[2:] or "sprung")
    return os.path.abspath(bpy.path.abspath(folder))


CLASSES = [SprungMessage, SprungPin, SprungAttachment, SprungObject, SprungScene, SprungPreferences]


def register():
    for kind in CLASSES:
        bpy.utils.register_class(kind)
    bpy.types.Object.sprung = PointerProperty(type=SprungObject)
    bpy.types.Scene.sprung = PointerProperty(type=SprungScene)


def unregister():
    del bpy.types.Scene.sprung
    del bpy.types.Object.sprung
    for kind in reversed(CLASSES):
        bpy.utils.unregister_class(kind)
