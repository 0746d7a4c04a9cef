"""Tests the add-on in a window, under Xvfb: panels, progress, Cancel and Resume. Run by check.sh interface."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import addon  # noqa: E402
import bpy  # noqa: E402
import numpy  # noqa: E402
from windows import area_of, call, go_on, show, window  # noqa: E402

FRAMES = 1000

interface = sys.modules[addon.install().__name__ + ".interface"]
drawn = set()  # panels


def count_draws(panel):
    draw = panel.draw

    def counted(self, context):
        draw(self, context)
        drawn.add(panel.__name__)
    panel.draw = counted


def draws(panel):
    drawn.discard(panel)
    area_of("PROPERTIES").tag_redraw()
    while panel not in drawn:
        yield


def job():
    return interface.jobs.get(bpy.context.scene.name)


def drive():
    """The test: yields where Blender has to go on before the next line."""
    scene = addon.empty_scene("interface", FRAMES)
    area_of("VIEW_3D").type = "CONSOLE"  # without a graphics card, a 3D view takes most of the time
    settings = scene.sprung
    cloth, sphere = addon.drape()
    bpy.context.view_layer.objects.active = cloth
    show("OBJECT")
    yield from draws("SPRUNG_PT_object")
    call(bpy.ops.sprung.add, kind="pins")
    assert len(cloth.sprung.pins) == 1
    call(bpy.ops.sprung.simulate)
    while job():
        yield
    assert cloth.sprung.messages[0].text == "choose a vertex group for each pin and attachment", "the error is at its object"
    assert not scene.sprung.messages
    yield from draws("SPRUNG_PT_object")
    call(bpy.ops.sprung.remove, kind="pins", index=0)
    assert not cloth.sprung.pins

    show("SCENE")
    yield from draws("SPRUNG_PT_scene")
    with bpy.context.temp_override(window=window()):
        assert not bpy.ops.sprung.cancel.poll()
    call(bpy.ops.sprung.simulate)
    assert not cloth.sprung.messages, "a new run removes old messages"
    seen = [settings.progress]
    while job().frames_done < 5:
        assert job().state != "failed", job().messages
        seen.append(settings.progress)
        yield
    seen.append(settings.progress)
    yield from draws("SPRUNG_PT_scene")
    assert seen == sorted(seen) and 0.0 <= seen[0] < seen[-1] < 100.0, seen
    assert settings.status.startswith("Frame "), settings.status
    with bpy.context.temp_override(window=window()):
        assert not bpy.ops.sprung.simulate.poll(), "one run at a time"
    call(bpy.ops.sprung.cancel)
    while job():
        yield
    assert settings.status.startswith("Cancelled: "), settings.status
    kept = int(settings.status.split()[1])
    assert 5 <= kept < FRAMES, kept
    scene.frame_set(1)
    begin = addon.evaluated(cloth)
    scene.frame_set(5)
    assert numpy.abs(addon.evaluated(cloth) - begin).max() > 0.01, "the frames are on the object"
    yield from draws("SPRUNG_PT_scene")

    call(bpy.ops.sprung.resume)
    while job().frames_done < kept + 2:
        assert job().state != "failed", job().messages
        yield
    call(bpy.ops.sprung.cancel)
    while job():
        yield
    assert int(settings.status.split()[1]) >= kept + 2, settings.status


for shown in (interface.SPRUNG_PT_object, interface.SPRUNG_PT_scene):
    count_draws(shown)
bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(go_on(drive()), first_interval=1.0)
