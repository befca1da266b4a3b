#!/usr/bin/env bash
# Measures and draws docs/charts.md and its pictures anew:
#
#     bash docs/charts.sh            takes a while
#     bash docs/charts.sh --quick    small pictures, few settings
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build --release --locked
snell=target/release/snell
work=target/charts
rm -rf "$work"
"$snell" chart scenes/gallery/behind-glass.ron --study settings depth textures methods threads -o "$work/1" "$@"
"$snell" chart scenes/gallery/soft-shadows.ron --study lights --width 60 -o "$work/2" "$@"
"$snell" chart --study triangles area accelerators -o "$work/3" "$@"
"$snell" chart scenes/gallery/{behind-glass,absorption,coloured-lights,cone-lights}.ron --study error --width 32 --runs 1 -o "$work/4" "$@"
mkdir -p docs/charts
rm -f docs/charts/*.svg
cp "$work"/[123]/*.svg docs/charts/
{
    cat <<'INTRODUCTION'
# Charts

Speed against accuracy on scenes of the project, made by `bash docs/charts.sh`; `snell chart SCENE.ron` draws the same for
yours. In charts with a Pareto front smaller is better on both axes: a filled point is beaten by no other, a hollow one is.
Errors are root mean squares in linear light against a converged picture; FLIP tells how different two pictures look.

INTRODUCTION
    for part in 1 2 3; do
        sed 's#](\([^)]*\.svg\))#](charts/\1)#' "$work/$part/charts.md"
        echo
    done
    # Of the errors the table alone.
    sed -n '/^## All scenes/,$p' "$work/4/charts.md"
} >docs/charts.md
echo 'docs/charts.md is new'
