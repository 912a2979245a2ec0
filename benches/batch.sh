#!/usr/bin/env bash
# Times a folder of generated designs: proved cold, and again from its certificates.
# Usage: benches/batch.sh ORTHOCERT [COUNT [SEED]]
#
# Each design is one of tests/designs with its workspace changed by up to 0.009 of its unit, so that
# its claim is another and its cost the same (a bound written as an expression is left). `runs/` holds raw figures.
set -euo pipefail
orthocert=$(realpath "$1")
count=${2:-200}
RANDOM=${3:-1}
designs=$(realpath "$(dirname "$0")/../tests/designs")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
mkdir designs

templates=("$designs"/*.toml)
for ((i = 0; i < count; i++)); do
  template=${templates[i % ${#templates[@]}]}
  digit=$((1 + RANDOM % 9))
  name=designs/$(printf %03d "$i")-$(basename "$template")
  sed -E -e "s/^(min|max) = \[(-?[0-9]+),/\1 = [\2.00$digit,/" \
    -e "s/^(min|max) = \[(-?[0-9]+\.[0-9]+),/\1 = [\200$digit,/" \
    -e "s/(radius = [0-9]+)([,.])/\1.00$digit\2/; s/(radius = [0-9.]+)\.([, ])/\1\2/" \
    -e "s/^cube = ([0-9]+)$/cube = \1.00$digit/" "$template" >"$name"
done

# Runs, and prints the processor time, the peak memory and the sum of the designs' own seconds.
measure() {
  local label=$1
  shift
  local code=0
  /usr/bin/time -f "%U s user, %S s system, at most %M KiB" "$orthocert" verify designs --format json --quiet \
    --out proofs --max-boxes 20000 "$@" >"$label.json" 2>"$label.txt" || code=$?
  local sum cached
  sum=$(awk -F'[:,]' '/^      "seconds"/ {sum += $2} END {printf "%.3f", sum}' "$label.json")
  cached=$(grep -c '^      "cached": true' "$label.json" || true)
  echo "$label: exit $code, $(tail -n 1 "$label.txt"), designs $sum s, $cached re-checked"
}

for jobs in 1 2; do
  for round in 1 2 3; do
    rm -rf proofs
    measure "cold-jobs$jobs-$round" --jobs "$jobs"
    measure "cached-jobs$jobs-$round" --jobs "$jobs"
  done
done

# For each design that has a verdict, the best cached run over the best cold run, on one core.
seconds() {
  cat "$1"-jobs1-?.json | awk -F'"' '/^      "design"/ {name = $4} /^      "verdict"/ {verdict = $4}
    verdict != "undecided" && /^      "seconds"/ {gsub(/[:, ]/, "", $3); if (!(name in s) || $3 < s[name]) s[name] = $3}
    END {for (name in s) print name, s[name]}' | sort
}
join <(seconds cold) <(seconds cached) | sort -k1 | awk '{
    ratio = $3 / $2; printf "%-58s %8.2f ms %8.2f ms  %.2f\n", $1, 1e3 * $2, 1e3 * $3, ratio
    cold += $2; cached += $3; if (ratio <= 0.2) few++; all[NR] = ratio
  } END {
    printf "all designs: cold %.3f s, cached %.3f s, ratio %.2f\n", cold, cached, cached / cold
    printf "at most a fifth: %d of %d\n", few, NR
  }' | tee table.txt | tail -n 2
awk 'NF == 6 {print $6}' table.txt | sort -n | awk '{r[NR] = $1} END {print "median ratio:", r[int((NR + 1) / 2)]}'
if [ -n "${TABLE:-}" ]; then cat table.txt >"$TABLE"; fi
