#!/usr/bin/env bash
# What remains on the disk when something goes wrong: every certificate and every report is whole
# and valid, or it is not there. Usage: tests/faults.sh ORTHOCERT ORTHOCERT-CHECK [ROUNDS [SEED]]
#
# | fault    | what is done                                                              |
# |----------|---------------------------------------------------------------------------|
# | kill     | kill -9 at random moments of a verification, over an earlier certificate  |
# | batch    | kill -9 at random moments of a batch that writes certificates and reports |
# | atlas    | kill -9 at random moments of a map that takes the place of another one    |
# | disk     | a full disk: a small tmpfs where one can be mounted, else /dev/full        |
# | readonly | a read-only disk, folder and file                                         |
# | race     | two batches that write the same files                                     |
# | clock    | clocks that jump and run backwards (where faketime is installed)          |
# | memory   | address spaces from too small to large enough                             |
set -euo pipefail
orthocert=$(realpath "$1")
check=$(realpath "$2")
rounds=${3:-10}
RANDOM=${4:-1}
designs=$(realpath "$(dirname "$0")/designs")
scratch=$(mktemp -d)
mounted=
# shellcheck disable=SC2329
clean() {
  if [ -n "$mounted" ]; then umount "$mounted"; fi
  rm -rf "$scratch"
}
trap clean EXIT
cd "$scratch"

fail() {
  echo "FAULT: $*" >&2
  exit 1
}

# Every file below $1 that has its final name is whole and valid.
whole() {
  local file code
  while IFS= read -r -d '' file; do
    case $file in
      *.cert.json)
        code=0
        "$check" "$file" >/dev/null 2>&1 || code=$?
        [ "$code" -le 1 ] || fail "$file: the checker exits $code"
        ;;
      *.xml) [ "$(tail -n 1 "$file")" = "</testsuite>" ] || fail "$file is cut off" ;;
      *.sarif) [ "$(tail -n 1 "$file")" = "}" ] || fail "$file is cut off" ;;
      *.md) [ -n "$(tail -c 2 "$file" | tr -d '\n')" ] || fail "$file is cut off" ;;
      *) fail "$file: who wrote that?" ;;
    esac
  done < <(find "$1" -type f -not -name '.orthocert-*.part' -print0)
}

# Runs with exit code $1, and where that is 4 with a sentence on standard error.
exits() {
  local expected=$1 code=0
  shift
  "$@" >stdout.txt 2>stderr.txt || code=$?
  [ "$code" = "$expected" ] || fail "$* exits $code, not $expected: $(cat stderr.txt)"
  if [ "$code" = 4 ]; then
    grep -qE "cannot be|interrupted" stderr.txt stdout.txt || fail "$* exits 4 without a sentence"
  fi
}

# Starts a command, and kills it after at most $1 ms.
kill_within() {
  local limit=$1 pid
  shift
  "$@" >/dev/null 2>&1 &
  pid=$!
  sleep "$(printf '0.%03d' $((RANDOM % limit)))"
  if kill -9 "$pid" 2>/dev/null; then killed=$((killed + 1)); fi
  wait "$pid" 2>/dev/null || true
}

batch=("$orthocert" verify "$designs" --max-boxes 20000 --quiet)
reports=(--junit out/j.xml --sarif out/s.sarif --summary out/s.md)
# Every certificate of the reference is in the other folder, the same.
same() {
  local file
  while read -r file; do cmp "reference/$file" "out/$file"; done < <(cd reference && find . -type f)
}
mkdir reference
code=0
"${batch[@]}" --out reference >/dev/null || code=$?
[ "$code" = 1 ] || fail "the designs exit $code"
count=$(find reference -name '*.cert.json' | wc -l)

killed=0
mkdir one
for ((i = 0; i < rounds; i++)); do
  design=$designs/delta-conditioning.toml
  if ((i % 3 == 0)); then rm -f one/c.cert.json; fi
  kill_within 60 "$orthocert" verify "$design" -o one/c.cert.json --reprove
  whole one
done
echo "kill: $rounds rounds, $killed killed in time, nothing lost"

killed=0
mkdir out
for ((i = 0; i < rounds; i++)); do
  again=()
  if ((i % 2)); then again=(--reprove); fi
  before=$(find out -name '*.cert.json' | wc -l)
  kill_within 900 "${batch[@]}" --out out "${reports[@]}" "${again[@]}"
  whole out
  [ "$(find out -name '*.cert.json' | wc -l)" -ge "$before" ] || fail "a certificate was lost"
done
exits 1 "${batch[@]}" --out out "${reports[@]}"
same
left=$(find out one -name '.orthocert-*.part' | wc -l)
echo "batch: $rounds rounds, $killed killed in time, nothing lost; $left hidden parts left behind"

# Two maps take each other's place: at every moment the folder holds one of them, whole.
killed=0 first=0 second=0
for which in 1 2; do
  sed -e 's/resolution = 8/resolution = 3/' -e "s/max = 4, label/max = $((which + 3)), label/" \
    "$designs/../atlases/orthoglide.toml" >"map$which.toml"
  exits 0 "$orthocert" atlas "map$which.toml" -o "map$which" --quiet
done
if cmp -s map1/SHA256SUMS map2/SHA256SUMS; then fail "the two maps are one"; fi
for ((i = 0; i < 3 * rounds; i++)); do
  kill_within 400 "$orthocert" atlas "map$((i % 2 + 1)).toml" -o map --quiet
  [ -d map ] || continue
  if diff -r map map1 >/dev/null; then first=$((first + 1)); else
    diff -r map map2 || fail "a map is neither the one nor the other"
    second=$((second + 1))
  fi
done
exits 0 "$orthocert" atlas map1.toml -o map --quiet
diff -r map map1
left=$(find . -maxdepth 1 -name '.orthocert-*.part' | wc -l)
rm -rf .orthocert-*.part
echo "atlas: $((3 * rounds)) rounds, $killed killed in time, found $first and $second times whole;" \
  "$left hidden folders left behind"

mkdir disk
if mount -t tmpfs -o size=96k tmpfs disk 2>/dev/null; then
  mounted=$scratch/disk
  mkdir disk/proofs
  exits 4 "${batch[@]}" --out disk/proofs --junit disk/proofs/j.xml
  whole disk
  kept=$(find disk -name '*.cert.json' | wc -l)
  [ "$kept" -gt 0 ] && [ "$kept" -lt "$count" ] || fail "$kept of $count certificates fit"
  [ -z "$(find disk -name '.orthocert-*.part')" ] || fail "a part was left on the full disk"
  mount -o remount,size=16m disk
  exits 1 "${batch[@]}" --out disk/proofs --junit disk/proofs/j.xml
  whole disk
  echo "disk: $kept of $count certificates fitted, all of them when there was room"
  mount -o remount,ro disk
  exits 4 "${batch[@]}" --out disk/proofs --reprove
  exits 4 "$orthocert" verify -o disk/proofs/c.cert.json
  whole disk
  umount disk
  mounted=
  echo "readonly: a read-only disk is left as it was"
else
  exits 4 "$orthocert" verify -o /dev/full
  exits 4 "${batch[@]}" --out out --junit /dev/full
  echo "disk: /dev/full (no tmpfs can be mounted here)"
fi
chmod a-w out/*.cert.json
exits 4 "${batch[@]}" --out out --reprove
exits 1 "${batch[@]}" --out out
same
chmod u+w out/*.cert.json
echo "readonly: read-only certificates are kept, and re-checked"

for ((i = 0; i < (rounds + 4) / 5; i++)); do
  rm -rf both
  "${batch[@]}" --out both --reprove >/dev/null 2>first.txt &
  first=$!
  exits 1 "${batch[@]}" --out both --reprove
  code=0
  wait "$first" || code=$?
  [ "$code" = 1 ] || fail "the other process exits $code: $(cat first.txt)"
  whole both
  diff -r reference both || fail "two processes wrote something else than one"
done
echo "race: $(((rounds + 4) / 5)) rounds of two processes, the same files as of one"

source=$(realpath "$designs/../..")
if grep -rn SystemTime "$source/src" "$source/proofs/checker/src"; then
  fail "the wall clock is read"
fi
if command -v faketime >/dev/null; then
  for clock in '@1970-01-02 00:00:00' '+30y' '+0 x1000' '+0 i-10.0'; do
    rm -f c.cert.json
    exits 0 timeout 60 faketime -f "$clock" "$orthocert" verify -o c.cert.json --timeout 1h
    cmp c.cert.json reference/orthoglide-prototype.cert.json
  done
  echo "clock: 4 clocks, the same certificate"
else
  echo "clock: nothing reads the wall clock (faketime is not installed)"
fi

ended=0 refused=0
for megabytes in 8 12 16 20 24 28 32 40 48 64 96 128 256 512 1024; do
  rm -rf small
  code=0
  { (
    ulimit -v $((megabytes * 1024)) -c 0
    # One heap for all threads: glibc's own for each needs 128 MB of addresses, and is slow without.
    MALLOC_ARENA_MAX=1 exec timeout 60 "${batch[@]}" --out small >/dev/null 2>stderr.txt
  ) || code=$?; } 2>/dev/null
  if [ -d small ]; then whole small; fi
  case $code in
    1) ended=$((ended + 1)) ;;
    0) fail "a batch with a refuted design exits 0 in $megabytes MB" ;;
    *) refused=$((refused + 1)) ;;
  esac
done
[ "$ended" -gt 0 ] || fail "no size was large enough"
echo "memory: 15 sizes, $ended large enough, $refused too small; what was written is whole"
