"""The verb spread from outside: layers without a laser, replicates, a bed from a file, exports, resume."""
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

PROGRAM, MPIEXEC = sys.argv[1], sys.argv[2]
CASE = pathlib.Path(__file__).with_name("spread_small.toml")
os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")


def layerloop(*arguments, ranks=1):
    start = [MPIEXEC, "-n", str(ranks), "--oversubscribe"] if ranks > 1 else []
    return subprocess.run([*start, PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=300)


def position(folder, layer):
    with h5py.File(folder / f"bed_{layer:04}.h5") as file:
        return file["bed/position"][()]


class Spread(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="layerloop-test-"))
        cls.out = cls.folder / "out"
        done = layerloop("spread", CASE, "-o", cls.out, "--quiet", "--threads", 1, "--export", "csv", "--export", "dump",
                         "--export", "extxyz")
        assert done.returncode == 0, done.stderr
        cls.summary = json.loads((cls.out / "summary.json").read_text())
        cls.seeds = [json.loads((cls.out / f"seed_{s}" / "summary.json").read_text()) for s in (5, 6, 7)]

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def test_keys_of_the_contract(self):
        for summary in (self.summary, self.seeds[0]):
            self.assertEqual(summary["verb"], "spread")
            for key in ("heap_angle_accumulation", "heap_angle_deposition", "reservoir_mean_diameter",
                        "reservoir_mass_ratio", "settled_height", "settled_density", "ledger", "wall_time"):
                self.assertIn(key, summary)
            self.assertEqual(len(summary["layers"]), 2)
            self.assertEqual(len(summary["bins"]), 5)
            for key in ("x", "relative_density", "effective_thickness", "mean_diameter"):
                self.assertIn(key, summary["bins"][0])
            for layer in summary["layers"]:
                for key in ("effective_thickness", "real_effective_thickness", "void_layer", "volume_fraction_nominal",
                            "volume_fraction_real", "surface_coverage", "roughness_sa", "d10", "d50", "d90"):
                    self.assertIn(key, layer)
                self.assertNotIn("absorptivity", layer)

    def test_values_are_plausible(self):
        for seed in self.seeds:
            self.assertTrue(0.45 < seed["settled_density"] < 0.66, seed["settled_density"])
            self.assertTrue(0 < seed["reservoir_mass_ratio"] < 1)
            self.assertTrue(0 < seed["layers"][0]["surface_coverage"] < 1)
            for layer in seed["layers"]:
                self.assertAlmostEqual(layer["real_effective_thickness"],
                                       layer["void_layer"] - 50e-6 + layer["effective_thickness"], delta=1e-12)

    def test_means_and_intervals_over_seeds(self):
        values = np.array([seed["layers"][1]["void_layer"] for seed in self.seeds])
        layer = self.summary["layers"][1]
        self.assertAlmostEqual(layer["void_layer"], values.mean(), delta=1e-15)
        self.assertAlmostEqual(layer["void_layer_u_bed"] / (4.302653 * values.std(ddof=1) / math.sqrt(3)), 1, delta=1e-6)
        self.assertEqual(layer["void_layer_n"], 3)
        self.assertGreater(layer["void_layer_u_bed"], 0)
        self.assertEqual(self.summary["ledger"]["particles_fed"], sum(s["ledger"]["particles_fed"] for s in self.seeds))

    def test_surface_coverage_is_that_of_the_discs(self):
        # Layer 1 lies on bare plate: every grain with its centre in the zone is new. Counted on a fine grid.
        with h5py.File(self.out / "seed_5" / "bed_0001.h5") as file:
            xyz, radius = file["bed/position"][()], file["bed/radius"][()]
        begin, end, width, margin = 200e-6, 400e-6, 130e-6, 50e-6
        grid = 0.25e-6
        x = np.arange(begin + margin, end - margin, grid) + grid / 2
        y = np.arange(0, width, grid) + grid / 2
        covered = np.zeros((len(x), len(y)), bool)
        for (gx, gy, _), r in zip(xyz, radius):
            if begin <= gx < end:
                dy = y - gy - width * np.round((y - gy) / width)
                covered |= (x[:, None] - gx) ** 2 + dy[None, :] ** 2 < r * r
        self.assertAlmostEqual(self.seeds[0]["layers"][0]["surface_coverage"], covered.mean(), delta=2e-3)

    def test_every_file_is_there(self):
        for name in ("report.html", "summary.json", "case_resolved.toml", "layers.csv", "profiles.csv", "seed_5/report.html",
                     "seed_7/bed_0002.h5", "seed_6/checkpoint_0002.h5"):
            self.assertGreater((self.out / name).stat().st_size, 0, name)
        page = (self.out / "report.html").read_text()
        self.assertIn("95 % t-interval", page)
        self.assertNotIn("nan", page.split("<body>")[1].lower().replace("nano", ""))
        lines = (self.out / "profiles.csv").read_text().splitlines()
        self.assertEqual(len(lines), 1 + 2 * 5)
        self.assertEqual({line.count(",") for line in lines}, {lines[0].count(",")})

    def test_exports_hold_the_bed(self):
        run = self.out / "seed_6"
        bed = position(run, 2)
        rows = np.loadtxt(run / "bed_0002.csv", delimiter=",", comments="#", ndmin=2)
        np.testing.assert_array_equal(rows[:, :3], bed)
        self.assertTrue((run / "bed_0002.csv").read_text().startswith("# periodic_y="))
        dump = np.loadtxt((run / "bed_0002.dump").read_text().splitlines()[9:], ndmin=2)
        np.testing.assert_array_equal(dump[:, 2:5], bed)
        extxyz = (run / "bed_0002.extxyz").read_text().splitlines()
        self.assertEqual(int(extxyz[0]), len(bed))
        np.testing.assert_array_equal(np.array([line.split()[1:4] for line in extxyz[2:]], float), bed)

    def test_two_ranks_agree(self):
        out = self.folder / "ranks"
        done = layerloop("spread", CASE, "-o", out, "--quiet", "--set", "run.replicates=1", "--threads", 1, ranks=2)
        self.assertEqual(done.returncode, 0, done.stderr)
        for layer in (1, 2):
            np.testing.assert_array_equal(position(out, layer), position(self.out / "seed_5", layer))
        single = json.loads((out / "summary.json").read_text())
        self.assertEqual(single["layers"], self.seeds[0]["layers"])

    def test_resume_takes_up_where_it_stopped(self):
        out = self.folder / "resumed"
        shutil.copytree(self.out, out)
        for name in ("seed_7", "seed_6/checkpoint_0002.h5", "seed_6/bed_0002.h5"):
            shutil.rmtree(out / name) if (out / name).is_dir() else (out / name).unlink()
        done = layerloop("spread", CASE, "-o", out, "--quiet", "--threads", 1, "--resume")
        self.assertEqual(done.returncode, 0, done.stderr)
        again = json.loads((out / "summary.json").read_text())
        self.assertEqual(again["layers"], self.summary["layers"])
        np.testing.assert_array_equal(position(out / "seed_7", 2), position(self.out / "seed_7", 2))

    def test_a_bed_from_a_file_takes_the_place_of_the_feed(self):
        # What is left in the reservoir; the grains on the plate lie below z = 0, the plate's top before layer 1.
        lines = (self.out / "seed_5" / "bed_0001.csv").read_text().splitlines()
        left = [line for line in lines[2:] if float(line.split(",")[0]) < 130e-6]
        bed = self.folder / "left.csv"
        bed.write_text("\n".join(lines[:2] + left) + "\n")
        out = self.folder / "from_file"
        done = layerloop("spread", CASE, "-o", out, "--quiet", "--threads", 1, "--set", "run.replicates=1", "--set",
                         "run.layers=1", "--set", f"powder.bed={bed}", "--set", "powder.particles=100")
        self.assertEqual(done.returncode, 0, done.stderr)
        ledger = json.loads((out / "summary.json").read_text())["ledger"]
        self.assertEqual(ledger["particles_fed"], len(left) + 100)
        self.assertLess(ledger["mass_relative_error"], 1e-12)

    def test_a_mixture_is_weighed_grain_by_grain(self):
        out = self.folder / "mixture"
        done = layerloop("spread", CASE, "-o", out, "--quiet", "--threads", 1, "--set", "run.replicates=1", "--set",
                         "powder.mixture.IN718=0.4", "--set", "powder.mixture.Al=0.6", "--set",
                         "contact.Al.wall.sliding_friction=0.3")
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = json.loads((out / "summary.json").read_text())

        def masses(layer):
            with h5py.File(out / f"bed_{layer:04}.h5") as file:
                x, radius, material = (file[f"bed/{name}"][()] for name in ("position", "radius", "material"))
            mass = 4 / 3 * math.pi * radius**3 * np.array([8190, 2700])[material]  # IN718, Al
            return x[:, 0], mass, material

        x, mass, material = masses(1)
        spread = (x >= 200e-6) & (x < 400e-6)  # layer 1 lies on bare plate: every grain in the zone is new
        shares = summary["layers"][0]["by_material"]
        share = mass[spread & (material == 1)].sum() / mass[spread].sum()
        self.assertAlmostEqual(shares["Al"]["mass_share_layer"], share, delta=1e-12)
        self.assertAlmostEqual(shares["Al"]["mass_share_layer"], 0.6, delta=4 * shares["Al"]["mass_share_layer_u_num"])
        for kind in ("mass_share_fed", "mass_share_layer"):
            self.assertAlmostEqual(shares["Al"][kind] + shares["IN718"][kind], 1, delta=1e-12)
        ledger = summary["ledger"]
        self.assertAlmostEqual(ledger["mass_bed"] / masses(2)[1].sum(), 1, delta=1e-12)
        self.assertLess(ledger["mass_relative_error"], 1e-12)
        self.assertNotIn("by_material", self.seeds[0]["layers"][0])

    def test_a_bed_beside_the_machine_is_bad_input(self):
        bed = self.folder / "beside.csv"
        bed.write_text("# units=m\n# x,y,z,radius\n1e-4,1e-5,1e-5,1e-5\n5e-3,1e-5,1e-5,1e-5\n")
        done = layerloop("spread", CASE, "-o", self.folder / "never", "--set", f"powder.bed={bed}")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("outside the machine", done.stderr)
        bed.write_text("# units=m\n# x,y,z,radius\n1e-4,1e-5,1e-5\n")
        done = layerloop("spread", CASE, "-o", self.folder / "never", "--set", f"powder.bed={bed}")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("beside.csv:3:", done.stderr)
        self.assertFalse((self.folder / "never").exists())

    def test_dry_run_computes_nothing(self):
        done = layerloop("spread", CASE, "--dry-run")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("time_steps", done.stdout)
        self.assertIn("particles", done.stdout)
        self.assertEqual(layerloop("spread", CASE).returncode, 2)

    def test_frozen_zone_without_laser(self):
        out = self.folder / "frozen"
        done = layerloop("spread", CASE, "-o", out, "--quiet", "--threads", 1, "--set", "run.replicates=1", "--set",
                         "machine.frozen_zone=[2.5e-4, 3.5e-4]", "--set", "heat.cell_size=5 um")
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = json.loads((out / "summary.json").read_text())
        self.assertGreater(summary["ledger"]["particles_melted"], 0)
        self.assertIn("part_relative_density", summary["layers"][0])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
