"""Panels and operators. The work is in Job; the operator Simulate polls it by a timer."""
import atexit
import textwrap
import time

import bpy
from bpy.app.handlers import persistent

from .job import Job
from .settings import BODIES

TICK = 0.1  # between two polls [s]
EXPORT_TIME = 0.3  # between two drawings during the export [s]
WIDTH = 48  # of messages in the panel [letters]

jobs = {}  # by the name of the scene


def job_of(scene):
    job = jobs.get(scene.name)
    return job if job and not job.is_over else None


def clear_messages(scene):
    scene.sprung.messages.clear()
    for thing in scene.objects:
        thing.sprung.messages.clear()


def show_messages(job, scene):
    """Puts each message to the objects that it names, else to the scene."""
    clear_messages(scene)
    for message in job.messages:
        things = [scene.objects[name] for name in message.objects if name in scene.objects]
        for owner in things or [scene]:
            shown = owner.sprung.messages.add()
            shown.level, shown.text = message.level, message.text


def show_progress(job, scene):
    scene.sprung.progress = 100.0 * job.progress
    scene.sprung.status = job.status


def redraw(context):
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"PROPERTIES", "VIEW_3D"}:
                area.tag_redraw()


class RunsJob:
    """What Simulate and Resume share."""

    bl_options = {"REGISTER"}
    resumes = False
    timer = None

    @classmethod
    def poll(cls, context):
        return job_of(context.scene) is None

    def invoke(self, context, _event):
        scene = context.scene
        clear_messages(scene)
        jobs[scene.name] = self.job = Job(scene, context.view_layer, resume=self.resumes)
        show_progress(self.job, scene)
        self.timer = context.window_manager.event_timer_add(TICK, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        exports = self.job.state == "exporting"
        if event.type == "TIMER":
            self.work()
            scene = bpy.data.scenes.get(self.job.scene_name)
            if scene:
                show_progress(self.job, scene)
            redraw(context)
            if self.job.is_over:
                return self.end(context, scene)
        elif exports and event.type == "ESC":
            self.job.cancel()
        # A click on Cancel must pass; other changes during the export would end up in it.
        return {"RUNNING_MODAL"} if exports and event.type not in {"LEFTMOUSE", "MOUSEMOVE", "TIMER"} else {"PASS_THROUGH"}

    def work(self):
        """Exports frames until it is time to draw the progress, or looks at the program once."""
        begin = time.monotonic()
        self.job.poll()
        while self.job.state == "exporting" and time.monotonic() - begin < EXPORT_TIME:
            self.job.poll()

    def execute(self, context):
        """Without a window to show the progress in: waits for the end."""
        clear_messages(context.scene)
        self.job = Job(context.scene, context.view_layer, resume=self.resumes)
        self.job.wait()
        show_progress(self.job, context.scene)
        return self.end(context, context.scene)

    def end(self, context, scene):
        if self.timer:
            context.window_manager.event_timer_remove(self.timer)
        if jobs.get(self.job.scene_name) is self.job:
            del jobs[self.job.scene_name]
        if scene:
            show_messages(self.job, scene)
        errors = [message for message in self.job.messages if message.level == "ERROR"]
        for message in errors:
            self.report({"ERROR"}, message.text)
        if not errors:
            self.report({"INFO"}, "Sprung: " + self.job.status)
        return {"CANCELLED"} if self.job.state == "failed" else {"FINISHED"}


class SPRUNG_OT_simulate(RunsJob, bpy.types.Operator):
    """Export the scene, run Sprung in the background, and show the result on the objects"""

    bl_idname = "sprung.simulate"
    bl_label = "Simulate"


class SPRUNG_OT_resume(RunsJob, bpy.types.Operator):
    """Go on with the run that was cancelled, or with more frames. Settings that changed since count for a new simulation alone"""

    bl_idname = "sprung.resume"
    bl_label = "Resume"
    resumes = True


class SPRUNG_OT_cancel(bpy.types.Operator):
    """Stop the run at the end of the frame and keep all frames"""

    bl_idname = "sprung.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, context):
        return job_of(context.scene) is not None

    def execute(self, context):
        job_of(context.scene).cancel()
        return {"FINISHED"}


class SPRUNG_OT_add(bpy.types.Operator):
    """Add a pin or an attachment"""

    bl_idname = "sprung.add"
    bl_label = "Add"
    bl_options = {"REGISTER", "UNDO"}
    kind: bpy.props.EnumProperty(items=[("pins", "Pin", ""), ("attachments", "Attachment", "")])

    def execute(self, context):
        thing = context.object
        added = getattr(thing.sprung, self.kind).add()
        if thing.vertex_groups.active:
            added.group = thing.vertex_groups.active.name
        return {"FINISHED"}


class SPRUNG_OT_remove(bpy.types.Operator):
    """Remove the pin or attachment"""

    bl_idname = "sprung.remove"
    bl_label = "Remove"
    bl_options = {"REGISTER", "UNDO"}
    kind: bpy.props.EnumProperty(items=[("pins", "Pin", ""), ("attachments", "Attachment", "")])
    index: bpy.props.IntProperty()

    def execute(self, context):
        getattr(context.object.sprung, self.kind).remove(self.index)
        return {"FINISHED"}


def draw_messages(layout, owner):
    for message in owner.sprung.messages:
        column = layout.box().column(align=True)
        column.scale_y = 0.8
        for number, line in enumerate(textwrap.wrap(message.text, WIDTH)):
            column.label(text=line, icon="BLANK1" if number else "ERROR" if message.level == "WARNING" else "CANCEL")


def draw_list(layout, thing, kind, title, draw_one):
    row = layout.row()
    row.label(text=title)
    row.operator("sprung.add", text="", icon="ADD").kind = kind
    for index, one in enumerate(getattr(thing.sprung, kind)):
        box = layout.box()
        row = box.row()
        row.prop_search(one, "group", thing, "vertex_groups", text="")
        remove = row.operator("sprung.remove", text="", icon="X")
        remove.kind, remove.index = kind, index
        draw_one(box, one)


def draw_pin(layout, pin):
    layout.prop(pin, "follow")
    row = layout.row()
    row.prop(pin, "releases")
    part = row.row()
    part.active = pin.releases
    part.prop(pin, "release_frame")


def draw_attachment(layout, attachment):
    layout.prop(attachment, "target")
    layout.prop(attachment, "stiffness")
    layout.prop(attachment, "break_force")


def draw_own(layout, settings, name):
    """A value that may replace that of the material."""
    row = layout.row(heading=name.capitalize())
    row.prop(settings, "sets_" + name, text="")
    value = row.row()
    value.active = getattr(settings, "sets_" + name)
    value.prop(settings, name, text="")


class SPRUNG_PT_object(bpy.types.Panel):
    bl_label = "Sprung"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "object"

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == "MESH"

    def draw(self, context):
        thing, layout = context.object, self.layout
        settings = thing.sprung
        layout.use_property_split = True
        draw_messages(layout, thing)
        layout.prop(settings, "role")
        if settings.role == "OBSTACLE":
            layout.prop(settings, "friction")
            layout.prop(settings, "obstacle_thickness")
        elif settings.role in BODIES:
            self.draw_body(layout, thing)

    def draw_body(self, layout, thing):
        settings = thing.sprung
        layout.prop(settings, settings.role.lower() + "_material")
        if settings.role == "ROPE":
            layout.prop(settings, "diameter")
        if settings.role == "LATTICE":
            layout.prop(settings, "cells")
        draw_own(layout, settings, "thickness")
        draw_own(layout, settings, "friction")
        if settings.role != "LATTICE":
            layout.prop(settings, "self_contact")
        if settings.role == "CLOTH":
            layout.prop(settings, "pressure")
        draw_list(layout, thing, "pins", "Pins", draw_pin)
        draw_list(layout, thing, "attachments", "Attachments", draw_attachment)


class SPRUNG_PT_scene(bpy.types.Panel):
    bl_label = "Sprung"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "scene"

    def draw(self, context):
        scene, layout = context.scene, self.layout
        settings = scene.sprung
        layout.use_property_split = True
        self.draw_run(layout, scene)
        draw_messages(layout, scene)
        self.draw_messages_of_objects(layout, scene)
        column = layout.column(align=True)
        column.prop(scene.render, "fps")
        column.prop(scene, "frame_start", text="Frame Start")
        column.prop(scene, "frame_end", text="End")
        rate = scene.render.fps / scene.render.fps_base
        column.label(text=f"Duration: {(scene.frame_end - scene.frame_start) / rate:.2f} s")
        layout.prop(scene, "use_gravity", text="Gravity")
        part = layout.column()
        part.active = scene.use_gravity
        part.prop(scene, "gravity", text="")
        layout.prop(settings, "wind")
        layout.prop(settings, "gust_speed")
        layout.prop(settings, "gust_length")
        layout.prop(settings, "quality")
        layout.prop(settings, "push_out")
        layout.prop(settings, "folder")
        if settings.folder.startswith("//") and not bpy.data.filepath:
            layout.label(text="Unsaved file: the frames are temporary", icon="INFO")

    def draw_run(self, layout, scene):
        settings = scene.sprung
        if job_of(scene):
            row = layout.row(align=True)
            bar = row.row()
            bar.enabled = False
            bar.prop(settings, "progress", slider=True, text="")
            row.operator("sprung.cancel", icon="X")
        else:
            row = layout.row(align=True)
            row.operator("sprung.simulate", icon="PLAY")
            row.operator("sprung.resume", icon="FF")
        if settings.status:
            layout.label(text=settings.status)

    def draw_messages_of_objects(self, layout, scene):
        for thing in scene.objects:
            for level, icon in (("ERROR", "CANCEL"), ("WARNING", "ERROR")):
                count = sum(message.level == level for message in thing.sprung.messages)
                if count:
                    layout.label(text=f"{thing.name}: {count} {level.lower()}{'s' if count > 1 else ''}, see its properties", icon=icon)


@persistent
def close_jobs(*_):
    for job in list(jobs.values()):
        job.close()
    jobs.clear()


def stop_programs():
    """At the end of Blender, which has freed its scenes by then."""
    for job in jobs.values():
        job.stop_program()


CLASSES = [SPRUNG_OT_simulate, SPRUNG_OT_resume, SPRUNG_OT_cancel, SPRUNG_OT_add, SPRUNG_OT_remove, SPRUNG_PT_object, SPRUNG_PT_scene]


def register():
    for kind in CLASSES:
        bpy.utils.register_class(kind)
    bpy.app.handlers.load_pre.append(close_jobs)
    atexit.register(stop_programs)


def unregister():
    close_jobs()
    atexit.unregister(stop_programs)
    bpy.app.handlers.load_pre.remove(close_jobs)
    for kind in reversed(CLASSES):
        bpy.utils.unregister_class(kind)
