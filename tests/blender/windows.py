"""Drives Blender in a window: a script is a generator that yields where Blender has to draw before the next line."""
import os
import sys
import time
import traceback

import bpy

PAUSE = 0.05  # between two looks at what happens [s]
HANGS = 240.0  # ends a script that waits for ever [s]


def window():
    return bpy.context.window_manager.windows[0]


def area_of(kind):
    return next(area for area in window().screen.areas if area.type == kind)


def call(operator, **values):
    """An operator as a click on its button calls it."""
    with bpy.context.temp_override(window=window(), area=area_of("PROPERTIES")):
        return operator("INVOKE_DEFAULT", **values)


def show(tab):
    area_of("PROPERTIES").spaces[0].context = tab


def go_on(steps, began=None):
    """A timer that runs the script up to its next yield, then lets Blender draw and call other timers."""
    def tick():
        nonlocal began
        began = began or time.monotonic()
        try:
            next(steps)
            if time.monotonic() - began < HANGS:
                return PAUSE
            print("it waits for ever:", bpy.context.scene.sprung.status)
        except StopIteration:
            leave(0)
        except BaseException:
            traceback.print_exc()
        leave(1)
    return tick


def leave(code):
    sys.modules["sprung.interface"].stop_programs()
    sys.stdout.flush()
    os._exit(code)
