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
for symmetric in true false; do
  # A box a hair longer in z is not the same from permuted axes.
  [ "$symmetric" = true ] && top=0.7 || top=0.701
  cat > "$symmetric.toml" <<TOML
[mechanism]
kind = "orthoglide"
leg_length = 1
[workspace]
min = [-0.7, -0.7, -0.7]
max = [0.7, 0.7, $top]
[requirements]
transmission = { min = "1/2", max = 2 }
TOML
  "$orthocert" pave "$symmetric.toml" --precision 0.1 --quiet >/dev/null
  "$orthocert" check "$symmetric.paving" --format json > "$symmetric.json"
  "$orthocert" export vtk "$symmetric.paving" -o "$symmetric.vtu"
  "$orthocert" export stl "$symmetric.paving" -o "$symmetric.stl"
  "$venv/bin/python" "$here/surface.py" "$symmetric"
done
