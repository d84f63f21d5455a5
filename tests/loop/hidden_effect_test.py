"""The tutorial: a study whose data hold an effect that its case lacks. explain names it, add writes it, confirm proves
it on the holdout, and a second look at the holdout is told."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib

program = sys.argv[1]
example = pathlib.Path(__file__).parents[2] / "examples" / "hidden_effect"
hidden = 0.7  # strength of marangoni in examples/hidden_effect/make_data.py


def run(*arguments):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, (arguments, done.returncode, done.stderr[-2000:])
    return done.stdout


def summary(folder):
    return json.loads((folder / "summary.json").read_text())


with tempfile.TemporaryDirectory() as scratch:
    study = pathlib.Path(scratch) / "study"
    shutil.copytree(example, study)

    words = run("explain", study)
    found = summary(study / "explain")
    assert words.startswith("VERDICT: IDENTIFIED\n"), words
    assert found["verdict"] == "IDENTIFIED", found["sentence"]
    assert [effect["name"] for effect in found["effects"]] == ["marangoni"], found["effects"]
    effect = found["effects"][0]
    assert abs(effect["strength"] / hidden - 1) < 0.3, effect
    assert found["chi2_after"] < 1.5 * found["dof"] < found["chi2_before"], found
    assert found["model_runs"] <= 60, found["model_runs"]
    assert not (study / "holdout_looks.log").exists()  # nobody has looked yet

    added = pathlib.Path(scratch) / "with_marangoni"
    run("add", study, "--effect", "marangoni", "-o", added)
    with open(added / "case.toml", "rb") as file:
        case = tomllib.load(file)
    assert case["effects"]["marangoni"]["enabled"] and abs(case["effects"]["marangoni"]["strength"] - hidden) < 0.3
    own = (study / "case.toml").read_text()
    assert (added / "case.toml").read_text().startswith(own)  # the author's lines stay as they were
    assert summary(added)["chi2_after"] < 0.5 * summary(added)["chi2_before"]

    words = run("confirm", study)
    proof = summary(study / "confirm")
    assert words.startswith("CONFIRMED"), words
    assert proof["confirmed"] and proof["ci95"][0] > 0, proof
    assert proof["rms_after"] < 0.5 * proof["rms_before"], proof
    assert proof["whitened_rms_after"] < 1.5 and proof["holdout_points"] == 24, proof
    assert proof["looks"] == 1 and proof["verdict"] == "IDENTIFIED"
    assert "look 2" in run("confirm", study)

    assert "no candidates are left" in run("next", study)
    for folder in (study / "explain", added, study / "confirm", study / "next"):
        page = (folder / "report.html").read_text()
        assert "<svg" in page and "http://" not in page and "https://" not in page, folder
