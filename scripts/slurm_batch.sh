#!/usr/bin/env bash
# An array job: each task does its part of a batch, and goes on where it was when it is begun again.
#   sbatch --array=1-100 scripts/slurm_batch.sh JOBS DIR [options of littoral batch]
# JOBS and DIR lie in a file system that all nodes share.
#SBATCH --job-name=littoral
#SBATCH --cpus-per-task=4
#SBATCH --mem=16G
#SBATCH --requeue
set -euo pipefail
[ $# -ge 2 ] || { echo "usage: slurm_batch.sh JOBS DIR [options]" >&2; exit 2; }
jobs=$1 folder=$2
shift 2
exec "${LITTORAL:-littoral}" batch "$jobs" -o "$folder" \
  --shard "$((SLURM_ARRAY_TASK_ID - SLURM_ARRAY_TASK_MIN + 1))/$SLURM_ARRAY_TASK_COUNT" \
  --jobs "${SLURM_CPUS_PER_TASK:-1}" --progress never "$@"
