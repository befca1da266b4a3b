#!/usr/bin/env python3
"""Snell and other ray-tracing kernels on the same meshes and rays, in turn: ratios that hold on a busy machine.

    python3 benches/peers/compare.py --help
"""

import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
from pathlib import Path

import meshes

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
# What all others are compared with: finds out as much about a hit as a call of Embree.
OURS = "snell"
KINDS = ["primary", "shadow", "mirror", "diffuse"]

# Distances may differ by rounding: the peers' are f32. At the rim of a triangle that may decide a hit.
SAME_HITS = 1e-4
SAME_T = 1e-4


def say(line):
    print(line, file=sys.stderr, flush=True)


class Contestant:
    """A program that holds a tree over a mesh and answers commands about it."""

    def __init__(self, name, command):
        self.name = name
        self.process = subprocess.Popen(
            list(map(str, command)), stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self.version = self.answer()["name"]

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            raise SystemExit(f"{self.name} ended with code {self.process.wait()}")
        return json.loads(line)

    def ask(self, *words):
        self.process.stdin.write(" ".join(map(str, words)) + "\n")
        self.process.stdin.flush()
        return self.answer()

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def run(*command, **options):
    subprocess.run(list(map(str, command)), check=True, **options)


def build_snell():
    """The bench program of this checkout."""
    command = ["cargo", "bench", "--bench", "speed", "--no-run", "--message-format=json-render-diagnostics"]
    told = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout
    for line in told.splitlines():
        message = json.loads(line)
        if message.get("executable") and message["target"]["name"] == "speed":
            return Path(message["executable"])
    raise SystemExit("cargo bench built no program")


def build_embree(work):
    """The program on Embree 3, or nothing where it cannot be built."""
    program = work / "embree"
    compiler = shutil.which("c++")
    if not compiler:
        return say("skipped: Embree (there is no C++ compiler)")
    source = HERE / "embree.cpp"
    command = [compiler, "-O3", "-march=native", "-std=c++17", source, "-o", program, "-lembree3", "-lpthread"]
    built = subprocess.run(list(map(str, command)), stderr=subprocess.PIPE, text=True)
    if built.returncode:
        return say("skipped: Embree (it cannot be compiled; Debian: apt-get install libembree-dev)")
    return program


def build_crates(work, native):
    """The program on the crates obvhs and bvh, or nothing where it cannot be built.

    Those crates choose their instructions when they are compiled: once as cargo does by itself, once for this machine.
    """
    target = work / ("crates-native" if native else "crates")
    command = ["cargo", "build", "--release", "--quiet", "--manifest-path", HERE / "crates" / "Cargo.toml"]
    command += ["--target-dir", target]
    environment = {**os.environ, "RUSTFLAGS": "-C target-cpu=native" if native else ""}
    built = subprocess.run(list(map(str, command)), env=environment)
    if built.returncode:
        return say("skipped: the crates obvhs and bvh (they cannot be built)")
    return target / "release" / "crates"


def contestants(only, work):
    """Name → command without mesh and rays; Snell first."""
    snell = build_snell()
    found = {
        name: lambda mesh, rays, g=goal: [snell, "contestant", mesh, rays, g]
        for name, goal in [
            (OURS, "nearest"),
            ("snell-packets", "packets"),
            ("snell-search", "search"),
            ("snell-surface", "surface"),
        ]
    }
    wanted = lambda names: [name for name in names if not only or name in only]
    embree = wanted(["embree-single", "embree-bvh8", "embree-packet8", "embree-packet16", "embree-single-robust"])
    program = embree and build_embree(work)
    for name in embree if program else []:
        found[name] = lambda mesh, rays, p=program, c=name.removeprefix("embree-"): [p, mesh, rays, c]
    for suffix in ["", "-native"]:
        crates = wanted([f"{name}{suffix}" for name in ["obvhs-cwbvh", "obvhs-bvh2", "bvh"]])
        program = crates and build_crates(work, native=bool(suffix))
        for name in crates if program else []:
            configuration = name.removeprefix("obvhs-").removesuffix(suffix)
            found[name] = lambda mesh, rays, p=program, c=configuration: [p, mesh, rays, c]
    return snell, found


def prepare(name, make, snell, work):
    """The files of a mesh and of the rays about it; nothing if the model is not there."""
    mesh, rays = work / f"{name}.tri", work / name
    if not mesh.exists():
        try:
            made = make()
        except FileNotFoundError as missing:
            return say(f"skipped: {name} (there is no {missing.filename})")
        made.write_tri(mesh)
    if not Path(f"{rays}.{KINDS[-1]}.rays").exists():
        run(snell, "rays", mesh, rays)
    return mesh, rays


def measure(entered, rounds, threads, kinds):
    """Answers by (task, threads) and contestant: one warm-up, then every contestant in turn, round after round."""
    tasks = [("build",)] if "build" in kinds else []
    tasks += [("trace", kind) for kind in KINDS if kind in kinds]
    results = {}
    for task in tasks:
        for count in threads:
            row = results.setdefault((task[-1], count), {one.name: [] for one in entered})
            for turn in range(rounds + 1):
                shift = turn % len(entered)
                for one in entered[shift:] + entered[:shift]:
                    answer = one.ask(*task, count)
                    if turn > 0:
                        row[one.name].append(answer)
    return results


def check(mesh, results):
    """Whether all contestants met the same; tells where they did not."""
    agreed = True
    for (task, threads), row in results.items():
        if task == "build" or threads != 1:
            continue
        ours = row[OURS][0]
        for name, answers in row.items():
            theirs = answers[0]
            apart = abs(theirs["hits"] - ours["hits"]) / max(ours["hits"], 1)
            far = task != "shadow" and abs(theirs["t"] - ours["t"]) / max(abs(ours["t"]), 1e-30)
            if apart > SAME_HITS or far > SAME_T:
                agreed = False
                say(f"DIFFERENT: {mesh} {task} {name}: {theirs['hits']} hits, sum of t {theirs['t']};"
                    f" snell {ours['hits']} and {ours['t']}")
    return agreed


def summary(mesh, results):
    """One record a task, number of threads and contestant."""
    for (task, threads), row in results.items():
        per_second = {name: [a["items"] / a["cpu"] / 1e6 for a in answers] for name, answers in row.items()}
        for name, answers in row.items():
            ratios = [ours / theirs for ours, theirs in zip(per_second[OURS], per_second[name])]
            record = {
                "mesh": mesh,
                "task": task,
                "threads": threads,
                "contestant": name,
                "million_per_cpu_second": statistics.median(per_second[name]),
                "best": max(per_second[name]),
                "million_per_second": statistics.median(a["items"] / a["wall"] / 1e6 for a in answers),
                "snell_over_it": statistics.median(ratios),
                "ratios": [round(ratio, 3) for ratio in ratios],
            }
            for key in ("hits", "t", "bytes"):
                if key in answers[0]:
                    record[key] = answers[0][key]
            yield record


def show(records):
    """A table a mesh: a line for each contestant, a column for each task and number of threads."""
    for mesh in dict.fromkeys(record["mesh"] for record in records):
        mine = [record for record in records if record["mesh"] == mesh]
        keys = list(dict.fromkeys((record["task"], record["threads"]) for record in mine))
        cells = {(r["contestant"], r["task"], r["threads"]): r for r in mine}
        print(f"\n{mesh}: millions per CPU second, and in brackets Snell's over it; threads after the task")
        print(f"{'':22}" + "".join(f"{f'{task} {threads}':>15}" for task, threads in keys))
        for name in dict.fromkeys(record["contestant"] for record in mine):
            row = [cells[name, *key] for key in keys]
            line = [f"{r['million_per_cpu_second']:.2f} ({r['snell_over_it']:.2f})" for r in row]
            print(f"{name:22}" + "".join(f"{cell:>15}" for cell in line))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mesh", action="append", help="only this mesh; may be given several times")
    parser.add_argument("--peer", action="append", help="only this peer; may be given several times")
    parser.add_argument("--task", action="append", choices=["build", *KINDS], help="only this task; may be repeated")
    parser.add_argument("--threads", type=int, action="append", help="numbers of threads (default: 1 and 2)")
    parser.add_argument("--rounds", type=int, default=5, help="measured rounds; medians are told (default: 5)")
    parser.add_argument("--json", type=Path, help="write all figures to this file")
    parser.add_argument("--work", type=Path, default=ROOT / "target" / "peers", help="folder for what is made")
    data = os.environ.get("SNELL_DATA", ROOT.parent / "shared" / "data")
    parser.add_argument("--data", type=Path, default=data, help="folder of scanned models")
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)

    snell, found = contestants(arguments.peer, arguments.work)
    records, agreed = [], True
    for name, make in meshes.subjects(arguments.data).items():
        if arguments.mesh and name not in arguments.mesh:
            continue
        files = prepare(name, make, snell, arguments.work)
        if not files:
            continue
        entered = [Contestant(title, command(*files)) for title, command in found.items()]
        results = measure(entered, arguments.rounds, arguments.threads or [1, 2], arguments.task or ["build", *KINDS])
        for one in entered:
            one.close()
        agreed &= check(name, results)
        records += summary(name, results)
    show(records)
    if arguments.json:
        arguments.json.write_text(json.dumps(records, indent=1) + "\n")
    if not agreed:
        raise SystemExit("not all contestants met the same: their speeds cannot be compared")


if __name__ == "__main__":
    main()
