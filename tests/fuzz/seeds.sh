#!/usr/bin/env bash
# Puts what the fuzz targets start from into CORPUS/TARGET: seeds.sh CORPUS
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
corpus=$1
mkdir -p "$corpus"/{bytes,certificate,number,design}
small() { find "$1" -name "$2" -size -16k; }
small "$root/proofs/certificates" '*.json' | while read -r file; do cp "$file" "$corpus/bytes/"; done
small "$root/tests/designs" '*.toml' | while read -r file; do cp "$file" "$corpus/design/"; done
for template in "$root"/src/design/templates/*; do cp "$template" "$corpus/design/"; done
# Every certificate that is edited, without an edit and with a few.
for n in {0..12}; do
  printf "\\x$(printf %x "$n")" >"$corpus/certificate/$n"
  printf "\\x$(printf %x "$n")"'\x20\x01\x03\x50\xff\x07\x31\x80\x04' >"$corpus/certificate/edited-$n"
done
# Every quoted text of the claims that may be a number, and some of each kind.
grep -oh '"[-0-9(s][^"]*"' "$root"/proofs/certificates/*.json "$root"/tests/designs/*.toml \
  | tr -d '"' | sort -u | awk -v folder="$corpus/number" '{ print > (folder "/" NR); close(folder "/" NR) }'
printf 'sqrt(2)*sqrt(3)/(1e-3-sqrt(5))' >"$corpus/number/expression"
printf -- '-(-1.5E+2)/sqrt(sqrt(1/3))' >"$corpus/number/signs"
