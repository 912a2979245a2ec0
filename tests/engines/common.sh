# What both engines' tests share: a job of a few seconds, the folder that one machine writes for it,
# and the mishaps. Sourced with `orthocert` (the program) and `scratch` (an empty folder) set.

atlas=$scratch/job.toml
sed -e 's/^resolution = .*/resolution = 6/' -e 's/^boxes = .*/boxes = 4000/' \
  "$(dirname "${BASH_SOURCE[0]}")/../atlases/linear-delta-2.toml" >"$atlas"

# A paving of a few seconds.
design=$scratch/design.toml
cat >"$design" <<'DESIGN'
[mechanism]
kind = "orthoglide"
leg_length = 1
[workspace]
min = [-0.7, -0.7, -0.7]
max = [0.7, 0.7, 0.7]
[requirements]
transmission = { min = "1/2", max = 2 }
DESIGN
precision=0.0022

reference() {
  "$orthocert" atlas "$atlas" --output "$scratch/one" --quiet
  "$orthocert" pave "$design" --precision $precision --output "$scratch/one.paving" --quiet
}

split_paving() {
  "$orthocert" split "$design" --pave --precision $precision --shards 8 --out "$scratch/pave"
}

fail() { echo "FAILED: $*" >&2; exit 1; }

# Waits until a file is there: wait_for FILE SECONDS WHAT
wait_for() {
  local end=$((SECONDS + $2))
  until [ -e "$1" ]; do
    [ $SECONDS -lt $end ] || fail "$3 was not finished within $2 s"
    sleep 0.2
  done
}

identical() { diff -r "$scratch/one" "$1" || fail "$1 is not what one machine writes"; }

identical_paving() { cmp "$scratch/one.paving" "$1" || fail "$1 is not what one machine writes"; }

# The processes that run shards of a folder, by what they were started with.
running() {
  local pid
  for pid in $(pgrep -x orthocert); do
    tr '\0' '\n' <"/proc/$pid/cmdline" 2>/dev/null | grep -q "^$1/shard-" && echo "$pid"
  done
  return 0
}

# Kills one of those every so often, until told to stop: mishaps FOLDER
kill_workers() {
  local pid shard
  touch "$scratch/killed"
  while sleep 0.4; do
    for pid in $(running "$1"); do
      shard=$(tr '\0' '\n' <"/proc/$pid/cmdline" 2>/dev/null | grep "^$1/shard-") || continue
      # The first whose shard was killed less than twice: a task gives up after three attempts.
      [ "$(grep -cxF "$shard" "$scratch/killed")" -lt 2 ] || continue
      if kill -KILL "$pid" 2>/dev/null; then echo "$shard" >>"$scratch/killed"; fi
      break
    done
  done
}

# Puts shard 5's progress on a full disk.
fill_disk() { ln -s /dev/full "$1/result-0005.part"; }
free_disk() { rm -f "$1/result-0005.part"; }
