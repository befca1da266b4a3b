#!/usr/bin/env bash
# Measures and draws docs/charts.md and its pictures anew; takes a while:
#
#     bash docs/charts.sh [WIDTH [RUNS]]     pictures so many pixels wide [120], medians of so many runs [3]
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build --release --locked
snell=target/release/snell
work=target/charts
width=${1:-120} runs=${2:-3}
rm -rf "$work"
chart() { "$snell" chart "${@:2}" --width "$width" --runs "$runs" -o "$work/$1"; }
chart 1 scenes/gallery/behind-glass.ron --study settings antialias error depth textures methods
chart 2 scenes/gallery/soft-shadows.ron --study lights
# Threads need work to share.
width=$((8 * width)) chart 3 scenes/gallery/many-balls.ron --study threads
chart 4 --study triangles area accelerators
chart 5 scenes/gallery/*.ron --study error --quick
chart 6 scenes/gallery/*.ron --study settings --quick
"$snell" stability --case F50 --case F51 -o "$work/7"
mkdir -p docs/charts
rm -f docs/charts/*.svg
cp "$work"/[1234]/*.svg docs/charts/
cp "$work"/7/stability.svg docs/charts/offsets.svg
{
    cat <<'INTRODUCTION'
# Charts

Speed against accuracy on scenes of the project, made by `bash docs/charts.sh`; `snell chart SCENE.ron` draws the same for
yours. In charts with a Pareto front smaller is better on both axes: a filled point is beaten by no other, a hollow one is.
Errors are root mean squares in linear light against a converged picture; FLIP tells how different two pictures look.

INTRODUCTION
    for part in 1 2 3 4; do
        sed 's#](\([^)]*\.svg\))#](charts/\1)#' "$work/$part/charts.md"
        echo
    done
    cat <<'OFFSETS'
## Where rays leave a surface, by rule

Snell's rays start beyond the error that the surface itself states, and are right at every size of things and every distance
from the origin. A fixed step of 1e-4 loses the shadows of contacts where things are small, and is lost itself in the rounding
of coordinates where they are far away; without a step surfaces shade themselves everywhere.

![Wrong rays from a surface by rule, size and distance (none is best)](charts/offsets.svg)

OFFSETS
    # Of all scenes the tables alone.
    sed -n '/^## All scenes/,$p' "$work/5/charts.md"
    cat <<'ERRORS'

Pixels of blocks stand for the picture, which has the size that the scene gives it. What the promise costs is compared with
the smallest grid, nothing cut, that leaves as many pixels within the error. Bound and error of the cuts are those of the same
rays through pixels with and without them: they hold in every pixel.

ERRORS
    sed -n '/^## All scenes/,$p' "$work/6/charts.md"
    cat <<'TIMES'

## A time that is given

`snell render --time T`, loading and building included, on a machine as busy as it was:

| scene | what became of it |
| --- | --- |
TIMES
    for scene in behind-glass many-balls; do
        for time in 1 3 10; do
            told=$("$snell" render scenes/gallery/$scene.ron --time $time -o "$work/timed.png" | grep -oE '[0-9.]+ s of .*')
            echo "| $scene | $told |"
        done
    done
} >docs/charts.md
echo 'docs/charts.md is new'
