#!/usr/bin/env python3
"""How long a measured pair that was not asked for before takes through the service, beyond its timed frames.

    bench/fresh_pairs.py --program build/penumbra [--size 600] [--light-samples 256] [--device NAME]

One server with an empty data folder. Of every view the first pair also draws the reference that all of its
pairs are judged by. Prints a table in Markdown: wall time from the request to its answer, the part of it that
timed frames and raising a GPU's clocks took (cost.timing_ms), and the rest: starting, uploading, compiling, drawing
the picture, encoding, judging, storing.
"""
import argparse
import statistics
import time

from service_times import SCENES, Server

TECHNIQUES = ["shadow-map", "pcf", "pcss", "vsm", "esm", "msm", "savsm", "shadow-volumes", "hybrid"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--program", default="build/penumbra")
    parser.add_argument("--size", type=int, default=600)
    parser.add_argument("--light-samples", type=int, default=256)
    parser.add_argument("--device", default="")
    options = parser.parse_args()
    options.device_option = ["--device", options.device] if options.device else []

    rows = []
    with Server(options) as server:
        for scene in SCENES:
            for technique in TECHNIQUES:
                start = time.monotonic()
                record = server.measure(options, scene, technique, 1, light_samples=options.light_samples)
                wall = 1000.0 * (time.monotonic() - start)
                rows.append((scene, technique, wall, record["cost"]["timing_ms"]))
    print(f"{record['device']['name']}, {record['device']['driver']}, {options.size}x{options.size}, "
          f"{time.strftime('%d %B %Y')}\n\n| scene | technique | ms | of that timed frames | beyond them |\n"
          "|---|---|---|---|---|")
    for scene, technique, wall, timed in rows:
        print(f"| {scene} | {technique} | {wall:.0f} | {timed:.0f} | {wall - timed:.0f} |")
    for name, chosen in (("First of a view", rows[::len(TECHNIQUES)]),
                         ("Others", [row for i, row in enumerate(rows) if i % len(TECHNIQUES)])):
        beyond = [wall - timed for _, _, wall, timed in chosen]
        print(f"\n{name}: median {statistics.median(beyond):.0f} ms beyond timed frames, most {max(beyond):.0f}.")


if __name__ == "__main__":
    main()
