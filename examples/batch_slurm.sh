#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A table of tasks on a Slurm cluster: an array of jobs makes the motions, then one job writes what a single machine
# would: DIR/results.csv and the gallery.
#
#     bash examples/batch_slurm.sh tasks.csv --out DIR [option...] [-- option of sbatch...]
#
#       --chunks N      so many jobs (16); each starts Blender once
#       --scene FILE    the .blend whose rigs and objects the table names
#       --corpus FILE   motions to learn from; without it the corpus that ships
#       --retries N     so often a chunk that failed is requeued (3); a lost node's chunks are always
#       --wait          until all is done; the exit status is the collecting job's: 1 if motions are missing or failed
#
# DIR, the table, the project and Blender must be at the same place on every node. Submitted again, it does what is
# missing or has changed. Logs are in DIR/slurm. What follows -- is for sbatch: -- --partition=short --mem=4G
set -euo pipefail
ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

fail() {
  echo "batch_slurm.sh: $*" >&2
  exit 2
}

read_arguments() {
  TABLE='' OUT='' SCENE='' CORPUS='' CHUNKS=16 RETRIES=3 WAIT=()
  while [ $# -gt 0 ]; do
    case $1 in
      --out | --scene | --corpus | --chunks | --retries)
        [ $# -ge 2 ] || fail "$1 needs a value"
        local name=${1#--}
        printf -v "${name^^}" %s "$2"
        shift 2
        ;;
      --wait) WAIT=(--wait) && shift ;;
      -h | --help) sed -n '3,/^set/{/^set/d;s/^# \{0,1\}//;p}' "${BASH_SOURCE[0]}" && exit ;;
      --) shift && break ;;
      -*) fail "there is no option '$1'; --help names them" ;;
      *) [ -z "$TABLE" ] || fail "there are two tables, '$TABLE' and '$1'" && TABLE=$1 && shift ;;
    esac
  done
  SBATCH=("$@")
  if [ -z "$TABLE" ] || [ -z "$OUT" ]; then fail "a table and --out DIR are needed"; fi
  [[ $CHUNKS =~ ^[1-9][0-9]*$ ]] || fail "--chunks is '$CHUNKS'; it must be a whole number from 1"
  [[ $RETRIES =~ ^[0-9]+$ ]] || fail "--retries is '$RETRIES'; it must be a whole number from 0"
  local file
  for file in "$TABLE" ${SCENE:+"$SCENE"} ${CORPUS:+"$CORPUS"}; do
    [ -r "$file" ] || fail "the file '$file' cannot be read"
  done
  command -v sbatch >/dev/null || fail "there is no sbatch here (Debian: apt-get install slurm-wlm)"
}

# The command of a job, as text for its script.
batch_command() {
  local words=(blender -b)
  [ -z "$SCENE" ] || words+=("$(realpath "$SCENE")")
  words+=(--factory-startup --python-exit-code 1 --python "$ROOT/examples/batch.py" -- "$(realpath "$TABLE")" --out "$OUT")
  [ -z "$CORPUS" ] || words+=(--corpus "$(realpath "$CORPUS")")
  echo "${words[@]@Q}"
}

submit_chunks() {
  sbatch --parsable --array="1-$CHUNKS" --requeue --open-mode=append --job-name=reachcast --output="$OUT/slurm/%a.log" \
    "${SBATCH[@]}" <<JOB
#!/usr/bin/env bash
echo "chunk \$SLURM_ARRAY_TASK_ID of $CHUNKS on \$SLURMD_NODENAME, start \$((\${SLURM_RESTART_COUNT:-0} + 1))"
$(batch_command) --part "\$SLURM_ARRAY_TASK_ID/$CHUNKS"
status=\$?
[ \$status -eq 0 ] || [ "\${SLURM_RESTART_COUNT:-0}" -ge $RETRIES ] || scontrol requeue "\$SLURM_JOB_ID"
exit \$status
JOB
}

# Begins when every chunk has ended, however it did.
submit_collecting() {
  sbatch --parsable --dependency="afterany:$1" --open-mode=append --job-name=reachcast-collect \
    --output="$OUT/slurm/collect.log" "${WAIT[@]}" "${SBATCH[@]}" <<JOB
#!/usr/bin/env bash
$(batch_command) --collect
JOB
}

main() {
  read_arguments "$@"
  mkdir -p "$OUT/slurm"
  OUT=$(realpath "$OUT")
  local chunks
  chunks=$(submit_chunks)
  echo "$CHUNKS chunks: job ${chunks%%;*}; when they have ended, $OUT/results.csv and index.html are written"
  submit_collecting "${chunks%%;*}"
}

main "$@"
