"""Tests the add-on without an interface: run by check.sh headless."""
import glob
import json
import math
import os
import subprocess
import sys
import tempfile
import traceback
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import addon  # noqa: E402
import bpy  # noqa: E402
import numpy  # noqa: E402

sprung = addon.install()
from sprung import axes, messages, scene_export, settings  # noqa: E402
from sprung.job import Job  # noqa: E402

PROGRAM = os.environ["SPRUNG_PROGRAM"]


def simulate(resume=False):
    job = Job(bpy.context.scene, bpy.context.view_layer, resume=resume)
    job.wait()
    return job


def texts(job, level="ERROR"):
    return [message.text for message in job.messages if message.level == level]


def obj_frames(job):
    """The frames of all bodies as OBJ files, by body: frames x vertices x 3, in Sprung's axes."""
    out = tempfile.mkdtemp(dir=job.folder)
    subprocess.run([PROGRAM, "export", job.path("run"), "--format", "obj", "--out", out], check=True, stderr=subprocess.DEVNULL)
    frames = {}
    for folder in glob.glob(os.path.join(out, "*/")):
        name = os.path.basename(os.path.dirname(folder))
        if name == "obstacles":
            continue
        files = sorted(glob.glob(os.path.join(folder, "*.obj")))
        frames[name] = numpy.array([[line.split()[1:4] for line in open(file) if line.startswith("v ")] for file in files], float)
    return frames


class Case(unittest.TestCase):
    longMessage = True

    def assert_near(self, found, wanted, error, what=""):
        found, wanted = numpy.asarray(found, float), numpy.asarray(wanted, float)
        self.assertEqual(found.shape, wanted.shape, what)
        self.assertLessEqual(numpy.abs(found - wanted).max(initial=0.0), error, what)

    def assert_shows(self, thing, frames, count, metres=1.0):
        """The object shows, in each frame of Blender, the vertices of the OBJ files. Errors are those of floats, which hold the
        cache: a rounding of each of a few numbers of at most some metres."""
        first = bpy.context.scene.frame_start
        self.assertEqual(len(frames), count)
        for number in range(count):
            bpy.context.scene.frame_set(first + number)
            x, y, z = frames[number].T / metres
            self.assert_near(addon.evaluated(thing), numpy.stack([x, -z, y], 1), 4e-6, f"frame {number + 1}")

    def assert_done(self, job, state="done"):
        self.assertEqual(job.state, state, job.messages)

    def scene_file(self, job):
        with open(job.path("scene.json")) as file:
            return json.load(file)


class Axes(Case):
    def test_z_up_becomes_y_up_and_back(self):
        convert = axes.Axes()
        self.assertEqual(convert.vector((1, 2, 3)), [1, 3, -2])
        points = numpy.random.default_rng(1).normal(size=(20, 3))
        self.assert_near(convert.to_world(convert.points(points)), points, 1e-15)

    def test_a_right_hand_stays_one(self):
        self.assertAlmostEqual(numpy.linalg.det(axes.TO_SPRUNG), 1.0)

    def test_a_unit_of_a_centimetre_becomes_metres(self):
        self.assert_near(axes.Axes(0.01).vector((100, 0, 200)), [1, 2, 0], 1e-15)

    def test_object_axes_and_back_with_scale_and_shear(self):
        matrix = numpy.eye(4)
        matrix[:3] = numpy.random.default_rng(2).normal(size=(3, 4))
        local = numpy.random.default_rng(3).normal(size=(20, 3))
        self.assert_near(axes.to_local(matrix, axes.to_world(matrix, local)), local, 1e-12)

    def test_angles_turn_on_past_half_a_turn(self):
        angles = [0, 0, 0]
        for degrees in range(0, 400, 10):
            c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
            angles = axes.sprung_angles(numpy.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]), angles)
        self.assert_near(angles, [0, 390, 0], 1e-3)  # about Blender's z, which is Sprung's y


class Names(Case):
    def test_names_are_those_of_folders_each_once(self):
        class Thing:
            def __init__(self, name):
                self.name = name
        names = scene_export.sprung_names([Thing(name) for name in ("a.001", "a_001", "A.001", "obstacles", "é")])
        self.assertEqual(list(names.values()), ["a_001", "a_001_2", "A_001_3", "obstacles_2", "_"])

    def test_materials_are_those_of_the_program(self):
        listed = subprocess.run([PROGRAM, "materials"], check=True, capture_output=True, text=True).stdout
        rows = [line for line in listed.splitlines() if line and line.split()[0] in sum(settings.MATERIALS.values(), [])]
        self.assertEqual([row.split()[0] for row in rows], sum(settings.MATERIALS.values(), []))
        self.assertEqual({row.split()[0] for row in rows if "*" in row}, settings.LIMITED)


class Messages(Case):
    links = {"bodies": {"Grid_001": {"object": "Grid.001"}, "Rope": {"object": "Rope"}}, "obstacles": {"Ball": "Ball"},
             "attachments": ["Rope"]}

    def objects(self, text):
        return messages.objects_named(text, self.links)

    def test_a_message_goes_to_the_objects_that_it_names(self):
        self.assertEqual(self.objects('scene.json: bodies.Grid_001.material = "x": must be one of cotton'), ["Grid.001"])
        self.assertEqual(self.objects('body "Grid_001" intersects obstacle "Ball" at the start'), ["Grid.001", "Ball"])
        self.assertEqual(self.objects("scene.json: attachments[0].second: ..."), ["Rope"])
        self.assertEqual(self.objects("meshes/Ball/Ball.0003.obj: has 3 vertices"), ["Ball"])
        self.assertEqual(self.objects("thickness is too small"), [])

    def test_errors_and_warnings_are_told_apart(self):
        found = messages.parse("sprung: a line\nsprung: warning: slow\nsprung: error: wrong\n", self.links)
        self.assertEqual([(one.level, one.text) for one in found], [("WARNING", "slow"), ("ERROR", "wrong")])


class Simulations(Case):
    def test_a_grid_falls_on_a_sphere(self):
        addon.empty_scene("drape", 20)
        cloth, sphere = addon.drape()
        job = simulate()
        self.assert_done(job)
        self.assertEqual(job.progress, 1.0)
        self.assert_shows(cloth, obj_frames(job)["Grid"], 20)
        bpy.context.scene.frame_set(20)
        found = addon.evaluated(cloth)
        self.assertLess(found[:, 2].min(), 0.2, "it fell")
        self.assertGreater(numpy.linalg.norm(found - numpy.array(sphere.location), axis=1).min(), 0.29, "and not through the sphere")

    def test_scaled_turned_mirrored_objects_and_units_of_a_centimetre(self):
        scene = addon.empty_scene("scaled", 4)
        scene.unit_settings.scale_length = 0.01
        scene.gravity = 0.0, 0.0, -981.0
        cloth, sphere = addon.drape(11)
        sphere.scale = 100.0, 100.0, 80.0
        sphere.location = 10.0, 20.0, 30.0
        cloth.scale = -50.0, 100.0, 150.0
        cloth.rotation_euler = 0.3, 0.2, 1.0
        cloth.location = 5.0, 10.0, 120.0
        bpy.context.view_layer.update()
        before = addon.evaluated(cloth)
        ball = addon.evaluated(sphere)
        job = simulate()
        self.assert_done(job)
        frames = obj_frames(job)["Grid"]
        x, y, z = frames[0].T
        self.assert_near(numpy.stack([x, -z, y], 1), before * 0.01, 1e-6, "metres, Y up")
        with open(job.path("meshes", "Sphere.obj")) as file:
            exported = numpy.array([line.split()[1:] for line in file if line.startswith("v ")], float)
        exported += self.scene_file(job)["obstacles"]["Sphere"]["place"]["position"]
        x, y, z = exported.T
        self.assert_near(numpy.stack([x, -z, y], 1), ball * 0.01, 1e-6, "the obstacle, scaled")
        # 100 units are a metre, and so are the errors.
        for number in range(4):
            scene.frame_set(1 + number)
            x, y, z = 100.0 * frames[number].T
            self.assert_near(addon.evaluated(cloth), numpy.stack([x, -z, y], 1), 4e-4, f"frame {number + 1}")
        self.assertEqual(self.scene_file(job)["gravity"], [0, -9.81, 0])

    def test_a_skirt_follows_a_mannequin_that_an_armature_bends(self):
        addon.empty_scene("skirt", 16)
        figure, skirt = addon.mannequin()
        job = simulate()
        self.assert_done(job)
        described = self.scene_file(job)
        self.assertEqual(described["obstacles"]["Mannequin"]["shape"]["type"], "sequence")
        self.assertEqual(len(glob.glob(job.path("meshes", "Mannequin", "*.obj"))), 16)
        self.assertEqual(described["bodies"]["Skirt"]["pins"][0]["follow"], "Mannequin")
        self.assert_shows(skirt, obj_frames(job)["Skirt"], 16)
        bpy.context.scene.frame_set(1)
        first, begin = addon.evaluated(skirt), addon.evaluated(figure)
        bpy.context.scene.frame_set(16)
        waist, last = addon.evaluated(skirt)[:32], addon.evaluated(figure)
        moved = numpy.linalg.norm(waist - first[:32], axis=1)
        nearest = numpy.array([numpy.linalg.norm(begin - point, axis=1).argmin() for point in first[:32]])
        figure_moved = numpy.linalg.norm(last - begin, axis=1)[nearest]
        self.assertGreater(moved.min(), 0.5 * figure_moved.min())
        self.assertGreater(moved.max(), 0.02, "the waist moved with the hip")

    def test_a_pinned_flag(self):
        addon.empty_scene("flag", 12)
        flag = addon.flag()
        job = simulate()
        self.assert_done(job)
        frames = obj_frames(job)["Flag"]
        self.assert_shows(flag, frames, 12)
        pinned = list(range(0, 176, 16))
        self.assert_near(frames[-1][pinned], frames[0][pinned], 1e-9, "pins rest")
        self.assertGreater(numpy.abs(frames[-1] - frames[0]).max(), 0.05, "the rest moves")
        self.assert_near(self.scene_file(job)["air"]["wind"], [4, 0, -1], 1e-6)

    def test_pins_move_with_an_object_that_turns(self):
        scene = addon.empty_scene("turning_flag", 10)
        flag = addon.flag()
        for frame, angle, x in ((1, 0.0, 0.5), (10, 1.2, 0.9)):
            flag.rotation_euler.z, flag.location.x = angle, x
            flag.keyframe_insert("rotation_euler", frame=frame)
            flag.keyframe_insert("location", frame=frame)
        pinned = list(range(0, 176, 16))
        wanted = []
        for frame in range(1, 11):
            scene.frame_set(frame)
            wanted.append(addon.evaluated(flag)[pinned])
        job = simulate()
        self.assert_done(job)
        self.assertIn("motion", self.scene_file(job)["bodies"]["Flag"]["pins"][0])
        self.assert_shows(flag, obj_frames(job)["Flag"], 10)
        for number in range(10):
            scene.frame_set(1 + number)
            self.assert_near(addon.evaluated(flag)[pinned], wanted[number], 1e-5, f"pins in frame {number + 1}")

    def test_pins_follow_shape_keys(self):
        scene = addon.empty_scene("shape_keys", 6)
        cloth = addon.add_object("Sheet", *addon.grid(7, 7, 1.0), role="CLOTH")
        addon.add_pin(cloth, "Edge", range(7))
        cloth.shape_key_add(name="Basis")
        key = cloth.shape_key_add(name="Wave")
        for k in range(7):
            key.data[k].co.z += 0.02 * (-1) ** k
        for frame, value in ((1, 0.0), (6, 1.0)):
            key.value = value
            key.keyframe_insert("value", frame=frame)
        job = simulate()
        self.assert_done(job)
        self.assertEqual(len(self.scene_file(job)["bodies"]["Sheet"]["pins"]), 7)
        self.assert_shows(cloth, obj_frames(job)["Sheet"], 6)
        scene.frame_set(6)
        self.assert_near(addon.evaluated(cloth)[:7, 2], [0.02 * (-1) ** k for k in range(7)], 1e-6)

    def test_a_rope_is_a_chain_of_edges_in_any_order(self):
        addon.empty_scene("rope", 6)
        order = [3, 0, 5, 1, 4, 2]  # the vertex at each place of the chain
        vertices = numpy.zeros((6, 3))
        for place, vertex in enumerate(order):
            vertices[vertex] = 0.1 * place, 0.0, 1.0
        rope = addon.add_object("Rope", vertices, edges=list(zip(order[:-1], order[1:])), role="ROPE")
        addon.add_pin(rope, "End", [3])
        job = simulate()
        self.assert_done(job)
        described = self.scene_file(job)["bodies"]["Rope"]
        self.assertEqual(described["shape"]["type"], "rope")
        frames = obj_frames(job)["Rope"]
        if frames[0][0][0] > 0.25:
            order = order[::-1]
        in_order = numpy.empty_like(frames)
        in_order[:, order] = frames
        self.assert_shows(rope, in_order, 6)

    def test_a_net_of_edges_and_a_lattice(self):
        addon.empty_scene("net", 5)
        vertices, faces = addon.grid(4, 4, 0.5)
        edges = sorted({tuple(sorted((face[k], face[(k + 1) % 4]))) for face in faces for k in range(4)})
        net = addon.add_object("Net", vertices, edges=edges, role="ROPE")
        net.location.z = 1.0
        ball = addon.add_object("Ball", *addon.ball(0.2, 12, 7), role="LATTICE")
        ball.sprung.cells = 4
        job = simulate()
        self.assert_done(job)
        frames = obj_frames(job)
        self.assert_shows(net, frames["Net"], 5)
        self.assert_shows(ball, frames["Ball"], 5)

    def test_an_obstacle_that_turns_is_one_mesh_with_keyframes(self):
        scene = addon.empty_scene("turning", 6)
        addon.drape(6)
        sphere = bpy.data.objects["Sphere"]
        sphere.scale = 1.0, 1.5, 0.8
        sphere.location = 0.3, 0.1, -0.5
        for frame, angle in ((1, 0.0), (6, 4.0)):
            sphere.rotation_euler = 0.0, 0.5 * angle, angle
            sphere.keyframe_insert("rotation_euler", frame=frame)
        job = simulate()
        self.assert_done(job)
        self.assertIn("motion", self.scene_file(job)["obstacles"]["Sphere"])
        subprocess.run([PROGRAM, "export", job.path("run"), "--format", "obj", "--out", job.path("obj")], check=True,
                       stderr=subprocess.DEVNULL)
        for number in range(6):
            scene.frame_set(1 + number)
            with open(job.path("obj", "obstacles", "Sphere", f"Sphere.{number + 1:04}.obj")) as file:
                x, y, z = numpy.array([line.split()[1:4] for line in file if line.startswith("v ")], float).T
            self.assert_near(addon.evaluated(sphere), numpy.stack([x, -z, y], 1), 1e-5, f"frame {number + 1}")

    def test_obstacles_that_grow_or_deform_late_are_sequences(self):
        scene = addon.empty_scene("growing", 5)
        addon.drape(5)
        growing = bpy.data.objects["Sphere"]
        late = addon.add_object("Late", *addon.ball(0.2, 8, 5), role="OBSTACLE")
        growing.location.z, late.location.x = -1.0, 2.0
        for frame, scale in ((1, 1.0), (5, 1.2)):
            growing.scale = scale, 1.0, scale
            growing.keyframe_insert("scale", frame=frame)
        late.shape_key_add(name="Basis")
        key = late.shape_key_add(name="Dent")
        key.data[0].co.z += 0.05
        for frame, value in ((3, 0.0), (5, 1.0)):
            key.value = value
            key.keyframe_insert("value", frame=frame)
        job = simulate()
        self.assert_done(job)
        for thing in (growing, late):
            self.assertEqual(self.scene_file(job)["obstacles"][thing.name]["shape"]["type"], "sequence")
            for number in range(5):
                scene.frame_set(1 + number)
                with open(job.path("meshes", thing.name, f"{thing.name}.{number + 1:04}.obj")) as file:
                    x, y, z = numpy.array([line.split()[1:] for line in file if line.startswith("v ")], float).T
                self.assert_near(addon.evaluated(thing), numpy.stack([x, -z, y], 1), 1e-6, f"{thing.name}, frame {number + 1}")

    def test_an_attachment_holds_a_cloth_at_an_obstacle(self):
        addon.empty_scene("attached", 8)
        cloth = addon.add_object("Sheet", *addon.grid(8, 8, 0.5), role="CLOTH")
        post = addon.add_object("Post", *addon.ball(0.1), role="OBSTACLE")
        cloth.location, post.location = (0.4, 0.0, 1.0), (0.0, 0.0, 1.0)
        addon.add_group(cloth, "Side", range(0, 64, 8))
        attachment = cloth.sprung.attachments.add()
        attachment.group, attachment.target = "Side", post
        job = simulate()
        self.assert_done(job)
        self.assertEqual(self.scene_file(job)["attachments"][0]["second"], {"obstacle": "Post"})
        frames = obj_frames(job)["Sheet"]
        self.assert_shows(cloth, frames, 8)
        self.assertGreater(frames[-1][0:64:8, 1].min(), 0.8, "the side is held")
        self.assertLess(frames[-1][:, 1].min(), 0.9, "the rest falls")

    def test_the_program_takes_every_setting(self):
        scene = addon.empty_scene("settings", 3)
        ball = addon.add_object("Balloon", *addon.ball(0.2, 12, 7), role="CLOTH")
        rope = addon.add_object("Rope", [(0.0, 0.0, 0.5 + 0.1 * k) for k in range(6)], edges=[(k, k + 1) for k in range(5)], role="ROPE")
        cube = addon.add_object("Cube", *addon.ball(0.2, 12, 7), role="LATTICE")
        floor = addon.add_object("Floor", *addon.grid(2, 2, 4.0), role="OBSTACLE")
        ball.location, cube.location, floor.location = (0, 0, 0.25), (1, 0, 0.25), (0, 0, -0.5)
        ball.sprung.cloth_material, ball.sprung.pressure = "rubber_sheet", 50.0
        rope.sprung.rope_material, rope.sprung.diameter = "nylon", 0.02
        cube.sprung.lattice_material, cube.sprung.cells = "foam", 5
        for thing in (ball, rope, cube):
            thing.sprung.sets_thickness = thing.sprung.sets_friction = True
            thing.sprung.thickness, thing.sprung.friction = 0.003, 0.25
        floor.sprung.friction, floor.sprung.obstacle_thickness = 0.7, 0.001
        pin = addon.add_pin(rope, "Top", [5])
        pin.releases, pin.release_frame = True, 2
        addon.add_group(rope, "Bottom", [0])
        attachment = rope.sprung.attachments.add()
        attachment.group, attachment.target, attachment.stiffness, attachment.break_force = "Bottom", ball, 100.0, 30.0
        scene.sprung.wind, scene.sprung.gust_speed, scene.sprung.gust_length = (1.0, 0.0, 0.0), 0.5, 2.0
        for quality, stretch in (("DRAFT", 0.05), ("NORMAL", None), ("FINE", 0.005)):
            scene.sprung.quality = quality
            job = simulate()
            self.assert_done(job)
            described = self.scene_file(job)
            self.assertEqual(described.get("stretch_limit", {}).get("max_stretch"), stretch)
        rows = {"Balloon": ("rubber_sheet", {"pressure": 50}), "Rope": ("nylon", {"diameter": 0.02}), "Cube": ("foam", {})}
        for name, (material, more) in rows.items():
            for key, value in {"material": material, "thickness": 0.003, "friction": 0.25, **more}.items():
                self.assertEqual(described["bodies"][name][key], value)
        self.assertEqual(described["bodies"]["Cube"]["shape"]["cells"], 5)
        self.assertEqual(described["bodies"]["Rope"]["pins"][0]["until"], 1 / 24)
        self.assertEqual({key: described["obstacles"]["Floor"][key] for key in ("friction", "thickness")},
                         {"friction": 0.7, "thickness": 0.001})
        attached = described["attachments"][0]
        self.assertEqual((attached["second"], attached["stiffness"], attached["break_force"]), ({"body": "Balloon"}, 100, 30))
        self.assertEqual(described["air"], {"wind": [1, 0, 0], "gusts": {"speed": 0.5, "length": 2}})

    def test_a_warning_of_the_program_is_at_its_object(self):
        addon.empty_scene("warning", 2)
        _, sphere = addon.drape(6)
        sphere.scale = 1000.0, 1000.0, 1000.0
        sphere.location.z = -301.0
        job = simulate()
        self.assert_done(job)
        warnings = [message for message in job.messages if message.level == "WARNING"]
        self.assertIn(["Sphere"], [message.objects for message in warnings], warnings)

    def test_modifiers_below_the_simulation_act_on_its_result(self):
        addon.empty_scene("subdivided", 4)
        cloth, _ = addon.drape(6)
        cloth.modifiers.new("Finer", "SUBSURF").levels = 1
        job = simulate()
        self.assert_done(job)
        self.assertEqual(obj_frames(job)["Grid"].shape[1], 36)
        self.assertEqual(len(addon.evaluated(cloth)), 121)
        again = simulate()
        self.assert_done(again)
        self.assertEqual(obj_frames(again)["Grid"].shape[1], 36)

    def test_the_exported_folder_runs_by_itself(self):
        addon.empty_scene("alone", 3)
        addon.mannequin()
        job = simulate()
        self.assert_done(job)
        here = os.path.join(addon.OUT, "elsewhere")
        os.makedirs(here)
        subprocess.run([PROGRAM, "run", job.path("scene.json"), "--out", os.path.join(here, "run"), "--quiet", "--format", "pc2"],
                       cwd=here, check=True)
        with open(job.path("run", "Skirt.pc2"), "rb") as one, open(os.path.join(here, "run", "Skirt.pc2"), "rb") as other:
            self.assertEqual(one.read(), other.read())


class Interruptions(Case):
    def cancelled(self, folder, frames=2000):
        addon.empty_scene(folder, frames)
        self.cloth, self.sphere = addon.drape()
        self.sphere.sprung.friction = 0.0
        job = Job(bpy.context.scene, bpy.context.view_layer)
        while not job.is_over and job.frames_done < 3:
            job.poll()
        job.cancel()
        job.wait()
        return job

    def test_cancel_keeps_whole_frames_and_resume_goes_on(self):
        job = self.cancelled("cancelled")
        self.assert_done(job, "cancelled")
        kept = job.frames_done
        self.assertGreaterEqual(kept, 3)
        self.assertLess(kept, 2000)
        self.assertEqual(texts(job), [])
        before = obj_frames(job)["Grid"]
        self.assert_shows(self.cloth, before[:5], min(5, kept))
        bpy.context.scene.frame_end = 2000
        resumed = Job(bpy.context.scene, bpy.context.view_layer, resume=True)
        while not resumed.is_over and resumed.frames_done < kept + 2:
            resumed.poll()
        resumed.cancel()
        resumed.wait()
        self.assert_done(resumed, "cancelled")
        self.assertGreaterEqual(resumed.frames_done, kept + 2)
        after = obj_frames(resumed)["Grid"]
        self.assertTrue((after[:kept] == before).all(), "the frames that were kept stay")

    def test_resume_makes_a_finished_run_longer(self):
        scene = addon.empty_scene("longer", 6)
        cloth, _ = addon.drape(8)
        self.assert_done(simulate())
        scene.frame_end = 9
        job = simulate(resume=True)
        self.assert_done(job)
        self.assertEqual(job.frames_done, 9)
        self.assert_shows(cloth, obj_frames(job)["Grid"], 9)

    def test_cancel_during_the_export_changes_nothing(self):
        scene = addon.empty_scene("export_cancelled", 50)
        addon.drape(6)
        scene.frame_set(7)
        job = Job(scene, bpy.context.view_layer)
        for _ in range(3):
            job.poll()
        self.assertEqual(job.state, "exporting")
        job.cancel()
        job.wait()
        self.assert_done(job, "cancelled")
        self.assertEqual(scene.frame_current, 7)
        self.assertFalse(os.path.exists(job.path("run")))
        again = simulate(resume=True)
        self.assertIn("simulate first", texts(again)[0])

    def test_the_settings_stay_in_the_file(self):
        scene = addon.empty_scene("saved", 5)
        cloth, _ = addon.drape(6)
        cloth.sprung.cloth_material = "denim"
        scene.sprung.folder = "//frames"
        file = os.path.join(addon.OUT, "saved.blend")
        bpy.ops.wm.save_as_mainfile(filepath=file)
        self.assert_done(simulate())
        bpy.ops.wm.save_as_mainfile(filepath=file)
        bpy.ops.wm.open_mainfile(filepath=file)
        cloth = bpy.data.objects["Grid"]
        self.assertEqual(cloth.sprung.cloth_material, "denim")
        self.assertEqual(cloth.modifiers["Sprung"].filepath, "//frames/cache/Grid.pc2")
        bpy.context.scene.frame_set(1)
        high = addon.evaluated(cloth)[:, 2].max()
        bpy.context.scene.frame_set(5)
        self.assertLess(addon.evaluated(cloth)[:, 2].max(), high)


class Operators(Case):
    """As scripts call them, without a window."""

    def test_simulate_and_resume_report_and_show_messages(self):
        scene = addon.empty_scene("operators", 4)
        cloth, _ = addon.drape(6)
        cloth.sprung.pins.add().group = "Missing"
        with self.assertRaisesRegex(RuntimeError, "no vertex of the group"):
            bpy.ops.sprung.simulate()
        self.assertEqual([message.level for message in cloth.sprung.messages], ["ERROR"])
        cloth.sprung.pins.clear()
        self.assertEqual(bpy.ops.sprung.simulate(), {"FINISHED"})
        self.assertFalse(cloth.sprung.messages)
        self.assertEqual(scene.sprung.status, "Done: 4 frames")
        scene.frame_end = 6
        self.assertEqual(bpy.ops.sprung.resume(), {"FINISHED"})
        self.assertEqual(scene.sprung.status, "Done: 6 frames")

    def test_the_type_of_an_object_makes_and_removes_the_modifier(self):
        addon.empty_scene("roles", 4)
        thing = addon.add_object("Sheet", *addon.grid(3, 3, 1.0))
        self.assertEqual(len(thing.modifiers), 0)
        for role, count in (("CLOTH", 1), ("LATTICE", 1), ("OBSTACLE", 0), ("ROPE", 1), ("NONE", 0)):
            thing.sprung.role = role
            self.assertEqual(len(thing.modifiers), count, role)

    def test_the_add_on_can_be_switched_off_and_on(self):
        bpy.ops.preferences.addon_disable(module="sprung")
        self.assertFalse(hasattr(bpy.types.Object, "sprung"))
        bpy.ops.preferences.addon_enable(module="sprung")
        self.assertTrue(hasattr(bpy.types.Object, "sprung"))


class Mistakes(Case):
    def errors(self, job):
        self.assert_done(job, "failed")
        return [(message.text, message.objects) for message in job.messages if message.level == "ERROR"]

    def test_an_error_of_the_program_is_at_its_object(self):
        scene = addon.empty_scene("mistake", 5)
        cloth, sphere = addon.drape(8)
        sphere.location.z = 0.35
        scene.sprung.push_out = False
        text, objects = self.errors(simulate())[0]
        self.assertIn("Grid", text)
        self.assertIn("Grid", objects)

    def test_a_group_without_vertices_is_an_error_at_its_object(self):
        addon.empty_scene("no_group", 5)
        cloth, _ = addon.drape(6)
        cloth.sprung.pins.add().group = "Missing"
        self.assertEqual(self.errors(simulate()), [('no vertex of the group "Missing" has a weight of at least 0.5', ["Grid"])])

    def test_a_scene_without_a_body_is_an_error(self):
        addon.empty_scene("nothing", 5)
        self.assertIn("no object is a cloth", self.errors(simulate())[0][0])

    def test_a_hidden_obstacle_is_an_error_at_the_obstacle(self):
        addon.empty_scene("hidden", 5)
        _, sphere = addon.drape(6)
        bpy.context.view_layer.update()
        sphere.hide_set(True)
        text, objects = self.errors(simulate())[0]
        self.assertIn("hidden", text)
        self.assertEqual(objects, ["Sphere"])

    def test_an_obstacle_with_a_changing_number_of_vertices_is_an_error(self):
        addon.empty_scene("changing", 5)
        _, sphere = addon.drape(6)
        finer = sphere.modifiers.new("Finer", "BUILD")
        finer.frame_start, finer.frame_duration = 1, 5
        self.assertEqual(self.errors(simulate())[0][1], ["Sphere"])

    def test_an_open_lattice_is_an_error_at_its_object(self):
        addon.empty_scene("open", 5)
        addon.add_object("Sheet", *addon.grid(4, 4, 1.0), role="LATTICE")
        self.assertEqual(self.errors(simulate())[0][1], ["Sheet"])

    def test_a_folder_of_someone_else_is_not_touched(self):
        addon.empty_scene("foreign", 5)
        addon.drape(6)
        kept = os.path.join(addon.OUT, "foreign", "meshes", "mine.txt")
        os.makedirs(os.path.dirname(kept))
        open(kept, "w").close()
        self.assertIn("choose another folder", self.errors(simulate())[0][0])
        self.assertTrue(os.path.exists(kept))

    def test_without_the_program_an_error_says_where_to_name_it(self):
        addon.empty_scene("no_program", 2)
        addon.drape(6)
        os.environ["SPRUNG_PROGRAM"] = "/nowhere/sprung"
        try:
            self.assertIn("preferences", self.errors(simulate())[0][0])
        finally:
            os.environ["SPRUNG_PROGRAM"] = PROGRAM


class Pictures(Case):
    """examples/render.py, which renders runs."""

    def render(self, example, frame, *options):
        """Red, green and blue of each pixel of a small picture."""
        examples = os.path.join(os.environ["SPRUNG_SOURCE_DIR"], "examples")
        out = os.path.join(addon.OUT, example)
        subprocess.run([PROGRAM, "run", os.path.join(examples, f"{example}.json"), "--out", out, "--frames", str(frame), "--quiet"],
                       check=True, stderr=subprocess.DEVNULL)
        subprocess.run([bpy.app.binary_path, "-b", "--factory-startup", "-P", os.path.join(examples, "render.py"), "--", out, str(frame),
                        "--pictures", out, "--size", "64x48", "--samples", "2", *options], check=True, stdout=subprocess.DEVNULL)
        picture = bpy.data.images.load(os.path.join(out, f"{frame:04}.png"))
        self.assertEqual(tuple(picture.size), (64, 48))
        return numpy.array(picture.pixels[:]).reshape(-1, 4).T[:3]

    def test_a_rope_and_its_masses_are_seen(self):
        red, _, blue = self.render("two_masses", 2, "--azimuth", "0", "--radius", "0.05")
        self.assertGreater((red > 1.4 * blue).mean(), 0.02)

    def test_a_flag_of_silk_is_seen(self):
        red, _, blue = self.render("flag_in_gusts", 2)
        self.assertGreater((blue > 1.3 * red).mean(), 0.05)


try:
    names = sys.argv[sys.argv.index("--") + 1:]
    loader = unittest.TestLoader()
    module = sys.modules[__name__]
    tests = loader.loadTestsFromNames(names, module) if names else loader.loadTestsFromModule(module)
    passed = unittest.TextTestRunner(stream=sys.stdout, verbosity=2).run(tests).wasSuccessful()
except BaseException:
    traceback.print_exc()
    passed = False
sys.stdout.flush()
os._exit(0 if passed else 1)
