"""Laws of forces: of Python functions, and of pins."""
import unittest

import numpy

import sprung
from common import cloth, rope, simulator


class AddedForces(unittest.TestCase):
    def test_a_constant_force_accelerates(self):
        one = simulator(rope(), overrides={"gravity": [0, 0, 0], "integrator": {"type": "velocity_verlet"}})
        mass = one.bodies["rope"].masses
        one.add_force(lambda x, v, t: mass[:, None] * [0, 2, 0])
        one.step(100)
        numpy.testing.assert_allclose(one.bodies["rope"].particles[:, 1], 0.5 * 2 * 0.1 ** 2, atol=1e-12)
        numpy.testing.assert_allclose(one.bodies["rope"].velocities[:, 1], 0.2, atol=1e-12)

    def test_sees_positions_velocities_and_time(self):
        one = simulator(rope())
        seen = []

        def force(x, v, t):
            seen.append((x, v, t))
            return numpy.zeros_like(x)
        one.add_force(force)
        one.step(3)
        before = one.state()
        seen.clear()
        one.step()
        x, v, t = seen[0]
        numpy.testing.assert_array_equal(x, before.positions)
        self.assertEqual((v.shape, x.flags.writeable, t), ((8, 3), False, before.time))

    def test_of_one_body_gets_its_rows(self):
        scene = rope()
        scene["bodies"]["other"] = {**scene["bodies"]["rope"], "place": {"position": [0, 5, 0]}}
        one = simulator(scene, overrides={"gravity": [0, 0, 0]})
        one.add_force(lambda x, v, t: numpy.ones((8, 3)), body="other")
        one.step(10)
        numpy.testing.assert_array_equal(one.bodies["rope"].velocities, 0.0)
        self.assertGreater(one.bodies["other"].velocities.min(), 0.0)

    def test_is_removed(self):
        one, twin = simulator(rope()), simulator(rope())

        def force(x, v, t):
            return numpy.ones_like(x)
        one.add_force(force)
        one.remove_force(force)
        with self.assertRaises(sprung.InputError):
            one.remove_force(force)
        for each in (one, twin):
            each.step(20)
        numpy.testing.assert_array_equal(one.bodies["rope"].particles, twin.bodies["rope"].particles)

    def test_that_raises_ends_the_step_at_its_begin(self):
        one = simulator(cloth())
        one.step(10)

        end = one.time + 5 * one.step_length

        def force(x, v, t):
            if t > end:
                raise ZeroDivisionError("of the force")
            return numpy.zeros_like(x)
        one.add_force(force)
        with self.assertRaisesRegex(ZeroDivisionError, "of the force"):
            one.step(100)
        self.assertLess(one.time, end + 2 * one.step_length)
        self.assertGreater(one.time, end - 2 * one.step_length)
        state = one.state()
        with self.assertRaises(ZeroDivisionError):
            one.step()
        self.assertEqual(one.state(), state)
        one.remove_force(force)
        one.step(100)

    def test_with_a_wrong_result_is_refused(self):
        for wrong in (lambda x, v, t: x[1:], lambda x, v, t: None, lambda x, v, t: "force", lambda x, v, t: x * numpy.nan,
                      lambda x, v, t: 1.0):
            one = simulator(rope())
            one.step(2)
            before = one.state()
            one.add_force(lambda x, v, t: wrong(x, v, t) if t > 0.0025 else 0 * x)
            one.step()
            with self.assertRaises(sprung.InputError) as caught:
                one.step()
            self.assertIn("added force", caught.exception.problems[0].key)
            self.assertAlmostEqual(one.time, 0.003, 12)
            with self.assertRaises(sprung.InputError):
                simulator(rope()).add_force(wrong)
            self.assertAlmostEqual(before.time, 0.002, 12)

    def test_may_not_use_its_simulator(self):
        one = simulator(rope())
        with self.assertRaisesRegex(RuntimeError, "in use"):
            one.add_force(lambda x, v, t: one.step())
        one.step()

    def test_a_copy_has_it_too(self):
        one = simulator(rope())
        one.add_force(lambda x, v, t: -0.1 * v)
        twin = one.copy()
        for each in (one, twin):
            each.step(50)
        self.assertEqual(one.state(), twin.state())


class PinForces(unittest.TestCase):
    def test_at_rest_they_carry_the_weight(self):
        one = simulator(cloth(), overrides={"output.forces": True, "obstacles": {}, "air.drag": 3})
        for _ in range(300):
            one.frame()
        forces = one.forces()
        self.assertEqual(forces.dtype.names, ("name", "force"))
        self.assertEqual(list(forces["name"]), ["hand"])
        numpy.testing.assert_allclose(forces["force"][0], [0, 0.2 * 9.81, 0], atol=0.05)

    def test_need_the_setting(self):
        with self.assertRaises(sprung.InputError) as caught:
            simulator(cloth()).forces()
        self.assertEqual(caught.exception.problems[0].key, "output.forces")


class ContactForces(unittest.TestCase):
    def test_at_rest_they_carry_the_weight(self):
        floor = {"shape": {"type": "half_space", "normal": [0, 1, 0], "offset": -1}}
        one = simulator(cloth(), overrides={"output.forces": True, "bodies.cloth.pins": [], "obstacles": {"floor": floor},
                                            "stretch_limit": None})
        for _ in range(200):
            one.frame()
        forces = one.contact_forces()
        self.assertEqual(forces.shape, one.bodies["cloth"].particles.shape)
        weight = one.bodies["cloth"].masses.sum() * 9.81
        numpy.testing.assert_allclose(forces.sum(axis=0), [0, weight, 0], atol=0.05 * weight)

    def test_need_the_setting(self):
        with self.assertRaises(sprung.InputError) as caught:
            simulator(cloth()).contact_forces()
        self.assertEqual(caught.exception.problems[0].key, "output.forces")


if __name__ == "__main__":
    unittest.main()
