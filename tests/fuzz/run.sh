#!/usr/bin/env bash
# Runs the fuzz targets, each for some seconds: run.sh [SECONDS [TARGET...]]
# Builds them with the instrumentation that `cargo fuzz` asks for, but for the address sanitizer
# (there is no unsafe code in the checker); stable Rust and a C++ compiler are enough. The corpora,
# seeded from the repository's certificates and designs, and what is found are in target/fuzz.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
seconds=${1:-60}
shift || true
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(bytes certificate number design)
work=${CARGO_TARGET_DIR:-$root/target}/fuzz
host=$(rustc -vV | sed -n 's/^host: //p')

flags="--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4
  -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table
  -Cllvm-args=-sanitizer-coverage-trace-compares"
# What .cargo/config.toml sets, which RUSTFLAGS replaces.
[ "${host%%-*}" = x86_64 ] && flags="$flags -Ctarget-cpu=haswell"
RUSTFLAGS=$(echo $flags) cargo build --release --locked --quiet --target "$host" \
  --manifest-path "$here/Cargo.toml" --target-dir "$work/build"

"$here/seeds.sh" "$work/corpus"
status=0
for target in "${targets[@]}"; do
  mkdir -p "$work/found/$target"
  # A minute of libFuzzer says what it did in its last lines; its other lines go to a file.
  log=$work/$target.log
  if "$work/build/$host/release/$target" "$work/corpus/$target" \
    -max_total_time="$seconds" -timeout=5 -rss_limit_mb=400 -report_slow_units=1 \
    -artifact_prefix="$work/found/$target/" -print_final_stats=1 \
    $([ "$target" = number ] && echo -max_len=2048 || echo -max_len=8192) >"$log" 2>&1; then
    printf '%s: %s executions, %s in the corpus, ' "$target" \
      "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" \
      "$(find "$work/corpus/$target" -type f | wc -l)"
    printf '%s edges, %s MB, nothing found\n' \
      "$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -1)" \
      "$(sed -n 's/^stat::peak_rss_mb: *//p' "$log")"
  else
    tail -40 "$log" >&2
    echo "$target: found $(find "$work/found/$target" -type f | sort | tail -1)" >&2
    status=1
  fi
done
exit $status
