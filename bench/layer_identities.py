#!/usr/bin/env python3
"""Do layers tend to what counting demands?

    layer_identities.py --program build/layerloop -o OUT [--fused] [--set key=value ...]

Free powder: once every layer fills the same share of its void, the real effective thickness RELT equals the nominal
thickness NLT, whatever the packing. Fused powder: a layer shrinks to its share of metal p, so RELT tends to NLT / p. Both
over the interior (bins between 20 % and 80 % of the plate), within 2 %, as the mean of the last layers; also, in every
layer, RELT = VL - NLT + ELT. Prints a table, ends with 1 when an identity fails. Hours of one core at the default length;
--set run.layers=4 shows the way. Needs Python's standard library only."""
import argparse
import json
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent


def interior(bins):
    xs = [b["x"] for b in bins]
    low, high = min(xs), max(xs)
    return [b for b in bins if low + 0.2 * (high - low) <= b["x"] <= high - 0.2 * (high - low)]


def mean(values):
    values = [v for v in values if v is not None]
    return sum(values) / len(values) if values else float("nan")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/layerloop")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--fused", action="store_true", help="melt every layer (verb run) instead of leaving it loose")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--steady", type=int, default=4, help="last layers that count as steady (default 4)")
    options = parser.parse_args()
    overrides = [word for setting in options.set for word in ("--set", setting)]
    verb = "run" if options.fused else "spread"
    subprocess.run([options.program, verb, HERE / "layer_identities.toml", "-o", options.output, "--resume", *overrides],
                   check=True)
    layers = json.loads((options.output / "summary.json").read_text())["layers"]

    nominal = layers[0]["void_layer"]  # the first void is one nominal layer on a flat plate
    print("layer   VL [um]  ELT [um]  RELT [um]  packing  demanded RELT [um]")
    closes, ratios = True, []
    for layer in layers:
        bins = interior(layer["bins"])
        thickness, packing = mean(b["real_effective_thickness"] for b in bins), mean(b["relative_density"] for b in bins)
        void, effective = mean(b["void_layer"] for b in bins), mean(b["effective_thickness"] for b in bins)
        closes &= abs(thickness - (void - nominal + effective)) < 1e-9
        demanded = nominal / packing if options.fused else nominal
        ratios.append(thickness / demanded)
        print(f"{layer['layer']:5} {1e6 * void:9.2f} {1e6 * effective:9.2f} {1e6 * thickness:10.2f} {packing:8.3f} {1e6 * demanded:12.2f}")
    steady = mean(ratios[-options.steady:])
    good = closes and abs(steady - 1) < 0.02
    print(f"RELT = VL - NLT + ELT in every layer: {'yes' if closes else 'NO'}")
    print(f"RELT over the demanded one, mean of the last {options.steady}: {steady:.4f} ({'within' if abs(steady - 1) < 0.02 else 'NOT within'} 2 %)")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
