#!/usr/bin/env python3
"""Compares the frame times that the service reports with those of the command line, pair by pair.

    bench/service_times.py --program build/penumbra --gaps 0:4 1:4 10:2 [--size 1200] [--device NAME]

Each pair of scene and technique is measured by the command line in a fresh process, then again and again
through POST /api/v1/renders in one server, with a worker that lives on. --gaps SECONDS:REPEATS says how
long to idle before each request and how often: a GPU that idles lowers its clocks. Prints tables in
Markdown: the times, the largest deviation, and whether the techniques keep their order in every repeat.
"""
import argparse
import json
import re
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.request

SCENES = ["sweep:10x1600x1", "boxes", "car", "disco-box"]
TECHNIQUES = ["none", "shadow-map", "pcf-bilinear-3x3", "pcss", "vsm"]
ORDER = ["none", "pcf-bilinear-3x3", "pcss"]  # each at most as fast as the next


def by_command_line(options, scene, technique):
    command = [options.program, "measure", scene, technique, "--json", "--width", str(options.size),
               "--height", str(options.size), *options.device_option]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)


class Server:
    """`penumbra serve` on free ports in a folder of its own."""

    def __init__(self, options):
        self.folder = tempfile.TemporaryDirectory()
        self.process = subprocess.Popen(
            [options.program, "serve", "--port", "0", "--ops-port", "0", "--data", self.folder.name,
             *options.device_option], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        for line in self.process.stdout:
            found = re.search(r"http://127\.0\.0\.1:\d+", line)
            if found:
                self.url = found.group(0)
                return
        sys.exit("the server did not start")

    def __exit__(self, *ignored):
        self.process.terminate()
        self.process.wait()
        self.folder.cleanup()

    def __enter__(self):
        return self

    def call(self, path, body=None):
        request = urllib.request.Request(
            self.url + path, data=None if body is None else json.dumps(body).encode(),
            headers={"Content-Type": "application/json"})
        with urllib.request.urlopen(request, timeout=300) as reply:
            return json.load(reply)

    def measure(self, options, scene, technique, seed, **fields):
        # A seed of its own makes every repeat a picture that is not in the cache.
        record = self.call("/api/v1/renders", {
            "scene": scene, "technique": technique, "width": options.size, "height": options.size,
            "measure": True, "seed": seed, **fields})
        while record["status"] in ("queued", "running"):
            record = self.call(f"/api/v1/renders/{record['id']}?wait_s=30")
        if record["status"] != "done":
            sys.exit(f"{scene}, {technique}: {record['error']}")
        return record


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--program", default="build/penumbra")
    parser.add_argument("--size", type=int, default=1200)
    parser.add_argument("--device", default="")
    parser.add_argument("--gaps", nargs="+", default=["0:4", "1:4", "10:2"])
    options = parser.parse_args()
    options.device_option = ["--device", options.device] if options.device else []
    pairs = [(scene, technique) for scene in SCENES for technique in TECHNIQUES]

    alone = {}
    for pair in pairs:
        record = by_command_line(options, *pair)
        alone[pair] = record["cost"]["frame_ms"]
        device = record["device"]
    print(f"{device['name']}, {device['driver']}, {options.size}x{options.size}, "
          f"{time.strftime('%d %B %Y')}\n", flush=True)

    runs = {}  # by gap and repeat: frame_ms by pair
    seed = 1
    with Server(options) as server:
        for gap, repeats in (map(int, entry.split(":")) for entry in options.gaps):
            for repeat in range(repeats):
                seed += 1
                run = runs.setdefault((gap, repeat), {})
                for pair in pairs:
                    time.sleep(gap)
                    run[pair] = server.measure(options, *pair, seed)["cost"]["frame_ms"]
                print(f"gap {gap} s, repeat {repeat + 1} done", file=sys.stderr, flush=True)

    print("| scene | technique | command line, ms | over none | service, ms: lowest | median | highest |"
          " largest deviation | not settled |\n|---|---|---|---|---|---|---|---|---|")
    worst = 0.0
    for pair in pairs:
        base = alone[pair]["median"]
        times = [run[pair]["median"] for run in runs.values()]
        deviation = max(abs(value / base - 1.0) for value in times)
        worst = max(worst, deviation)
        loose = sum(not run[pair]["settled"] for run in runs.values())
        print(f"| {pair[0]} | {pair[1]} | {base:.3f} | {alone[pair]['over_none']:.2f} | {min(times):.3f} | "
              f"{statistics.median(times):.3f} | {max(times):.3f} | {100 * deviation:.1f}% | {loose} |")
    kept = sum(all(run[(scene, a)]["median"] <= run[(scene, b)]["median"] for a, b in zip(ORDER, ORDER[1:]))
               for run in runs.values() for scene in SCENES)
    print(f"\nLargest deviation from the command line: {100 * worst:.1f}%. "
          f"Order {' <= '.join(ORDER)} kept in {kept} of {len(runs) * len(SCENES)}.")


if __name__ == "__main__":
    main()
