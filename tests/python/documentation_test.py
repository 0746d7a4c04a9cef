"""Laws of help(sprung)."""
import inspect
import pydoc
import unittest

import sprung

NUMBERS = {"positions", "particles", "velocities", "vertices", "rest_lengths", "stiffness", "damping", "masses", "tension"}


def members(thing):
    return {name: value for name, value in vars(thing).items() if not name.startswith("_")}


class Documentation(unittest.TestCase):
    def test_everything_public_is_described(self):
        for name in sprung.__all__:
            thing = getattr(sprung, name)
            self.assertTrue(inspect.getdoc(thing), name)
            self.assertEqual(thing.__module__, "sprung", name)
            if inspect.isclass(thing) and not issubclass(thing, (Exception, tuple)):
                for member, value in members(thing).items():
                    self.assertTrue(inspect.getdoc(value), f"{name}.{member}")

    def test_functions_show_their_arguments(self):
        for thing in [sprung] + [getattr(sprung, name) for name in sprung.__all__ if inspect.isclass(getattr(sprung, name))]:
            for name, value in members(thing).items():
                if inspect.isroutine(value):
                    arguments = inspect.signature(getattr(thing, name)).parameters
                    self.assertEqual("self" in arguments, thing is not sprung, name)
        self.assertEqual(str(inspect.signature(sprung.Simulator.step)), "(self, /, steps=1)")
        self.assertEqual(list(inspect.signature(sprung.Simulator).parameters)[:2], ["network", "step"])

    def test_arrays_have_units_and_shapes(self):
        for thing in (sprung.Body, sprung.Springs, sprung.State, sprung.Network):
            for name, value in members(thing).items():
                if name not in NUMBERS:
                    continue
                self.assertRegex(value.__doc__, r"\[(m|m/s|kg|N|N/m|N s/m)\]|k_[sd]", f"{thing.__name__}.{name}")
                self.assertRegex(value.__doc__, r"\((n|m|k), ?3?\)", f"{thing.__name__}.{name}")

    def test_help_names_no_cpp(self):
        text = pydoc.plain(pydoc.render_doc(sprung))
        for word in ("std::", "sprung::", " object at 0x"):
            self.assertFalse(word in text, word)


if __name__ == "__main__":
    unittest.main()
