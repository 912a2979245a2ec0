#!/usr/bin/env python3
"""What an atlas costs in N shards: measured on this machine, projected to more cores.

Usage: benches/atlas-scaling.py ORTHOCERT ATLAS.toml RUNS.json

Measured, one process at a time, each with one thread, in seconds of processor time, which do not
depend on what else the machine does: `split` for every N, `run-shard` for every shard, `merge`, and
`check` of what it wrote. Projected to P cores: split, then the shards in order, each on the first
core that is free (as Slurm and HyperQueue deal out the tasks of an array), then merge, of which the
exact check goes over at most PARTS cores. A task costs DISPATCH seconds more than its process: what an
engine takes to start it. The raw times go to RUNS.json, the table to standard output.
"""

import heapq
import json
import os
import platform
import resource
import subprocess
import sys
import tempfile

SHARDS = [1, 4, 16, 64, 256]
CORES = [1, 2, 10, 100, 1000]
DISPATCH = 0.1
PARTS = 32


def seconds(*command):
    def used():
        children = resource.getrusage(resource.RUSAGE_CHILDREN)
        return children.ru_utime + children.ru_stime

    before = used()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return used() - before


def measure(orthocert, atlas, shards):
    with tempfile.TemporaryDirectory() as scratch:
        job, result = os.path.join(scratch, "job"), os.path.join(scratch, "map")
        one = ("--threads", "1", "--quiet")
        split = seconds(orthocert, "split", atlas, "--shards", str(shards), "--out", job, *one)
        runs = [
            seconds(orthocert, "run-shard", os.path.join(job, f"shard-{n:04}.json"), *one)
            for n in range(1, shards + 1)
        ]
        merge = seconds(orthocert, "merge", job, "--output", result, *one)
        check = seconds(orthocert, "check", os.path.join(result, "atlas.cert.json"))
        return {"shards": shards, "split": split, "run": runs, "merge": merge, "check": check}


def projected(run, cores):
    free = [0.0] * min(cores, run["shards"])
    for shard in run["run"]:
        heapq.heappush(free, heapq.heappop(free) + shard + DISPATCH)
    # What of the merge is not the check, such as sampling for the picture, is counted whole.
    merge = run["merge"] - run["check"] + run["check"] / min(cores, PARTS)
    return run["split"] + max(free) + merge


def main():
    orthocert, atlas, raw = sys.argv[1:]
    alone = seconds(orthocert, "atlas", atlas, "--threads", "1", "--quiet",
                    "--output", tempfile.mkdtemp())
    runs = [measure(orthocert, atlas, shards) for shards in SHARDS]
    with open(raw, "w") as out:
        facts = {"atlas": os.path.basename(atlas), "machine": platform.machine(),
                 "cpus": os.cpu_count(), "alone": alone, "dispatch": DISPATCH, "runs": runs}
        json.dump(facts, out, indent=1)
        out.write("\n")
    print(f"one machine, one thread: {alone:.1f} s\n")
    head = " | ".join(f"{cores:,} cores" for cores in CORES)
    print(f"| shards | split s | shard s: mean, greatest | all shards s | merge s, check | {head} |")
    print("|---" * (5 + len(CORES)) + "|")
    for run in runs:
        times = run["run"]
        row = " | ".join(f"{projected(run, cores):.1f}" for cores in CORES)
        print(f"| {run['shards']} | {run['split']:.2f} | {sum(times) / len(times):.2f}, "
              f"{max(times):.2f} | {sum(times):.1f} | {run['merge']:.2f}, {run['check']:.2f} | "
              f"{row} |")


main()
