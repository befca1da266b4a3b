#!/usr/bin/env python3
"""Whole pictures by Snell, by a minimal Whitted renderer on Embree and by POV-Ray, in turn: ratios and differences.

    python3 benches/peers/frames.py --help
"""

import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import threading
from pathlib import Path

import compare
import meshes
import scenes
from compare import HERE, ROOT, say


def run(command, **options):
    """What a program says on both outputs, and the most memory it had, in bytes."""
    process = subprocess.Popen(
        list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options
    )
    # The system's own account of a child begins with what its parent had, so the child is looked at while it runs.
    memory = 0
    told = []
    reader = threading.Thread(target=lambda: told.append(process.stdout.read()))
    reader.start()
    while reader.is_alive():
        memory = max(memory, peak_memory(process.pid))
        reader.join(0.02)
    if process.wait():
        raise SystemExit(f"{' '.join(map(str, command))} ended with code {process.returncode}:\n{told[0]}")
    return told[0], memory


def peak_memory(pid):
    try:
        found = re.search(r"VmHWM:\s+(\d+) kB", Path(f"/proc/{pid}/status").read_text())
    except OSError:
        return 0
    return int(found[1]) * 1024 if found else 0


def last_json(told):
    return json.loads(told.strip().splitlines()[-1])


class Snell:
    def __init__(self, program):
        self.program = program

    def draw(self, files, threads, picture):
        told, memory = run([self.program, "frame", files["ron"], threads, picture])
        return {**last_json(told), "memory": memory}


class Embree:
    def __init__(self, program):
        self.program = program

    def draw(self, files, threads, picture):
        told, memory = run([self.program, files["txt"], threads, picture])
        return {**last_json(told), "memory": memory}


class PovRay:
    """POV-Ray tells its own processor seconds of parsing, building and tracing."""

    def draw(self, files, threads, picture):
        size = [f"+W{scenes.WIDTH}", f"+H{scenes.HEIGHT}"]
        options = ["-D", "-A", "+FP", "File_Gamma=srgb", f"+WT{threads}", f"+O{picture}", f"+I{files['pov']}"]
        told, memory = run(["povray", *size, *options], cwd=files["pov"].parent)

        def seconds(stage):
            found = re.search(rf"{stage} Time:.*?\(([\d.]+) seconds\).*?\n?.*?([\d.]+) CPU-seconds total", told)
            if not found:
                found = re.search(rf"{stage} Time:.*?\(([\d.]+) seconds\)", told)
                return (float(found[1]), float(found[1])) if found else (0.0, 0.0)
            return float(found[1]), float(found[2])

        parse, bounding, trace = seconds("Parse"), seconds("Bounding"), seconds("Trace")
        return {
            "load_wall": parse[0] + bounding[0], "load_cpu": parse[1] + bounding[1],
            "trace_wall": trace[0], "trace_cpu": trace[1], "memory": memory,
        }  # fmt: skip


def contestants(work):
    found = {"snell": Snell(compare.build_snell())}
    compiler = shutil.which("c++")
    program = work / "embree_whitted"
    command = [compiler, "-O3", "-march=native", "-std=c++17", HERE / "embree_whitted.cpp", "-o", program]
    command += ["-lembree3", "-lpthread"]
    if not compiler:
        say("skipped: Embree (there is no C++ compiler)")
    elif subprocess.run(list(map(str, command)), stderr=subprocess.PIPE).returncode:
        say("skipped: Embree (it cannot be compiled; Debian: apt-get install libembree-dev)")
    else:
        found["embree"] = Embree(program)
    if shutil.which("povray"):
        found["povray"] = PovRay()
    else:
        say("skipped: POV-Ray (Debian: apt-get install povray)")
    return found


def prepare(name, make, data, work):
    """The files of a scene in every form; nothing if its model is not there."""
    scene = make()
    files = {kind: work / f"{name}.frame.{kind}" for kind in ("ron", "txt", "pov", "obj")}
    mesh, tri = None, work / f"{scene.mesh}.tri"
    if scene.mesh:
        if not tri.exists():
            try:
                meshes.subjects(data)[scene.mesh]().write_tri(tri)
            except FileNotFoundError as missing:
                return say(f"skipped: {name} (there is no {missing.filename})")
        mesh = meshes.Mesh.read_tri(tri)
        if not files["obj"].exists():
            mesh.write_obj(files["obj"])
    scenes.write_ron(scene, files["obj"].name, files["ron"])
    scenes.write_text(scene, tri, files["txt"])
    if not files["pov"].exists():
        scenes.write_pov(scene, mesh, files["pov"])
    return files


def read_ppm(path):
    data = path.read_bytes()
    header = re.match(rb"P6\s+(?:#.*\n)*(\d+)\s+(\d+)\s+255\s", data)
    return data[header.end() :]


def differences(ours, theirs):
    """Share of pixels with a channel more than 8 of 255 apart, and the median over pixels of the largest difference."""
    a, b = read_ppm(ours), read_ppm(theirs)
    apart = [max(abs(a[i + k] - b[i + k]) for k in range(3)) for i in range(0, len(a), 3)]
    return sum(value > 8 for value in apart) / len(apart), statistics.median(apart)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scene", action="append", choices=list(scenes.SCENES), help="only this scene")
    parser.add_argument("--peer", action="append", choices=["embree", "povray"], help="only this peer")
    parser.add_argument("--threads", type=int, action="append", help="numbers of threads (default: 1 and 2)")
    parser.add_argument("--rounds", type=int, default=3, help="rounds; medians are told (default: 3)")
    parser.add_argument("--json", type=Path, help="write all figures to this file")
    parser.add_argument("--work", type=Path, default=ROOT / "target" / "peers", help="folder for what is made")
    data = os.environ.get("SNELL_DATA", ROOT.parent / "shared" / "data")
    parser.add_argument("--data", type=Path, default=data, help="folder of scanned models")
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)

    entered = contestants(arguments.work)
    entered = {name: one for name, one in entered.items() if name == "snell" or name in (arguments.peer or entered)}
    records = []
    print("Seconds: medians; in brackets its over Snell's. `apart`: share of pixels over 8/255 from Snell's; median.")
    print(f"{'scene':8} {'threads':>7} {'':8} {'load CPU s':>16} {'load s':>16} {'trace CPU s':>16} {'trace s':>16}"
          f" {'memory MB':>10} {'apart':>14}")  # fmt: skip
    for name in arguments.scene or scenes.SCENES:
        files = prepare(name, scenes.SCENES[name], arguments.data, arguments.work)
        if not files:
            continue
        for threads in arguments.threads or [1, 2]:
            answers = {title: [] for title in entered}
            pictures = {title: arguments.work / f"{name}.{title}.ppm" for title in entered}
            for _ in range(arguments.rounds):
                for title, one in entered.items():
                    answers[title].append(one.draw(files, threads, pictures[title].resolve()))
            for title, told in answers.items():
                record = {"scene": name, "threads": threads, "renderer": title}
                for key in ("load_cpu", "load_wall", "trace_cpu", "trace_wall"):
                    record[key] = statistics.median(one[key] for one in told)
                    pairs = zip(told, answers["snell"])
                    record[f"{key}_over_snell"] = statistics.median(a[key] / max(b[key], 1e-9) for a, b in pairs)
                record["memory"] = max(one["memory"] for one in told)
                record["rays"] = told[0].get("rays")
                record["apart"] = differences(pictures["snell"], pictures[title])
                records.append(record)
                cell = lambda key: f"{record[key]:.3f} ({record[f'{key}_over_snell']:.2f})"
                print(f"{name:8} {threads:>7} {title:8} {cell('load_cpu'):>16} {cell('load_wall'):>16}"
                      f" {cell('trace_cpu'):>16} {cell('trace_wall'):>16} {record['memory'] / 1e6:>10.0f}"
                      f" {record['apart'][0]:>9.2%} {record['apart'][1]:>4}", flush=True)  # fmt: skip
    if arguments.json:
        arguments.json.write_text(json.dumps(records, indent=1) + "\n")


if __name__ == "__main__":
    main()
