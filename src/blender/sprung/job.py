"""A simulation from export to the cache on the objects. It calls no operator, so it runs with and without an interface."""
import json
import os
import signal
import subprocess
import time

import bpy
import numpy

from . import messages, point_cache
from . import axes as convert
from .axes import Axes
from .messages import Message
from .scene_export import LINKS_FILE, SCENE_FILE, ExportError, SceneExport, write_json
from .settings import find_program, folder_of

RUN_FOLDER = "run"
CACHE_FOLDER = "cache"
LOG_FILE = "messages.txt"

INTERRUPTED = 130
DIVERGED = 4
PAUSE = 0.05  # between two looks at the program [s]


def read_json(path):
    """Nothing if there is no such file."""
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except FileNotFoundError:
        return {}


class Job:
    """Call poll() until is_over. `state` is exporting, running, done, cancelled or failed; `messages` has errors and warnings."""

    def __init__(self, scene, view_layer, resume=False):
        self.scene_name = scene.name  # a reference would not survive an undo
        self.folder = folder_of(scene)
        self.state = "exporting"
        self.messages = []
        self.frames_done = 0
        self.frames = scene.frame_end - scene.frame_start + 1
        self.export_done = 0
        self.resume = resume
        self.process = None
        self.stale = None  # the stamp of the run.json of an earlier run
        self.cancels = False
        self.began = self.latest = None  # the time and the number of frames when the first and the last new frame was seen
        self.export = None if resume else SceneExport(scene, view_layer, self.folder)
        self.steps = None if resume else self.export.steps()

    @property
    def is_over(self):
        return self.state in ("done", "cancelled", "failed")

    @property
    def progress(self):
        """From 0 to 1. The export, mostly short, counts as a tenth."""
        share = 0.0 if self.resume else 0.1
        exported = share * self.export_done / max(1, self.frames) if self.state == "exporting" else share
        return min(1.0, exported + (1.0 - share) * self.frames_done / max(1, self.frames))

    @property
    def status(self):
        """A line for people."""
        if self.state == "exporting":
            return f"Exporting frame {self.export_done} of {self.frames}"
        if self.state == "running" and self.cancels:
            return "Cancelling: the frame is completed"
        if self.state == "running":
            return f"Frame {self.frames_done} of {self.frames}{self.time_left()}"
        if self.state == "cancelled":
            return f"Cancelled: {self.frames_done} of {self.frames} frames are kept; Resume goes on"
        if self.state == "failed":
            return f"Failed after {self.frames_done} of {self.frames} frames"
        return f"Done: {self.frames_done} frames"

    def time_left(self):
        if self.began is self.latest:
            return ""
        per_frame = (self.latest[0] - self.began[0]) / (self.latest[1] - self.began[1])
        seconds = max(0.0, per_frame * (self.frames - self.latest[1]) - (time.monotonic() - self.latest[0]))
        return f", {seconds:.0f} s left" if seconds < 100 else f", {seconds / 60:.0f} min left"

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def fail(self, text, name=None):
        self.messages.append(Message("ERROR", text, [name] if name else []))
        self.state = "failed"

    def cancel(self):
        """Ends the job soon; call poll() until it is over. Whole frames are kept."""
        self.cancels = True
        if self.process and self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)

    def poll(self):
        """Does a small part of the work: exports a frame, or looks at the program."""
        if self.state == "exporting":
            self.poll_export()
        elif self.state == "running":
            self.poll_program()

    def wait(self):
        while not self.is_over:
            self.poll()
            if self.state == "running":
                time.sleep(PAUSE)

    def close(self):
        """For the end of the file: stops the program, which keeps what it has; Resume goes on later."""
        if self.steps:
            self.steps.close()
        self.stop_program()
        self.state = "cancelled"

    def stop_program(self):
        self.cancel()
        if self.process:
            self.process.wait()

    def poll_export(self):
        if self.cancels:
            if self.steps:
                self.steps.close()
            self.state = "cancelled"
            return
        try:
            if self.resume:
                self.check_resume()
            else:
                self.export_done, _ = next(self.steps)
                return
        except StopIteration:
            pass  # the export is complete
        except ExportError as error:
            return self.fail(str(error), error.name)
        except OSError as error:
            return self.fail(f"{error.filename}: {error.strerror}")
        self.start_program()

    def check_resume(self):
        """Raises ExportError if there is nothing to resume. A scene at rest may go on beyond the frames that were exported."""
        described = read_json(self.path(SCENE_FILE))
        if not described or not read_json(self.path(LINKS_FILE)).get("bodies"):
            raise ExportError(f"there is no exported scene in {self.folder}: simulate first")
        exported = round(described["duration"] * described["frame_rate"]) + 1
        if self.frames > exported and is_at_rest(described):
            described["duration"] = (self.frames - 1) / described["frame_rate"]
            write_json(self.path(SCENE_FILE), described)
        elif self.frames != exported:
            if self.frames > exported:
                self.messages.append(Message("WARNING", f"obstacles and pins move, and only {exported} frames of them were exported: "
                                                        "simulate again to get more"))
            self.frames = exported

    def start_program(self):
        program = find_program()
        if not program:
            return self.fail("the program sprung was not found: give its path in the preferences of the add-on, or in the "
                             "environment variable SPRUNG_PROGRAM")
        command = [program, "run", SCENE_FILE, "--out", RUN_FOLDER, "--format", "pc2"]
        command.append("--resume" if self.resume else "--overwrite")
        self.stale = None if self.resume else self.summary_stamp()
        try:
            with open(self.path(LOG_FILE), "wb") as log:
                self.process = subprocess.Popen(command, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        except OSError as error:
            return self.fail(f"{program} cannot be started: {error.strerror}")
        self.state = "running"

    def poll_program(self):
        code = self.process.poll()
        self.frames_done = self.written()
        if self.frames_done > (self.latest[1] if self.latest else 0):
            self.latest = time.monotonic(), self.frames_done
            self.began = self.began or self.latest
        if code is not None:
            self.finish(code)

    def summary_stamp(self):
        """Tells one run.json from the next; None if there is none."""
        try:
            found = os.stat(self.path(RUN_FOLDER, "run.json"))
        except FileNotFoundError:
            return None
        return found.st_ino, found.st_mtime_ns

    def written(self):
        """Frames of the run. The folder has those of an earlier run until the program removes them."""
        if self.stale and self.summary_stamp() == self.stale:
            return 0
        return read_json(self.path(RUN_FOLDER, "run.json")).get("frames_written", 0)

    def finish(self, code):
        links = read_json(self.path(LINKS_FILE))
        with open(self.path(LOG_FILE), encoding="utf-8", errors="replace") as log:
            text = log.read()
        found = messages.parse(text, links)
        self.messages += found
        if code not in (0, INTERRUPTED) and not any(message.level == "ERROR" for message in found):
            self.messages.append(Message("ERROR", f"the program ended with code {code}: {text[-500:].strip()}"))
        if code in (0, INTERRUPTED, DIVERGED):
            self.attach(links)
        self.state = {0: "done", INTERRUPTED: "cancelled"}.get(code, "failed")

    def attach(self, links):
        """Gives each body its frames."""
        axes = Axes(links["metres"])
        os.makedirs(self.path(CACHE_FOLDER), exist_ok=True)
        for name, body in links["bodies"].items():
            thing = bpy.data.objects.get(body["object"])
            if thing is None:
                self.messages.append(Message("WARNING", f"the object \"{body['object']}\" is gone; its frames are in {name}.pc2"))
                continue
            source = self.path(RUN_FOLDER, f"{name}.pc2")
            if not os.path.exists(source):
                continue  # no frame was written
            path = self.path(CACHE_FOLDER, f"{name}.pc2")
            point_cache.write_pc2(path, local_frames(point_cache.read_pc2(source), body, axes))
            point_cache.attach(thing, path, links["first_frame"])


def is_at_rest(described):
    """Whether nothing in the scene file was exported for a certain number of frames only."""
    pins = [pin for body in described["bodies"].values() for pin in body.get("pins", [])]
    return not any("motion" in part or part.get("shape", {}).get("type") == "sequence"
                   for part in pins + list(described["obstacles"].values()))


def local_frames(frames, body, axes):
    """Frames of Sprung in the axes of the object, whose vertices are in Blender's order."""
    order = numpy.array(body["order"])
    matrices = body["matrices"]
    result = numpy.empty((len(frames), len(order), 3), "f4")
    for number, points in enumerate(frames):
        matrix = matrices[min(number, len(matrices) - 1)]
        result[number, order] = convert.to_local(matrix, axes.to_world(points))
    return result
