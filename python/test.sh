#!/usr/bin/env bash
# Builds the Python package as cargo does by itself, and runs its tests: `bash python/test.sh`. Needs Python 3.10 or newer.
set -euo pipefail
cd "$(dirname "$0")"
if ! python3 -c 'import sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null; then
    echo 'skipped: there is no Python 3.10 or newer'
    exit
fi
target=${CARGO_TARGET_DIR:-target}
cargo build --locked --workspace
rm -rf "$target/package"
mkdir -p "$target/package"
cp -r package/snell "$target/package/"
cp "$target/debug/libsnell_native.so" "$target/package/snell/snell_native.abi3.so"
cp "$target/debug/librings.so" "$target/package/rings.abi3.so"
PYTHONPATH=$target/package python3 -m unittest discover -s tests 2>&1
