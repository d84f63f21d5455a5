"""The layer loop as a user runs it: results, ledgers, resume, ranks, exit codes.

usage: layer_loop_test.py LAYERLOOP MPIEXEC     (the program, and what starts it on several ranks)
"""
import json
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np

PROGRAM, MPIEXEC = sys.argv[1:3]
CASE = pathlib.Path(__file__).with_name("small.toml")


def layerloop(*arguments, ranks=1):
    start = [MPIEXEC, "-n", str(ranks), "--oversubscribe", "--allow-run-as-root"] if ranks > 1 else []
    return subprocess.run([*start, PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=600)


def arrays(path, group):
    """Every dataset below a group, by name."""
    found = {}
    with h5py.File(path) as file:
        file[group].visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found


class LayerLoop(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="layerloop-test-"))
        cls.text = CASE.read_bytes()
        cls.out = cls.folder / "out"
        done = layerloop("run", CASE, "-o", cls.out, "--quiet", "--threads", 1)
        assert done.returncode == 0, done.stderr
        cls.summary = json.loads((cls.out / "summary.json").read_text())

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def run_again(self, name, *arguments, ranks=1):
        out = self.folder / name
        done = layerloop("run", CASE, "-o", out, "--quiet", *arguments, ranks=ranks)
        self.assertEqual(done.returncode, 0, done.stderr)
        return out

    def assert_same_bits(self, left, right, names):
        for name, group in names:
            a, b = arrays(left / name, group), arrays(right / name, group)
            self.assertEqual(a.keys(), b.keys())
            for key in a:
                self.assertTrue(np.array_equal(a[key], b[key]), f"{name}:{group}/{key} differs")

    def assert_same_layers(self, left, right):
        self.assert_same_bits(left, right, [("bed_0001.h5", "bed"), ("bed_0002.h5", "bed")])
        for solid in ("solid_0001.stl", "solid_0002.stl"):
            self.assertEqual((left / solid).read_bytes(), (right / solid).read_bytes(), solid)

    def write_box(self, name, height=20e-6, triangles=12):
        """A box 60 x 60 um on the plate; with fewer than 12 triangles it has a hole."""
        lower, upper = np.array([280e-6, 30e-6, 0]), np.array([340e-6, 90e-6, height])
        corner = [np.where([c & 1, c & 2, c & 4], upper, lower) for c in range(8)]
        faces = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4),
                 (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]
        text = "solid box\n"
        for face in faces[:triangles]:
            text += "facet normal 0 0 0\nouter loop\n"
            text += "".join("vertex {:.9e} {:.9e} {:.9e}\n".format(*corner[c]) for c in face)
            text += "endloop\nendfacet\n"
        path = self.folder / name
        path.write_text(text + "endsolid box\n")
        return path

    def test_files_are_there_and_the_case_is_untouched(self):
        for name in ("report.html", "summary.json", "case_resolved.toml", "log.jsonl", "bed_0001.h5", "bed_0002.h5",
                     "heat_0001.h5", "heat_0002.h5", "solid_0001.stl", "solid_0002.stl", "checkpoint_0002.h5"):
            self.assertGreater((self.out / name).stat().st_size, 0, name)
        self.assertEqual(CASE.read_bytes(), self.text)
        self.assertEqual(list(self.out.glob("*.tmp")), [])

    def test_layers_are_plausible(self):
        self.assertEqual(len(self.summary["layers"]), 2)
        for layer in self.summary["layers"]:
            # separate grains on a flat plate have 0.8, whatever their sizes; beside a part that rises they may have more,
            # but what lies between the old surface and the new one can never exceed the room there
            self.assertTrue(0.2 < layer["volume_fraction_real"] < (0.81 if layer["layer"] == 1 else 1))
            self.assertTrue(0 < layer["surface_coverage"] <= 1)
            self.assertTrue(0.2 < layer["absorptivity"] < 1)
            self.assertTrue(0 < layer["absorptivity_u_num"] < 0.05)
            self.assertGreater(layer["melted_mass"], 0)
            self.assertGreater(layer["pool"]["width"], 0)
            self.assertTrue(0.5 < layer["part_relative_density"] <= 1)

    def test_void_layer_follows_equation_14(self):
        # VL(n+1) = NLT(n+1) + NLT(n) - ELT(n) holds for the surface that the next blade meets, so for layer 1: VL = NLT.
        self.assertAlmostEqual(self.summary["layers"][0]["void_layer"], 50e-6, delta=1e-9)
        for layer in self.summary["layers"]:  # RELT = VL - NLT + ELT
            self.assertAlmostEqual(layer["real_effective_thickness"],
                                   layer["void_layer"] - 50e-6 + layer["effective_thickness"], delta=1e-12)

    def test_ledgers_close(self):
        ledger = self.summary["ledger"]
        self.assertEqual(ledger["particles_fed"], ledger["particles_bed"] + ledger["particles_overflow"] +
                         ledger["particles_melted"] + ledger["particles_lost"])
        self.assertEqual(ledger["particles_lost"], 0)
        self.assertGreater(ledger["particles_melted"], 0)
        mass = ledger["mass_bed"] + ledger["mass_overflow"] + ledger["mass_melted"] + ledger["mass_lost"]
        self.assertAlmostEqual(mass / ledger["mass_fed"], 1, delta=1e-13)
        light = sum(ledger["power_" + way] for way in ("absorbed", "escaped", "attenuated", "residual"))
        self.assertAlmostEqual(light / ledger["power_incident"], 1, delta=1e-12)
        self.assertLess(ledger["power_residual"] / ledger["power_incident"], 1e-6)
        heat = ledger["heat_stored"] + ledger["heat_out"]
        self.assertAlmostEqual(heat / ledger["heat_in"], 1, delta=1e-8)

    def test_bed_file_holds_the_mass_of_the_ledger(self):
        radius = arrays(self.out / "bed_0002.h5", "bed")["radius"]
        mass = 8190 * np.sum(4 / 3 * np.pi * radius**3)
        self.assertAlmostEqual(mass / self.summary["ledger"]["mass_bed"], 1, delta=1e-12)

    def test_resume_equals_an_uninterrupted_run(self):
        out = self.run_again("resumed", "--threads", 1, "--set", "run.layers=1")
        self.assertFalse((out / "bed_0002.h5").exists())
        self.run_again("resumed", "--threads", 1, "--resume")
        self.assert_same_layers(self.out, out)
        self.assertEqual(self.summary["layers"], json.loads((out / "summary.json").read_text())["layers"])

    def test_signal_stops_in_order_and_resume_equals_an_uninterrupted_run(self):
        out = self.folder / "signalled"
        run = subprocess.Popen([PROGRAM, "run", CASE, "-o", out, "--quiet", "--threads", "1"], stderr=subprocess.PIPE, text=True)
        while run.poll() is None and not (out / "checkpoint_0001.xxh3").exists():
            time.sleep(0.01)
        run.send_signal(signal.SIGUSR1)
        _, told = run.communicate(timeout=120)
        self.assertEqual(run.returncode, 5, told)
        self.assertIn("--resume", told)
        self.run_again("signalled", "--threads", 1, "--resume")
        self.assert_same_layers(self.out, out)

    def test_resume_passes_over_a_damaged_checkpoint(self):
        out = self.folder / "damaged"
        shutil.copytree(self.out, out)
        newest = out / "checkpoint_0002.h5"
        bits = bytearray(newest.read_bytes())
        bits[len(bits) // 2] ^= 1
        newest.write_bytes(bits)
        (out / "bed_0002.h5").unlink()
        self.run_again("damaged", "--threads", 1, "--resume")
        self.assert_same_layers(self.out, out)

    def test_resume_refuses_another_case(self):
        done = layerloop("run", CASE, "-o", self.out, "--quiet", "--resume", "--set", "laser.power=90 W")
        self.assertEqual(done.returncode, 2)
        self.assertIn("another case", done.stderr)

    def test_threads_do_not_matter(self):
        out = self.run_again("threads", "--threads", 2)
        self.assert_same_layers(self.out, out)
        for name in ("bed_0001.h5", "heat_0002.h5"):  # no dates inside: equal contents are equal bytes
            self.assertEqual((self.out / name).read_bytes(), (out / name).read_bytes(), name)

    def test_two_ranks_agree(self):
        out = self.run_again("ranks", "--threads", 1, ranks=2)
        self.assert_same_layers(self.out, out)
        for heat in ("heat_0001.h5", "heat_0002.h5"):
            a, b = arrays(self.out / heat, "VTKHDF/PointData"), arrays(out / heat, "VTKHDF/PointData")
            self.assertTrue(np.array_equal(a["melted"], b["melted"]))
            np.testing.assert_allclose(b["peak_temperature"], a["peak_temperature"], rtol=1e-10)

    def test_bad_input_is_told_before_anything_is_made(self):
        out = self.folder / "never"
        done = layerloop("run", CASE, "-o", out, "--set", "laser.powr=180 W", "--set", "scan.track_length=5 mm")
        self.assertEqual(done.returncode, 2)
        self.assertIn('did you mean "power"', done.stderr)
        self.assertIn("track_length", done.stderr)
        self.assertFalse(out.exists())

    def test_substrate_with_a_hole_is_bad_input(self):
        out = self.folder / "never"
        done = layerloop("run", CASE, "-o", out, "--set", f"machine.substrate={self.write_box('hole.stl', triangles=11)}")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("hole", done.stderr)
        self.assertFalse(out.exists())

    def test_substrate_is_there_for_blade_and_laser(self):
        box = self.write_box("box.stl")
        out = self.run_again("substrate", "--set", f"machine.substrate={box}", "--set", "run.layers=1")
        layer = json.loads((out / "summary.json").read_text())["layers"][0]
        # 60 x 60 x 20 um of the zone's 200 x 130 um stand in the void: the mean void layer is 50 um less 2.77 um.
        # (measured over the interior, which the box fills more of)
        self.assertLess(layer["void_layer"], 48e-6)

    def test_missing_case_is_file_trouble(self):
        self.assertEqual(layerloop("run", self.folder / "none.toml", "-o", self.folder / "never").returncode, 4)

    def test_unstable_step_is_stopped_with_a_remedy(self):
        for fraction in (1.1, 5):
            done = layerloop("run", CASE, "-o", self.folder / "unstable", "--quiet", "--set", "run.unsafe_time_step=true",
                             "--set", f"contact.time_step_fraction={fraction}")
            self.assertEqual(done.returncode, 3, done.stderr)
            self.assertIn("time_step_fraction", done.stderr)

    def test_blade_against_raised_solid_stops_or_is_reported(self):
        # The box stands 10 um above the platforms once the plate has gone down by its first 50 um.
        raised = f"machine.substrate={self.write_box('raised.stl', height=60e-6)}"
        done = layerloop("run", CASE, "-o", self.folder / "stopped", "--quiet", "--set", raised)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("blade", done.stderr)
        self.assertIn("layer_thickness", done.stderr)
        out = self.run_again("reported", "--set", raised, "--set", "machine.blade_collision=report", "--set", "run.layers=1")
        self.assertIn("above the blade", json.loads((out / "summary.json").read_text())["layers"][0]["blade_note"])

    def test_frozen_zone_runs_without_laser(self):
        out = self.run_again("frozen", "--set", "machine.frozen_zone=[2.5e-4, 3.5e-4]")
        summary = json.loads((out / "summary.json").read_text())
        self.assertGreater(summary["ledger"]["particles_melted"], 0)
        self.assertNotIn("absorptivity", summary["layers"][0])
        self.assertLess(summary["layers"][0]["part_relative_density"], 0.8)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
