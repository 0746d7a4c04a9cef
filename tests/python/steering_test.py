"""Laws of pins and obstacles that a program moves."""
import unittest

import numpy

import sprung
from common import cloth, rope, simulator


def pose(position, degrees=0.0):
    """About the y axis."""
    c, s = numpy.cos(numpy.radians(degrees)), numpy.sin(numpy.radians(degrees))
    matrix = numpy.eye(4)
    matrix[:3, :3] = [[c, 0, s], [0, 1, 0], [-s, 0, c]]
    matrix[:3, 3] = position
    return matrix


class Pins(unittest.TestCase):
    def test_move_to_a_position(self):
        one = simulator(cloth())
        pin, body = one.pins["hand"], one.bodies["cloth"]
        held = body.particles[pin.particles].copy()
        for k in range(1, 21):
            pin.move_to(pin.position + [0, 0.01, 0])
            one.step()
        numpy.testing.assert_allclose(body.particles[pin.particles] - held, numpy.tile([0, 0.2, 0], (2, 1)), atol=1e-12)
        one.step(10)
        numpy.testing.assert_allclose(body.particles[pin.particles] - held, numpy.tile([0, 0.2, 0], (2, 1)), atol=1e-12)

    def test_move_to_a_pose_rotates_about_it(self):
        one = simulator(cloth())
        pin, body = one.pins["hand"], one.bodies["cloth"]
        held, center = body.particles[pin.particles].copy(), pin.position.copy()
        for k in range(1, 31):
            pin.move_to(pose(center, 3.0 * k))
            one.step()
        turned = (held - center) @ pose(center, 90.0)[:3, :3].T + center
        numpy.testing.assert_allclose(body.particles[pin.particles], turned, atol=1e-9)
        other = simulator(cloth())
        for k in range(1, 31):
            other.pins["hand"].move_to(center, [0, 3.0 * k, 0])
            other.step()
        numpy.testing.assert_allclose(other.bodies["cloth"].particles, body.particles, atol=1e-9)

    def test_too_far_is_refused_with_the_number_of_steps(self):
        one = simulator(cloth())
        one.step(5)
        state = one.state()
        with self.assertRaises(sprung.InputError) as caught:
            one.pins["hand"].move_to([100, 0, 0])
        self.assertEqual(caught.exception.problems[0].key, "pins.hand.pose")
        self.assertRegex(caught.exception.problems[0].remedy, "in [0-9]+ steps")
        self.assertEqual(one.state(), state)
        one.step()
        self.assertLess(numpy.abs(one.bodies["cloth"].particles).max(), 1.0)

    def test_nonsense_is_refused(self):
        pin = simulator(cloth()).pins["hand"]
        for wrong in ([0, 0], "here", numpy.zeros((4, 4)), 2 * numpy.eye(4), [numpy.nan, 0, 0], [[1, 2], [3]], None):
            with self.assertRaises(sprung.InputError):
                pin.move_to(wrong)

    def test_can_be_added_and_released(self):
        one = simulator(rope())
        pin = one.pin("rope", [0, 7], "ends")
        self.assertEqual(pin.name, "ends")
        one.step(100)
        self.assertEqual(one.bodies["rope"].particles[0, 1], 0.0)
        self.assertLess(one.bodies["rope"].particles[3, 1], 0.0)
        one.release("rope", 0)
        one.step(100)
        self.assertLess(one.bodies["rope"].particles[0, 1], -0.01)
        for wrong in (("rope", 8, "x"), ("robe", 0, "x"), ("rope", [], "x")):
            with self.assertRaises(sprung.InputError):
                one.pin(*wrong)


class Obstacles(unittest.TestCase):
    def test_a_pose_is_reached_at_the_end_of_the_step(self):
        one = simulator(cloth())
        ball = one.obstacles["ball"]
        numpy.testing.assert_array_equal(ball.pose, pose([0, -0.5, 0]))
        for k in range(1, 41):
            ball.pose = pose([0, -0.5 + 0.01 * k, 0], k)
            one.step()
            numpy.testing.assert_allclose(ball.pose, pose([0, -0.5 + 0.01 * k, 0], k), atol=1e-15)
        self.assertGreater(len(one.contacts()), 0)
        distance = numpy.linalg.norm(one.bodies["cloth"].particles - [0, -0.1, 0], axis=1)
        self.assertGreaterEqual(distance.min(), 0.2)

    def test_a_wrong_pose_is_refused(self):
        one = simulator(cloth())
        for wrong in (numpy.eye(3), 3 * numpy.eye(4), pose([0, 1000, 0]), numpy.full((4, 4), numpy.nan)):
            with self.assertRaises(sprung.InputError):
                one.obstacles["ball"].pose = wrong
        one.step()
        numpy.testing.assert_array_equal(one.obstacles["ball"].pose, pose([0, -0.5, 0]))

    def test_contacts_name_body_obstacle_and_normal(self):
        one = simulator(cloth(16))
        for k in range(1, 61):
            one.obstacles["ball"].pose = pose([0, -0.5 + 0.01 * k, 0])
            one.step()
        contacts = one.contacts()
        self.assertEqual(contacts.dtype.names, ("body", "particle", "obstacle", "normal"))
        self.assertGreater(len(contacts), 0)
        self.assertEqual(set(contacts["body"]), {"cloth"})
        self.assertEqual(set(contacts["obstacle"]) - {""}, {"ball"})
        numpy.testing.assert_allclose(numpy.linalg.norm(contacts["normal"], axis=1), 1.0, atol=1e-12)
        self.assertLess(contacts["particle"].max(), 256)

    def test_mappings_are_read_only(self):
        one = simulator(cloth())
        for mapping in (one.bodies, one.pins, one.obstacles):
            with self.assertRaises(TypeError):
                mapping["new"] = 1


class ContactsOfBodies(unittest.TestCase):
    """Two cubes meet along x, without gravity."""

    def setUp(self):
        cube = {"shape": {"type": "solid", "size": [0.2, 0.2, 0.2], "resolution": [4, 4, 4]}, "thickness": 0.005, "mass": 0.3,
                "springs": {"structural": {"stiffness": 200, "damping": 0.1}, "shear": {"stiffness": 100, "damping": 0.1}}}
        self.one = simulator({"duration": 1, "gravity": [0, 0, 0], "frame_rate": 50, "bodies": {
            "left": {**cube, "velocity": [0.5, 0, 0], "place": {"position": [-0.12, 0.01, 0.02]}},
            "right": {**cube, "velocity": [-0.5, 0, 0], "place": {"position": [0.12, 0, 0]}}}})

    def until_they_touch(self):
        while not len(self.one.contacts()):
            self.one.step()
        return self.one.contacts()

    def test_rows_are_the_corners_that_face_the_other(self):
        contacts = self.until_they_touch()
        self.assertEqual(set(contacts["body"]), {"left", "right"})
        self.assertEqual(set(contacts["obstacle"]), {""})
        for name, side in (("left", 1), ("right", -1)):
            rows = contacts[contacts["body"] == name]
            body = self.one.bodies[name]
            facing = side * body.particles[rows["particle"], 0]
            self.assertGreater(facing.min(), (side * body.particles[:, 0]).max() - 0.02)

    def test_normals_push_each_body_away_from_the_other(self):
        for _ in range(5):
            contacts = self.until_they_touch()
            self.assertLess(contacts["normal"][contacts["body"] == "left", 0].max(), -0.9)
            self.assertGreater(contacts["normal"][contacts["body"] == "right", 0].min(), 0.9)
            self.one.step()

    def test_forces_balance(self):
        def momentum():
            return sum(body.masses @ body.velocities for body in self.one.bodies.values())
        before = momentum()
        self.until_they_touch()
        self.one.step(100)
        left, right = (body.velocities[:, 0].mean() for body in self.one.bodies.values())
        self.assertLess(left, right)  # they part
        # Each contact conserves the momentum up to rounding, of about 1 N s.
        numpy.testing.assert_allclose(momentum(), before, atol=1e-12)


if __name__ == "__main__":
    unittest.main()
