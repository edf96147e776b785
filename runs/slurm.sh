#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# SLURM job, one rank per GPU, two nodes with four GPUs each: sbatch runs/slurm.sh SCENE [OPTIONS OF grouser run...]
#SBATCH --job-name=grouser
#SBATCH --nodes=2
#SBATCH --ntasks-per-node=4
#SBATCH --gpus-per-node=4
#SBATCH --cpus-per-task=8
#SBATCH --time=04:00:00
#SBATCH --signal=B:TERM@120
# Two minutes before the time limit the job receives SIGTERM and all ranks stop after writing a checkpoint. To continue:
#   sbatch runs/slurm.sh SCENE --resume
set -euo pipefail
scene=${1:?usage: sbatch runs/slurm.sh SCENE [OPTIONS...]}
shift
export OMP_NUM_THREADS=${SLURM_CPUS_PER_TASK:-1}
trap 'kill -TERM "$launcher"; wait "$launcher"' TERM
mpirun -np "${SLURM_NTASKS:?start it with sbatch}" --map-by "ppr:${SLURM_NTASKS_PER_NODE:-4}:node:PE=${SLURM_CPUS_PER_TASK:-1}" \
  "${GROUSER:-$(command -v build/bin/grouser || echo grouser)}" run "$scene" --device cuda "$@" &
launcher=$!
wait "$launcher"
