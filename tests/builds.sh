#!/usr/bin/env bash
# The hash of every golden scene, drawn by builds for every level of the machine that it has, with all optimisation and
# with none: all must be the same. Builds a small program, each time in a folder of its own: `bash tests/builds.sh`, or
# with levels: `bash tests/builds.sh x86-64-v3`.
set -euo pipefail
cd "$(dirname "$0")/.."
target=${CARGO_TARGET_DIR:-target}/builds
scenes=$(find tests/golden scenes/gallery -name '*.ron' ! -path '*/parts/*' | LC_ALL=C sort)

levels=("$@")
if [ ${#levels[@]} = 0 ]; then
    levels=(x86-64)
    loader=/lib64/ld-linux-x86-64.so.2
    for level in x86-64-v2 x86-64-v3 x86-64-v4; do
        if [ -x "$loader" ] && "$loader" --help | grep "$level (supported" >/dev/null; then
            levels+=("$level")
        else
            echo "skipped: this machine has no $level"
        fi
    done
fi

expected=
for level in "${levels[@]}"; do
    for profile in release dev; do
        # Without optimisation, one level is enough: the compiler changes nothing there.
        if [ "$profile" = dev ] && [ "$level" != "${levels[-1]}" ]; then
            continue
        fi
        RUSTFLAGS="-C target-cpu=$level" CARGO_PROFILE_DEV_OPT_LEVEL=0 CARGO_PROFILE_DEV_DEBUG=false \
            CARGO_PROFILE_RELEASE_DEBUG=false \
            cargo build --locked --quiet --profile "$profile" --target-dir "$target/$level" \
            --package snell_systems --example hashes
        folder=$([ "$profile" = dev ] && echo debug || echo "$profile")
        # shellcheck disable=SC2086
        found=$("$target/$level/$folder/examples/hashes" $scenes)
        expected=${expected:-$found}
        if [ "$found" != "$expected" ]; then
            echo "error: $level, $profile draws other pictures:" >&2
            diff <(echo "$expected") <(echo "$found") >&2 || true
            exit 1
        fi
        echo "$level, $profile: $(echo "$found" | wc -l) pictures, $(echo "$found" | sha256sum | cut -c1-16)"
    done
done
