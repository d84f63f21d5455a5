#!/usr/bin/env python3
"""Measured melt tracks beside `layerloop melt`; writes docs/melt-tracks.md with its plots and tables.

    examples/melt_tracks/study.py --program build/layerloop -o out/tracks all      # hours; resumable
    examples/melt_tracks/study.py --program build/layerloop -o out/tracks trapp    # one part: groups, trapp, ammt, ...

What the same program has computed already is not computed again; with --accept-older neither what another build has.
Needs numpy, scipy and matplotlib.
"""
import argparse
import json
import pathlib

import ammt
import groups
import hofmann
import keyhole
import page
import powder
import trapp
from run import Melt

PARTS = {"groups": lambda melt: groups.study(), "trapp": trapp.study, "ammt": ammt.study, "hofmann": hofmann.study,
         "keyhole": keyhole.study, "powder": powder.study}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("part", choices=[*PARTS, "page", "all"])
    parser.add_argument("--program", type=pathlib.Path, default=pathlib.Path("build/layerloop"))
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--docs", type=pathlib.Path, default=pathlib.Path(__file__).parent.parent.parent / "docs")
    parser.add_argument("--jobs", type=int, default=1, help="runs side by side, one thread each")
    parser.add_argument("--accept-older", action="store_true", help="keep what another build of the program computed")
    options = parser.parse_args()
    melt = Melt(options.program, options.output, options.jobs, options.accept_older)
    for name, part in PARTS.items():
        if options.part in (name, "all"):
            (options.output / f"{name}.json").write_text(json.dumps(part(melt), indent=1))
    found = {name: json.loads((options.output / f"{name}.json").read_text())
             for name in PARTS if (options.output / f"{name}.json").exists()}
    page.write(found, options.docs)


if __name__ == "__main__":
    main()
