#!/usr/bin/env bash
# A sweep on a real Slurm of one node, on the loopback, that is killed in the middle: each run is done once, and none is lost.
# Needs SPRUNG_PROGRAM. Exits with 77 where Slurm cannot be started, unless SPRUNG_NO_SKIPS is set; examples/install_packages.sh slurm
# installs it.
set -euo pipefail

work=$(mktemp --directory)
started=()

finish() {
  for process in "${started[@]}"; do kill -KILL "$process" 2> /dev/null || true; done
  kill_steps
  wait 2> /dev/null || true
  rm -rf "$work"
}
trap finish EXIT

skip() {
  echo "skipped: $1; examples/install_packages.sh slurm installs what is needed"
  tail --lines=3 "$work"/*.log 2> /dev/null || true
  [[ -n ${SPRUNG_NO_SKIPS:-} ]] && exit 1
  exit 77
}

fail() {
  echo "failed: $1"
  squeue || true
  tail --lines=20 "$work"/*.log "$work"/*/slurm/*.log 2> /dev/null || true
  exit 1
}

# wait_until WHAT COMMAND...: the limit of time only ends what hangs.
wait_until() {
  local what=$1
  shift
  for ((k = 0; k < 3000; ++k)); do
    "$@" && return
    sleep 0.1
  done
  fail "$what"
}

# The processes of the steps of this Slurm's jobs, which are not children of slurmd: they work in this folder or write into it.
kill_steps() {
  local process
  for process in /proc/[0-9]*; do
    if tr '\0' ' ' 2> /dev/null < "$process/environ" | grep --quiet "SPRUNG_SLURM_TEST=$work" && [[ ${process##*/} != $$ ]]; then
      case $(cat "$process/comm" 2> /dev/null) in slurmstepd | sprung | sh | slurm_script) kill -KILL "${process##*/}" 2> /dev/null || true ;; esac
    fi
  done
}

for program in munged slurmctld slurmd sbatch squeue scontrol; do
  PATH=$PATH:/usr/sbin command -v $program > /dev/null || skip "$program is missing"
done
PATH=$PATH:/usr/sbin
export SPRUNG_SLURM_TEST=$work SLURM_CONF=$work/slurm.conf

chmod 755 "$work"
mkdir -p "$work"/{munge,state,spool}
chmod 755 "$work/munge"
dd if=/dev/urandom of="$work/munge/key" bs=1024 count=1 2> /dev/null
chmod 600 "$work/munge/key"
munged --foreground --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
  --log-file="$work/munge/log" --seed-file="$work/munge/seed" > "$work/munged.log" 2>&1 &
started+=($!)

port=$((20000 + RANDOM % 20000))
cat > "$SLURM_CONF" <<EOF
ClusterName=sprung
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
CredType=cred/munge
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=2,bf_interval=2
ReturnToService=2
SlurmdTimeout=30
BatchStartTimeout=1
KillWait=5
JobRequeue=1
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP
EOF

start_slurmd() {
  slurmd -D >> "$work/slurmd.log" 2>&1 &
  slurmd=$!
  started+=("$slurmd")
}

for ((k = 0; k < 100; ++k)); do [[ -S $work/munge/socket ]] && break; sleep 0.1; done
[[ -S $work/munge/socket ]] || skip "munged does not start"
slurmctld -D > "$work/slurmctld.log" 2>&1 &
started+=($!)
start_slurmd
is_idle() { [[ $(sinfo --noheader --format=%t 2> /dev/null) == idle ]]; }
for ((k = 0; k < 300; ++k)); do is_idle && break; sleep 0.1; done
is_idle || skip "slurmctld and slurmd do not start"

# 12 runs of some seconds each, in two tasks.
cat > "$work/rope.json" <<'EOF'
{ "duration": 40, "step": 0.00033333333333333335,
  "bodies": { "rope": { "shape": { "type": "rope", "from": [0, 2, 0], "to": [1, 2, 0], "particles": 5 }, "mass": 0.1,
    "springs": { "structural": { "stiffness": 100, "damping": 0.01 } }, "pins": [{ "indices": [0] }] } } }
EOF
masses=0.1,0.11,0.12,0.13,0.14,0.15,0.16,0.17,0.18,0.19,0.2,0.21
swept="$work/it's 100%j \"swept\"" # Slurm would replace %j
sweep=("$SPRUNG_PROGRAM" sweep "$work/rope.json" --out "$swept" --vary "bodies.rope.mass=$masses" --checkpoint 0.5
  --engine slurm --array-size 2)
"${sweep[@]}" --partition all --time 30:00
"${sweep[@]}" && fail "a second job of the same sweep was submitted"

ended() { cat "$swept"/journal/*.jsonl 2> /dev/null | wc --lines; }
has_ended() { (($(ended) >= $1)); }
wait_until "no run ended" has_ended 3
"$SPRUNG_PROGRAM" sweep --status "$swept"
echo "slurmd and the processes of its job are killed"
kill -KILL "$slurmd"
kill_steps
wait "$slurmd" 2> /dev/null || true
(($(ended) < 12)) || fail "all runs were done before the kill"
before=$(ended)
sleep 12 # slurmctld misses no job that is younger than BatchStartTimeout and MessageTimeout (10 s), and looks again a minute later
start_slurmd

# Slurm holds a job that it queued again back for two minutes, because slurmd starts none that it has just forgotten.
is_queued_again() { [[ $(squeue --noheader --array --format=%t | sort --unique) == PD ]]; }
wait_until "the tasks are not queued again" is_queued_again
sleep 3
for job in $(squeue --noheader --array --format=%A); do scontrol update jobid="$job" starttime=now; done
is_over() { [[ -z $(squeue --noheader) ]]; }
wait_until "the job does not end" is_over
"$SPRUNG_PROGRAM" sweep --status "$swept" | tee "$work/status"
grep --quiet "12: 12 done, 0 failed, 0 running, 0 pending" "$work/status" || fail "runs are missing"
numbers=$(sed 's/.*"run":\([0-9]*\).*/\1/' "$swept"/journal/*.jsonl | sort --numeric-sort | paste --serial --delimiters=' ')
[[ $numbers == "1 2 3 4 5 6 7 8 9 10 11 12" ]] || fail "runs ended more than once: $numbers"
(($(wc --lines < "$swept/results.csv") == 13)) || fail "results.csv lacks lines"
[[ -f $swept/slurm/task-0.log && -f $swept/slurm/task-1.log ]] || fail "the tasks have no log"
echo "$before runs were done before the kill, and all once after it"
