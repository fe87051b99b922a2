#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# slurm.sh -- the runs as an array of jobs on a cluster, from this folder:
#     make out/leg.dat && sbatch slurm.sh
# When all are done, `make` adds them up.
#SBATCH --job-name=ensemble
#SBATCH --array=1-50
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --time=00:10:00
#SBATCH --output=out/%a.log
set -eu
cd "${SLURM_SUBMIT_DIR:-$(dirname "$0")}"
exec sh one.sh "$SLURM_ARRAY_TASK_ID"
