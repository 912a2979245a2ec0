#!/bin/bash
# A job's shards through HyperQueue. Twice: once undisturbed, once with workers killed, a full disk
# on one shard, and the whole cluster lost in the middle and started again.
# Usage: hyperqueue.sh ORTHOCERT; python3 has the package hyperqueue.
set -euo pipefail
orthocert=$(realpath "$1")
scratch=$(mktemp -d)
source "$(dirname "$0")/common.sh"
cluster=$(dirname "$(realpath "$0")")/local_cluster.py
export TMPDIR=$scratch
started=()
stop() {
  code=$?
  for pid in "${started[@]}"; do kill -KILL "$pid" 2>/dev/null || true; done
  if [ $code -ne 0 ]; then tail -n 20 "$scratch"/*/engine/*.{log,err} >&2 || true; fi
  rm -rf "$scratch"
}
trap stop EXIT

reference

echo "== undisturbed"
"$orthocert" split "$atlas" --shards 8 --out "$scratch/calm"
python3 "$cluster" "$orthocert" "$scratch/calm" "$scratch/calm-map" 60
identical "$scratch/calm-map"

echo "== a paving, workers killed"
split_paving
kill_workers "$scratch/pave" &
started+=($!)
(sleep 3; kill "${started[-1]}" 2>/dev/null) &
python3 "$cluster" "$orthocert" "$scratch/pave" "$scratch/merged.paving" 60
identical_paving "$scratch/merged.paving"

echo "== workers killed, a full disk, the cluster lost"
"$orthocert" split "$atlas" --shards 8 --out "$scratch/rough"
fill_disk "$scratch/rough"
kill_workers "$scratch/rough" &
started+=($!)
python3 "$cluster" "$orthocert" "$scratch/rough" "$scratch/rough-map" 60 &
lost=$!
sleep 3
kill -KILL "$lost" $(running "$scratch/rough") 2>/dev/null || true
kill "${started[-1]}" 2>/dev/null || true
wait "$lost" 2>/dev/null || true
[ ! -e "$scratch/rough-map/atlas.cert.json" ] || fail "the job was over before the cluster was lost"
free_disk "$scratch/rough"
python3 "$cluster" "$orthocert" "$scratch/rough" "$scratch/rough-map" 60
identical "$scratch/rough-map"
[ -s "$scratch/killed" ] || fail "no worker was killed"
echo "hyperqueue: $(wc -l <"$scratch/killed") workers killed, a cluster lost, a disk full: identical"
