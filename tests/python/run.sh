#!/usr/bin/env bash
# Installs the package as users do, in an environment of its own, and runs its tests and the tutorial:
#   tests/python/run.sh
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# The wheel's program is the one that is built already, where it is.
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$root/target}

python3 -m venv "$scratch/venv"
pip() { "$scratch/venv/bin/pip" --quiet --disable-pip-version-check "$@"; }
pip wheel --no-deps --wheel-dir "$scratch/wheels" "$root"
ls -l "$scratch"/wheels/*.whl | awk '{print "wheel: " $5 " bytes"}'
pip install "$scratch"/wheels/*.whl matplotlib nbconvert ipykernel

cd "$scratch"
MPLBACKEND=Agg PYTHONDONTWRITEBYTECODE=1 "$scratch/venv/bin/python" -m unittest discover -s "$root/tests/python"
# It writes its files beside itself.
cp "$root/src/python/tutorial.ipynb" "$scratch"
"$scratch/venv/bin/jupyter" nbconvert --to html --execute --log-level ERROR "$scratch/tutorial.ipynb"
grep -q CERTIFIED "$scratch/tutorial.html"
grep -q orthocert_verify "$scratch/printer.report.html"
"$scratch/venv/bin/python" -c '
import sys, time
start = time.perf_counter()
import orthocert
print(f"import: {1000 * (time.perf_counter() - start):.0f} ms, orthocert {orthocert.version()}")'
