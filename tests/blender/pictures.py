"""Takes the pictures of src/blender/README.md, in a window: run by check.sh pictures FOLDER."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import addon  # noqa: E402
import addon_utils  # noqa: E402
import bpy  # noqa: E402
import mathutils  # noqa: E402
from windows import area_of, call, go_on, show, window  # noqa: E402

addon.install()
FOLDER = sys.argv[sys.argv.index("--") + 1]


def take(name, *kinds):
    """A picture of the window, after it was drawn."""
    for _ in range(4):
        for area in window().screen.areas:
            area.tag_redraw()
        yield
    with bpy.context.temp_override(window=window(), area=window().screen.areas[0]):
        bpy.ops.screen.screenshot(filepath=os.path.join(FOLDER, name))


def scroll_to_end():
    area = area_of("PROPERTIES")
    region = next(region for region in area.regions if region.type == "WINDOW")
    for _ in range(40):
        with bpy.context.temp_override(window=window(), area=area, region=region):
            bpy.ops.view2d.scroll_down(deltay=100)


def look_from(direction, distance, target):
    view = area_of("VIEW_3D").spaces[0].region_3d
    view.view_location = target
    view.view_distance = distance
    view.view_rotation = mathutils.Vector(direction).to_track_quat("Z", "Y")


def widen_properties():
    """Without the outliner, and wide enough for all labels."""
    for kind in ("OUTLINER", "PROPERTIES"):
        with bpy.context.temp_override(window=window(), area=area_of(kind)):
            bpy.ops.screen.area_close()
        yield
    with bpy.context.temp_override(window=window(), area=area_of("VIEW_3D")):
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.62)
    yield
    max((area for area in window().screen.areas if area.type == "VIEW_3D"), key=lambda area: area.x).type = "PROPERTIES"
    yield


def smooth(thing):
    thing.data.polygons.foreach_set("use_smooth", [True] * len(thing.data.polygons))


def choose(thing):
    for other in bpy.context.scene.objects:
        other.select_set(other == thing)
    bpy.context.view_layer.objects.active = thing


def drive():
    scene = addon.empty_scene("pictures", 40)
    scene.sprung.folder = "//sprung"
    cloth, sphere = addon.drape(41)
    smooth(cloth)
    smooth(sphere)
    view = area_of("VIEW_3D")
    view.spaces[0].shading.color_type = "OBJECT"
    cloth.color, sphere.color = (0.8, 0.25, 0.15, 1.0), (0.6, 0.65, 0.7, 1.0)
    view.spaces[0].show_gizmo = False
    look_from((0.5, -1.0, 0.45), 2.6, (0.0, 0.0, 0.1))
    yield from widen_properties()

    view.type = "PREFERENCES"
    bpy.context.preferences.active_section = "ADDONS"
    bpy.context.window_manager.addon_search = "sprung"
    bpy.context.window_manager.addon_support = {"OFFICIAL", "COMMUNITY", "TESTING"}
    bpy.ops.preferences.addon_expand(module="sprung")
    # Paths as people have them, instead of those of this machine.
    addon_utils.addons_fake_modules["sprung"].__file__ = "~/.config/blender/3.4/scripts/addons/sprung/__init__.py"
    settings, found = sys.modules["sprung.settings"], sys.modules["sprung.settings"].find_program
    settings.find_program = lambda: "/usr/local/bin/sprung"
    yield from take("1_install.png")
    settings.find_program = found
    view.type = "VIEW_3D"

    choose(cloth)
    yield
    show("OBJECT")
    yield from take("2_body.png")
    scroll_to_end()
    yield from take("2_body.png")
    choose(sphere)
    yield from take("3_obstacle.png")
    scroll_to_end()
    yield from take("3_obstacle.png")
    show("SCENE")
    yield
    scroll_to_end()
    call(bpy.ops.sprung.simulate)
    while scene.sprung.progress < 50.0:
        yield
    scroll_to_end()
    yield from take("4_simulate.png")
    while not scene.sprung.status.startswith("Done"):
        yield
    scene.frame_set(30)
    yield from take("5_result.png")


bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(go_on(drive()), first_interval=1.0)
