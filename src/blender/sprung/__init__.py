"""Sprung in Blender: cloths, ropes and solids that collide with meshes. README.md of the folder above shows the way."""
bl_info = {
    "name": "Sprung",
    "description": "Simulates cloths, ropes and elastic solids as springs and dampers that collide with meshes",
    "author": "The developers of Sprung",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Object > Sprung, and Properties > Scene > Sprung",
    "category": "Physics",
}

from . import interface, settings  # noqa: E402


def register():
    settings.register()
    interface.register()


def unregister():
    interface.unregister()
    settings.unregister()
