#!/usr/bin/env bash
# Scenes of the gallery beside POV-Ray. Says "passed" or "skipped"; POV-Ray comes with `apt-get install povray`.
set -euo pipefail
cd "$(dirname "$0")/../.."
log=$(mktemp)
trap 'rm -f "$log"' EXIT
cargo test --locked --quiet --test povray -- --nocapture --test-threads 1 2>&1 | tee "$log"
if grep -q '^skipped' "$log"; then
    echo 'POV-Ray: skipped'
else
    echo 'POV-Ray: passed'
fi
