"""The module that `cmake --install` installed."""
import os
import unittest

import sprung


class Installed(unittest.TestCase):
    def test_is_whole(self):
        folder = os.path.dirname(sprung.__file__)
        self.assertTrue(os.path.realpath(folder).startswith(os.path.realpath(os.environ["SPRUNG_INSTALLED"])), folder)
        for name in ("__init__.pyi", "py.typed"):
            self.assertTrue(os.path.isfile(os.path.join(folder, name)) and not os.path.islink(os.path.join(folder, name)), name)
        one = sprung.load(os.path.join(os.environ["SPRUNG_SOURCE_DIR"], "examples", "hanging_cloth.json")).simulator()
        one.step()
        self.assertGreater(one.time, 0.0)


if __name__ == "__main__":
    unittest.main()
