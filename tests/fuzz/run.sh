#!/usr/bin/env bash
# Runs the fuzz targets, each for some seconds, as many at a time as there are processors:
#   run.sh [SECONDS [TARGET...]]
# ORTHOCERT_FUZZ_SEED=N fixes what is random.
# Builds them with the instrumentation that `cargo fuzz` asks for, but for the address sanitizer
# (there is no unsafe code here); stable Rust and a C++ compiler are enough. The corpora, seeded from
# the repository's certificates and designs, and what is found are in target/fuzz.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
seconds=${1:-60}
shift || true
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(bytes certificate number design)
work=${CARGO_TARGET_DIR:-$root/target}/fuzz
host=$(rustc -vV | sed -n 's/^host: //p')

flags="--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4"
for what in inline-8bit-counters pc-table trace-compares; do
  flags="$flags -Cllvm-args=-sanitizer-coverage-$what"
done
# What runs for seconds is not worth minutes of optimising.
quick=()
if [ "$seconds" -lt 60 ]; then
  for package in orthocert=0 nalgebra=0 orthocert-kernel=1 orthocert-checker=1; do
    quick+=(--config "profile.release.package.${package%=*}.opt-level=${package#*=}")
  done
fi
RUSTFLAGS=$flags cargo build --release --locked --quiet --target "$host" \
  --manifest-path "$here/Cargo.toml" --target-dir "$work/build" "${quick[@]}"
"$here/seeds.sh" "$work/corpus"

# A few dozen edits fit in the bytes of `certificate`; the others read texts.
most_bytes() { case $1 in certificate) echo 96 ;; number) echo 1024 ;; *) echo 8192 ;; esac; }

fuzz() {
  local target=$1 log=$work/$1.log
  mkdir -p "$work/found/$target"
  if ! "$work/build/$host/release/$target" "$work/corpus/$target" -max_total_time="$seconds" \
    -timeout=20 -rss_limit_mb=400 -max_len="$(most_bytes "$target")" \
    -seed="${ORTHOCERT_FUZZ_SEED:-0}" -print_final_stats=1 \
    -artifact_prefix="$work/found/$target/" >"$log" 2>&1; then
    tail -40 "$log" >&2
    echo "$target: the input is in $work/found/$target" >&2
    return 1
  fi
  printf '%s: %s executions, %s edges, at most %s MB, nothing found\n' "$target" \
    "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" \
    "$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -1)" \
    "$(sed -n 's/^stat::peak_rss_mb: *//p' "$log")"
}

pids=() status=0
for target in "${targets[@]}"; do
  while [ "$(jobs -rp | wc -l)" -ge "$(nproc)" ]; do sleep 1; done
  fuzz "$target" &
  pids+=($!)
done
for pid in "${pids[@]}"; do wait "$pid" || status=1; done
exit $status
