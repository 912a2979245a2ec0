#!/usr/bin/env bash
# Opens exported surfaces in readers that are not ours: meshio for VTK, numpy-stl for STL.
# usage: tests/readers/run.sh ORTHOCERT [FOLDER-OF-A-VENV]
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
orthocert=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
venv=${2:-$scratch/venv}

if [ ! -x "$venv/bin/python" ] && ! { python3 -m venv "$venv" \
  && "$venv/bin/pip" install --quiet --disable-pip-version-check -r "$here/requirements.txt"; }; then
  if [ "${ORTHOCERT_READERS:-}" = required ]; then
    echo "the readers of requirements.txt cannot be installed" >&2
    exit 1
  fi
  echo "skipped: the readers of requirements.txt cannot be installed"
  exit 0
fi

cd "$scratch"
# One box is the same from permuted axes; a hair longer in z, it is not.
while read -r name top goal least; do
  cat > "$name.toml" <<TOML
[mechanism]
kind = "orthoglide"
leg_length = 1
[workspace]
min = [-0.7, -0.7, -0.7]
max = [0.7, 0.7, $top]
[requirements]
transmission = { min = "1/2", max = 2 }
TOML
  "$orthocert" pave "$name.toml" "$goal" --quiet </dev/null >/dev/null
  "$orthocert" check "$name.paving" --format json </dev/null > "$name.json"
  "$orthocert" export vtk "$name.paving" -o "$name.vtu" </dev/null
  "$orthocert" export stl "$name.paving" -o "$name.stl" </dev/null
  "$venv/bin/python" "$here/surface.py" "$name" "$least" </dev/null
done <<'CASES'
symmetric 0.7 --precision=0.1 100
plain 0.701 --precision=0.1 100
large 0.7 --precision=0.0065 200000
cut 0.701 --volume-gap=0.05 10000
CASES
