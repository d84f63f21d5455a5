"""Steps of 1 to 5 Rayleigh times: refused as input, and stopped at once, with the remedy, where they are forced.

usage: time_step_test.py LAYERLOOP
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv[1]
CASE = pathlib.Path(__file__).with_name("small.toml")


def run(verb, folder, *settings):
    options = [word for setting in settings for word in ("--set", setting)]
    return subprocess.run([PROGRAM, verb, CASE, "-o", folder, "--quiet", "--threads", "1", *options],
                          capture_output=True, text=True, timeout=60)


class UnstableStep(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory(prefix="layerloop-step-")
        self.folder = pathlib.Path(self.scratch.name) / "out"

    def tearDown(self):
        self.scratch.cleanup()

    def test_is_refused_as_input(self):
        for verb in ("run", "spread"):
            for times in (0.16, 1, 1.1, 2, 5):
                done = run(verb, self.folder, f"contact.time_step_fraction={times}")
                self.assertEqual(done.returncode, 2, f"{verb} {times}: {done.stderr}")
                self.assertIn("above the stable limit", done.stderr)
                self.assertFalse(self.folder.exists())

    def test_is_stopped_with_the_remedy_when_forced(self):
        for verb in ("run", "spread"):
            for times in (1, 1.1, 2, 5):
                done = run(verb, self.folder, f"contact.time_step_fraction={times}", "run.unsafe_time_step=true")
                self.assertEqual(done.returncode, 3, f"{verb} {times}: {done.stderr}")
                self.assertIn("use a smaller contact.time_step_fraction", done.stderr)
                self.assertEqual(list(self.folder.glob("bed_*")), [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
