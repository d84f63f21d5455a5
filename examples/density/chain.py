"""The program's chain for one row: a bed, its absorptivity, and the melt pool. What was run once is not run again."""
import hashlib
import json
import math
import pathlib
import subprocess

from eagar_tsai import ALSI10MG, pool

HERE = pathlib.Path(__file__).parent
SIZES, SHARES = (0.6, 0.8, 1.0, 1.2, 1.45), (0.15, 0.2, 0.3, 0.2, 0.15)  # over D50, by volume; only D50 is told
SIDE = 400e-6  # of the settled bed [m]
USUAL_ABSORPTIVITY = 0.3  # for the size of the grid alone


class Chain:
    """`cells` make the spot's diameter."""

    def __init__(self, program, out, cells=7):
        self.program, self.out, self.cells = program.resolve(), out.resolve(), cells
        out.mkdir(parents=True, exist_ok=True)

    def run(self, verb, case, settings, arguments=()):
        """Folder of a run; None where a guard of the physics stopped it."""
        told = json.dumps([verb, (HERE / case).read_text(), sorted(settings.items()), [str(a) for a in arguments]])
        folder = self.out / hashlib.sha256(told.encode()).hexdigest()[:16]
        if (folder / "stopped.txt").exists():
            return None
        if not (folder / "summary.json").exists():
            sets = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
            run = subprocess.run([self.program, verb, HERE / case, *arguments, *sets, "-o", folder, "--quiet", "--threads", "1"],
                                 capture_output=True, text=True, cwd=self.out)
            if run.returncode == 3:
                (folder / "stopped.txt").write_text(run.stderr)
                return None
            if run.returncode:
                raise RuntimeError(f"{' '.join(map(str, run.args))}\n{run.stderr}")
            for large in (*folder.glob("*.h5"), *folder.glob("*.stl"), *folder.glob("*.html")):
                large.unlink()
        return folder

    def bed(self, d50, layer, seed):
        """Grains on a level plate, as much metal as a solid layer so thick: what each layer takes in the steady state."""
        diameters = [round(d50 * ratio, 9) for ratio in SIZES]
        mean_volume = 1 / sum(share / (math.pi / 6 * d**3) for share, d in zip(SHARES, diameters))
        return self.run("absorb", "bed.toml", {"powder.diameters": str(diameters), "powder.fractions": str(list(SHARES)),
                                               "powder.particles": round(layer * SIDE**2 / mean_volume), "case.seed": seed})

    def absorptivity(self, d50, layer, seed):
        return summary(self.bed(d50, layer, seed))["absorptivity"]

    def settings(self, power, speed, spot):
        width, _, length = pool(ALSI10MG, USUAL_ABSORPTIVITY * power, speed, spot)
        width, track = max(width, spot), max(500e-6, round(length + 2 * spot, 6))
        return {"laser.power": power, "laser.spot_diameter": spot, "scan.scan_speed": speed, "scan.track_length": track,
                "heat.cell_size": round(spot / self.cells, 9),
                "heat.size": str([round(track + 2.5 * width, 6), round(3 * width, 6), round(2.5 * width, 6)])}

    def on_powder(self, power, speed, spot, d50, layer, seed, mixing=1):
        """A track over the bed, light and keyhole traced; depth below the plate that the powder lay on. The melt conducts
        `mixing` times as well: its flow, in the simplest form (Lampa et al., Int. J. Heat Mass Transf. 40 (1997) 1239)."""
        bed = self.bed(d50, layer, seed) / "bed_0001.csv"
        flow = {"effects.marangoni.enabled": "true", "effects.marangoni.lateral_factor": mixing,
                "effects.marangoni.vertical_factor": mixing} if mixing != 1 else {}
        return summary(self.run("melt", "track.toml", {**self.settings(power, speed, spot), "effects.keyhole.enabled": "true",
                                                       **flow}, ["--bed", bed]))

    def on_plate(self, power, speed, spot, absorptivity):
        """A track on the bare plate, with an absorptivity that is given and without a keyhole."""
        return summary(self.run("melt", "track.toml", {**self.settings(power, speed, spot),
                                                       "laser.absorptivity": round(absorptivity, 4)}))


def summary(folder):
    return json.loads((folder / "summary.json").read_text()) if folder else None


def size(told):
    """Width and depth [m] of the pool; zeros where nothing melted, None where the run was stopped."""
    return tuple(told["pool"][k] or 0.0 for k in ("width", "depth")) if told else None
