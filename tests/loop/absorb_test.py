"""The verb absorb from outside: a bed of a stranger, a bed of its own, several metals at once, ranks, bad input."""
import csv
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, MPIEXEC = sys.argv[1], sys.argv[2]
CASE = pathlib.Path(__file__).with_name("absorb_small.toml")
os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")


def layerloop(*arguments, ranks=1):
    start = [MPIEXEC, "-n", str(ranks), "--oversubscribe"] if ranks > 1 else []
    return subprocess.run([*start, PROGRAM, "absorb", *map(str, arguments)], capture_output=True, text=True, timeout=120)


def summary_of(folder):
    return json.loads((folder / "summary.json").read_text())


def write_hexagonal_layers(path, material=None):
    """Two close-packed layers (AB) of touching spheres of 30 um on a floor, periodic."""
    d, root3 = 30e-6, math.sqrt(3)
    rows = [f"# periodic_x={d} periodic_y={d * root3} floor_z=0 units=m density=7900\n# x,y,z,radius,material\n"]
    for layer in range(2):
        for place in range(2):
            x, y = 0.25 + 0.5 * place, (0.2 + layer * root3 / 3 + place * root3 / 2) % root3
            z = 0.5 + layer * math.sqrt(2 / 3)
            rows.append(f"{x * d!r},{y * d!r},{z * d!r},{0.5 * d!r},{0 if material is None else material[layer]}\n")
    path.write_text("".join(rows))


class Absorb(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="layerloop-test-"))
        cls.bed = cls.folder / "hexagonal.csv"
        write_hexagonal_layers(cls.bed)
        cls.out = cls.folder / "hexagonal"
        done = layerloop("--bed", cls.bed, "--refractive-index", "3.27,4.48", "--target-se", "5e-4", "-o", cls.out,
                         "--derivatives")
        assert done.returncode == 0, done.stderr
        cls.words = done.stdout
        cls.summary = summary_of(cls.out)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def test_lattice_absorbs_what_other_codes_found(self):
        # Two hexagonal layers on a floor of the same steel: 0.5948 (4e5 paths, error 0.0005 at most).
        self.assertLessEqual(self.summary["standard_error"], 5e-4)
        self.assertAlmostEqual(self.summary["absorptivity"], 0.5948, delta=3 * math.hypot(5e-4, 5e-4))
        self.assertTrue(self.summary["target_reached"])

    def test_keys_of_the_contract(self):
        s = self.summary
        self.assertEqual(s["verb"], "absorb")
        for key in ("absorptivity", "standard_error", "rays", "mean_bounces", "by_material", "depth_profile", "ledger",
                    "absorptivity_u_num", "absorptivity_n", "wall_time", "definitions"):
            self.assertIn(key, s)
        for key in ("power_incident", "power_absorbed", "power_escaped", "power_residual", "ray_energy_relative_error"):
            self.assertIn(key, s["ledger"])
        self.assertNotIn("absorptivity_u_bed", s)  # one bed says nothing of others
        self.assertLess(s["ledger"]["ray_energy_relative_error"], 1e-12)
        self.assertAlmostEqual(sum(l["fraction"] for l in s["depth_profile"]), s["absorptivity"], delta=1e-11)
        self.assertAlmostEqual(sum(s["by_material"].values()), s["absorptivity"], delta=1e-11)
        self.assertEqual(s["beds"][0]["grains"], 4)
        # Two layers of pi/6 d^3 over sqrt(3)/2 d^2 each.
        self.assertAlmostEqual(s["beds"][0]["solid_thickness"] / 30e-6, 2 * math.pi / 6 / (math.sqrt(3) / 2), delta=1e-9)
        self.assertIn("given with the case", s["materials"]["316L"]["source"])
        self.assertGreater(s["sets"][0]["derivatives"]["316L"]["d_n"], 0)

    def test_tables_and_page(self):
        with open(self.out / "depth_profile.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertAlmostEqual(sum(float(r["absorbed fraction"]) for r in rows), self.summary["absorptivity"], delta=1e-7)
        with open(self.out / "absorptivity_map.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertTrue(all(float(r["standard error"]) >= 0 for r in rows))
        with open(self.out / "grains.csv") as file:
            shares = sum(float(r["absorbed share"]) for r in csv.DictReader(file))
        self.assertAlmostEqual(shares + self.summary["substrate"], self.summary["absorptivity"], delta=1e-7)
        page = (self.out / "report.html").read_text()
        for word in ("data:image/png;base64", "depth_profile.csv", "absorptivity_map.csv", "standard error"):
            self.assertIn(word, page)
        for outside in ("https://", "src=\"http", "href=\"http", "url("):
            self.assertNotIn(outside, page)
        self.assertIn(f"absorptivity {self.summary['absorptivity']:.4f}", self.words)

    def test_many_metals_share_one_trace(self):
        out = self.folder / "metals"
        done = layerloop("--bed", self.bed, "--set", "absorb.target_standard_error=0", "--materials",
                         "Ti-6Al-4V,Cu (Babar 2015)", "--wavelengths", "515 nm", "--temperatures", "1500 K", "-o", out,
                         "--quiet", "--set", "run.pictures=false")
        self.assertEqual(done.returncode, 0, done.stderr)
        sets = {s["name"]: s for s in summary_of(out)["sets"]}
        self.assertEqual(list(sets), ["the case", "Ti-6Al-4V", "Cu (Babar 2015)", "515 nm", "1500 K"])
        alone = self.folder / "alone"
        layerloop("--bed", self.bed, "--set", "absorb.target_standard_error=0", "--set", "powder.material=Ti-6Al-4V",
                  "-o", alone, "--quiet", "--set", "run.pictures=false")
        self.assertEqual(summary_of(alone)["absorptivity"], sets["Ti-6Al-4V"]["absorptivity"])  # to the bit
        self.assertLess(sets["Cu (Babar 2015)"]["absorptivity"], 0.1)
        self.assertNotEqual(sets["1500 K"]["absorptivity"], sets["the case"]["absorptivity"])

    def test_each_metal_has_its_share(self):
        mixed = self.folder / "mixed.csv"
        write_hexagonal_layers(mixed, [0, 1])  # steel below, copper above
        case = self.folder / "mixed.toml"
        case.write_text('[powder]\nmaterial = "316L"\n[powder.mixture]\n316L = 0.5\nCu = 0.5\n[laser]\nwavelength = '
                        '"1070 nm"\n[optics]\nuniform_beam = true\nfloor = "black"\n[run]\npictures = false\n')
        out = self.folder / "mixed"
        done = layerloop(case, "--bed", mixed, "-o", out, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        shares = summary_of(out)["by_material"]
        self.assertEqual(set(shares), {"316L", "Cu", "black"})
        self.assertAlmostEqual(sum(shares.values()), summary_of(out)["absorptivity"], delta=1e-11)
        self.assertGreater(shares["316L"], shares["Cu"])

    def test_ranks_give_the_same_bits(self):
        one, two = self.folder / "one", self.folder / "two"
        for out, ranks in ((one, 1), (two, 2)):
            done = layerloop(CASE, "-o", out, "--quiet", "--threads", 1, ranks=ranks)
            self.assertEqual(done.returncode, 0, done.stderr)
        a, b = summary_of(one), summary_of(two)
        a.pop("wall_time"), b.pop("wall_time")
        self.assertEqual(a, b)
        self.assertEqual(a["absorptivity_n"], 2)
        self.assertGreater(a["absorptivity_u_bed"], 0)
        self.assertEqual([bed["name"] for bed in a["beds"]], ["seed 3", "seed 4"])
        self.assertIn("Fe (Johnson 1974)", a["materials"]["316L"]["source"])
        self.assertTrue(all(bed["grains"] == 40 for bed in a["beds"]))

    def test_bad_input_is_refused_with_a_word(self):
        for arguments, word in (([], "--bed"), (["--bed", self.bed, "--materials", "Unobtainium"], "Unobtainium"),
                                (["--bed", self.bed, "--set", "laser.wavelength=10.6 um"], "is known from"),
                                (["--bed", self.bed, "--wavelengths", "10.6 um"], "is known from"),
                                (["--bed", self.bed, "--set", "optics.oxide_index=[0, 1]"], "n = 0"),
                                (["--bed", self.bed, "--set", "powder.material=Cu", "--set", "optics.oxide_thickness=20 nm"],
                                 "oxide"),
                                (["--bed", self.bed, "--refractive-index", "nan,4"], "refractive_index")):
            done = layerloop(*arguments, "-o", self.folder / "bad", "--quiet")
            self.assertEqual(done.returncode, 2, (arguments, done.stderr))
            self.assertIn(word, done.stderr)
        done = layerloop("--bed", self.folder / "nowhere.csv", "-o", self.folder / "bad", "--quiet")
        self.assertEqual(done.returncode, 4, done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
