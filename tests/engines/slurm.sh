#!/bin/bash
# A job's shards through Slurm: a one-node cluster with munge, started here, as root. Twice: once
# undisturbed, once with workers killed, a full disk on one shard, and the node lost in the middle.
# Usage: slurm.sh ORTHOCERT
set -euo pipefail
orthocert=$(realpath "$1")
scratch=$(mktemp -d)
source "$(dirname "$0")/common.sh"
started=()
stop() {
  code=$?
  for pid in "${started[@]}" $(cat "$scratch"/*.pid 2>/dev/null); do
    kill -KILL "$pid" 2>/dev/null || true
  done
  if [ $code -ne 0 ]; then tail -n 20 "$scratch"/*.log "$scratch"/*/engine/*.log >&2 || true; fi
  rm -rf "$scratch"
}
trap stop EXIT

# munge and Slurm with everything of their own: key, sockets, ports, folders.
mkdir "$scratch/ctld" "$scratch/d"
chmod 755 "$scratch"
dd if=/dev/urandom of="$scratch/munge.key" bs=128 count=1 status=none
chmod 600 "$scratch/munge.key"
munged --force --socket="$scratch/munge.sock" --key-file="$scratch/munge.key" \
  --pid-file="$scratch/munged.pid" --log-file="$scratch/munged.log" --seed-file="$scratch/seed"
node=$(hostname -s)
cat >"$scratch/slurm.conf" <<CONF
ClusterName=orthocert
SlurmctldHost=$node
SlurmctldPort=16817
SlurmdPort=16818
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$scratch/munge.sock
StateSaveLocation=$scratch/ctld
SlurmdSpoolDir=$scratch/d
SlurmctldPidFile=$scratch/slurmctld.pid
SlurmdPidFile=$scratch/slurmd.pid
SlurmctldLogFile=$scratch/slurmctld.log
SlurmdLogFile=$scratch/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SlurmdTimeout=3
SlurmctldTimeout=10
KillWait=2
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
MpiDefault=none
NodeName=$node CPUs=2 State=UNKNOWN
PartitionName=here Nodes=$node Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$scratch/slurm.conf
slurmctld
slurmd
for _ in $(seq 100); do
  [ "$(sinfo --noheader --format=%T 2>/dev/null)" = idle ] && break
  sleep 0.2
done
[ "$(sinfo --noheader --format=%T)" = idle ] || fail "the node did not come up"

reference

echo "== undisturbed"
"$orthocert" split "$atlas" --shards 8 --out "$scratch/calm"
"$orthocert" submit "$scratch/calm" --engine slurm --output "$scratch/calm-map"
wait_for "$scratch/calm-map/atlas.cert.json" 90 "the merge"
identical "$scratch/calm-map"

echo "== a paving"
split_paving
"$orthocert" submit "$scratch/pave" --engine slurm --output "$scratch/merged.paving"
wait_for "$scratch/merged.paving" 90 "the merge of the paving"
identical_paving "$scratch/merged.paving"

echo "== workers killed, a full disk, the node lost"
"$orthocert" split "$atlas" --shards 8 --out "$scratch/rough"
fill_disk "$scratch/rough"
"$orthocert" submit "$scratch/rough" --engine slurm --output "$scratch/rough-map"
kill_workers "$scratch/rough" &
started+=($!)
sleep 3
# The node is lost: its daemon and everything that it runs, at once.
steps=$(pgrep -f "^slurmstepd: " || true)
children=$(for step in $steps; do pgrep -P "$step" || true; done)
kill -KILL "$(cat "$scratch/slurmd.pid")" $steps $children $(running "$scratch/rough") 2>/dev/null || true
kill "${started[0]}" 2>/dev/null || true
# Slurm misses it after a while; a site's health check, played here, is quicker.
scontrol update NodeName="$node" State=DOWN Reason=lost
[ ! -e "$scratch/rough-map/atlas.cert.json" ] || fail "the job was over before the node was lost"
free_disk "$scratch/rough"
rm -f "$scratch/slurmd.pid"
slurmd
# Refused where the node has come back by itself already.
scontrol update NodeName="$node" State=RESUME 2>/dev/null || true
# What was requeued would wait two minutes by Slurm's own rule.
for _ in $(seq 300); do
  [ -e "$scratch/rough-map/atlas.cert.json" ] && break
  for job in $(squeue --noheader --states=PENDING --array --format=%i); do
    scontrol update JobId="$job" StartTime=now 2>/dev/null || true
  done
  sleep 0.3
done
wait_for "$scratch/rough-map/atlas.cert.json" 1 "the merge"
identical "$scratch/rough-map"
[ -s "$scratch/killed" ] || fail "no worker was killed"
echo "slurm: $(wc -l <"$scratch/killed") workers killed, one node lost, a disk full: identical"
