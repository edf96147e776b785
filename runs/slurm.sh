#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A SLURM job of one rank a GPU on two nodes of four: sbatch runs/slurm.sh SCENE [WORDS OF grouser run...]
#SBATCH --job-name=grouser
#SBATCH --nodes=2
#SBATCH --ntasks-per-node=4
#SBATCH --gpus-per-node=4
#SBATCH --cpus-per-task=8
#SBATCH --time=04:00:00
#SBATCH --signal=B:TERM@120
# Two minutes before the end the job gets SIGTERM, hands it on, and every rank stops behind a checkpoint: go on with
#   sbatch runs/slurm.sh SCENE --resume
set -euo pipefail
scene=${1:?usage: sbatch runs/slurm.sh SCENE [WORDS...]}
shift
export OMP_NUM_THREADS=${SLURM_CPUS_PER_TASK:-1}
trap 'kill -TERM "$launcher"; wait "$launcher"' TERM
mpirun -np "${SLURM_NTASKS:?start it with sbatch}" --map-by "ppr:${SLURM_NTASKS_PER_NODE:-4}:node:PE=${SLURM_CPUS_PER_TASK:-1}" \
  "${GROUSER:-$(command -v build/bin/grouser || echo grouser)}" run "$scene" --device cuda "$@" &
launcher=$!
wait "$launcher"
