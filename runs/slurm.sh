#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# SLURM job, one rank per GPU, two nodes with four GPUs each: sbatch runs/slurm.sh SCENE [OPTIONS OF grouser run...]
#SBATCH --job-name=grouser
#SBATCH --nodes=2
#SBATCH --ntasks-per-node=4
#SBATCH --gpus-per-node=4
#SBATCH --cpus-per-task=8
#SBATCH --time=04:00:00
#SBATCH --signal=B:USR1@300
#SBATCH --requeue
#SBATCH --open-mode=append
# Before the time limit, all ranks receive SIGUSR1, write a checkpoint and stop. They have 60 s for this, plus the time
# in which the disk writes the checkpoint (its size: grouser plan). To continue:
#   sbatch runs/slurm.sh SCENE --resume
# A job that SLURM requeues continues by itself. Environment variables (docs/large_runs.md#slurm):
#   GROUSER_DISK_MBPS      speed of the disk of the results, default 100 MB/s
#   GROUSER_STOP_SECONDS   time for the checkpoint, instead of the computed one
#   GROUSER_REQUEUE=1      requeues the job at its time limit
#   GROUSER_LAUNCHER=srun  starts the ranks by srun --mpi=pmix, instead of mpirun
set -euo pipefail
scene=${1:?usage: sbatch runs/slurm.sh SCENE [OPTIONS...]}
shift
tasks=${SLURM_NTASKS:?start it with sbatch} cores=${SLURM_CPUS_PER_TASK:-1}
grouser=${GROUSER:-$(command -v build/bin/grouser || echo grouser)}
export OMP_NUM_THREADS=$cores
fail() { echo "runs/slurm.sh: $*" >&2; exit 2; }
number() { # number NAME DEFAULT: value of a variable
  [[ ${!1:-$2} =~ ^[1-9][0-9]{0,5}$ ]] || fail "$1 = '${!1}' must be a whole number from 1 to 999999"
  echo "${!1:-$2}"
}

# Settings of the scene, and the results folder, from the options.
settings=() out="" resumes=0 next=""
folder=$(sed -n '/^ *\[output\]/,/^ *\[[^o]/s/^ *folder *= *["'\'']\([^"'\'']*\).*/\1/p' "$scene" 2>/dev/null | head -n 1)
for word in "$@"; do
  case $next in
    --set | --out | --output) word=$next=$word ;;
  esac
  next=""
  case $word in
    --set | --out | --output) next=$word ;;
    --set=*)
      settings+=("$word")
      if [[ $word =~ ^--set=output\.folder=[\"\']?([^\"\']*) ]]; then folder=${BASH_REMATCH[1]}; fi
      ;;
    --out=* | --output=*) out=${word#*=} ;;
    --resume*) resumes=1 ;;
  esac
done
out=${out:-${folder:-out/$(basename "$scene" .toml)}}

# Time for the last checkpoint.
rate=$(number GROUSER_DISK_MBPS 100)
plan=$(mktemp)
bytes=0
if "$grouser" plan "$scene" "${settings[@]}" --json "$plan" >/dev/null; then
  bytes=$(sed -n 's/.*"checkpoint_bytes": *\([0-9]*\).*/\1/p' "$plan")
fi
rm -f "$plan"
seconds=$(number GROUSER_STOP_SECONDS $((60 + ${bytes:-0} / (rate * 1000000))))

# The job's time limit, less this time, and half a minute for MPI and SLURM.
limit=()
end=${SLURM_JOB_END_TIME:-$(date -d "$(squeue -h -j "${SLURM_JOB_ID:-}" -o %e 2>/dev/null)" +%s 2>/dev/null || true)}
if [[ $end =~ ^[0-9]+$ ]] && [ "$end" -gt "$(date +%s)" ]; then
  left=$((end - $(date +%s) - seconds - 30))
  [ $left -gt 0 ] || fail "the last checkpoint needs $((seconds + 30)) s before the time limit; raise --time"
  limit=(timeout --foreground --signal=USR1 "$left")
  echo "runs/slurm.sh: stops in $left s, $((seconds + 30)) s before the time limit, to write a checkpoint, or when" \
    "SLURM sends SIGUSR1 (--signal)" >&2
elif [ "$seconds" -gt 270 ]; then
  echo "runs/slurm.sh: WARNING: the time limit is unknown, and a checkpoint needs $seconds s; submit with" \
    "sbatch --signal=B:USR1@$((seconds + 30))" >&2
fi

# A requeued job has the options of its first start. It continues or overwrites only results whose manifest names this
# job; grouser itself refuses a folder with other results.
again=()
if [ "${SLURM_RESTART_COUNT:-0}" -gt 0 ] && [ $resumes -eq 0 ]; then
  own=$(sed -n 's/^  "slurm_job": "\(.*\)",\{0,1\}$/\1/p' "$out/manifest.json" 2>/dev/null || true)
  if [ "$own" = "${SLURM_CLUSTER_NAME:+$SLURM_CLUSTER_NAME }${SLURM_JOB_ID:-}" ]; then
    if [ -f "$out/checkpoint.h5" ]; then again=(--resume); else again=(--force); fi
  elif [ -e "$out" ]; then
    echo "runs/slurm.sh: WARNING: $out contains no results of this job ${SLURM_JOB_ID:-}; it is left unchanged" >&2
  fi
fi
case ${GROUSER_LAUNCHER:-mpirun} in
  mpirun) launch=(mpirun -np "$tasks" --map-by "ppr:${SLURM_NTASKS_PER_NODE:-4}:node:PE=$cores") ;;
  srun) launch=(srun --mpi=pmix --kill-on-bad-exit=1 --cpus-per-task="$cores") ;;
  *) fail "GROUSER_LAUNCHER = '$GROUSER_LAUNCHER' must be mpirun or srun" ;;
esac
"${limit[@]}" "${launch[@]}" "$grouser" run "$scene" "$@" "${again[@]}" &
job=$!
# mpirun and srun forward SIGUSR1. After SIGTERM, mpirun would kill the ranks within a second.
signalled=0 # time of a signal from SLURM or scancel
trap 'signalled=$(date +%s); kill -USR1 "$job" 2>/dev/null || true' USR1 TERM
while kill -0 "$job" 2>/dev/null; do # a signal ends wait early, while the ranks still write their checkpoint
  wait "$job" || true
done
status=0
wait "$job" || status=$?
# Stopped by the timer above, or by the signal that SLURM sends 300 s (and up to a minute more) before the time limit.
limited=0
if [ "$status" -eq 124 ]; then limited=1; fi
if [ "$status" -eq 138 ] && [[ $end =~ ^[0-9]+$ ]] && [ "$signalled" -ge $((end - 360)) ]; then limited=1; fi
if [ "$limited" -eq 1 ] && [ "${GROUSER_REQUEUE:-0}" = 1 ]; then scontrol requeue "${SLURM_JOB_ID:?}"; fi
exit "$status"
