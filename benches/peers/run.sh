#!/usr/bin/env bash
# The same paving and the same yes/no questions for orthocert, Codac and IBEX, on this machine in one
# run; or, of --hexapods, whether hexapods are regular. Prints Markdown; what is compared, and how, stands in
# peers.py and hexapod.py. IBEX where `ibexsolve` is on PATH: ibex.py says how to build it.
# usage: benches/peers/run.sh [--hexapods | EDGE...] > benches/runs/DATE-peers.md
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
venv=${PEERS_VENV:-$scratch/venv}
if [ ! -x "$venv/bin/python" ]; then
  python3 -m venv "$venv"
  "$venv/bin/pip" install --quiet --disable-pip-version-check -r "$here/requirements.txt"
fi
cargo build --profile dist --locked --quiet
orthocert=${CARGO_TARGET_DIR:-target}/dist/orthocert
if [ "${1-}" = --hexapods ]; then
  "$venv/bin/python" "$here/hexapod.py" "$orthocert"
else
  "$venv/bin/python" "$here/peers.py" "$orthocert" "$@"
fi
