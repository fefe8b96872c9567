#!/bin/bash
# Complex eigenvalues of one large case over 4 machines: sbatch cea.sh brake.toml
#SBATCH --job-name=stridor-cea
#SBATCH --nodes=4
#SBATCH --ntasks-per-node=16
#SBATCH --cpus-per-task=1
#SBATCH --exclusive
#SBATCH --mem=0
#SBATCH --time=04:00:00
#SBATCH --output=%x-%j.log
set -euo pipefail
case=${1:?usage: sbatch cea.sh CASE}

# MUMPS: one thread on each rank.
export OMP_NUM_THREADS=1
# The log gets no colours.
export NO_COLOR=1
# Rank 0's own work takes the cores of its machine while the other ranks wait; so no rank is bound to a core.
mpirun --bind-to none stridor-mpi cea "$case" --engine slepc --threads "${SLURM_NTASKS_PER_NODE:-1}" --out "results/$SLURM_JOB_ID"
