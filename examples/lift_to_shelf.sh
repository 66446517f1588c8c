#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
set -euo pipefail
ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$ROOT/examples/setup.sh"

OUT=out CORPUS=$ROOT/addon/reachcast/data/simulated.sqlite RIG=mannequin SHELF=(0.55 0.35 1.05) STATURE=1.75 QUICK=()

usage() {
  cat <<'TEXT'
Predicts how a worker lifts a box from a low pallet to a shelf, and renders it with Blender.

    bash examples/lift_to_shelf.sh [--out DIR] [--corpus FILE] [--rig mannequin|rigify] [--shelf X Y Z] [--stature M]

  --out DIR       where the results go (default: out)
  --corpus FILE   motions to learn from (default: the simulated corpus that ships with the add-on)
  --rig KIND      mannequin (default), or rigify: the human metarig of Blender's Rigify
  --shelf X Y Z   where the middle of the box's base ends, in metres: X to the worker's right, Y ahead, Z up
                  (default: 0.55 0.35 1.05)
  --stature M     height of the worker in metres (default: 1.75)
  --quick         render every eighth frame, small: for a first look and for tests

Results: lift.blend, lift.mp4, contact_sheet.png, report.json. Missing Debian packages are installed first.
TEXT
}

wrong() {
  fail "lift_to_shelf.sh: $* (see --help)"
}

need_values() {
  [ "$2" -le "$3" ] || wrong "$1 needs $([ "$2" -eq 1 ] && echo 'a value' || echo "$2 numbers")"
}

need_number() {
  [[ $2 =~ ^[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)$ ]] || wrong "$1 must be a number in metres, not '$2'"
}

read_arguments() {
  while [ $# -gt 0 ]; do
    case $1 in
      --help | -h) usage; exit 0 ;;
      --out) need_values "$1" 1 $(($# - 1)); OUT=$2; shift 2 ;;
      --corpus) need_values "$1" 1 $(($# - 1)); CORPUS=$2; shift 2 ;;
      --rig) need_values "$1" 1 $(($# - 1)); RIG=$2; shift 2 ;;
      --shelf) need_values "$1" 3 $(($# - 1)); SHELF=("$2" "$3" "$4"); shift 4 ;;
      --stature) need_values "$1" 1 $(($# - 1)); STATURE=$2; shift 2 ;;
      --quick) QUICK=(--quick); shift ;;
      *) wrong "unknown argument '$1'" ;;
    esac
  done
}

check_arguments() {
  local value
  [ -n "$OUT" ] || wrong "--out must name a folder"
  [[ $RIG = mannequin || $RIG = rigify ]] || wrong "--rig must be mannequin or rigify, not '$RIG'"
  for value in "${SHELF[@]}"; do need_number --shelf "$value"; done
  need_number --stature "$STATURE"
  [ -f "$CORPUS" ] || wrong "the corpus '$CORPUS' is not a file"
}

main() {
  read_arguments "$@"
  check_arguments
  if ! mkdir -p "$OUT" 2>/dev/null || [ ! -w "$OUT" ]; then
    fail "lift_to_shelf.sh: the folder '$OUT' cannot be written to"
  fi
  OUT=$(cd "$OUT" && pwd)
  need_packages "${RUN_PACKAGES[@]}"
  build_release reachcast_core
  # One argument per value with '=': a negative number is no option.
  blender -b --factory-startup --python-exit-code 1 --python "$ROOT/examples/lift_to_shelf.py" -- \
    --out="$OUT" --corpus="$(realpath "$CORPUS")" --rig="$RIG" --stature="$STATURE" \
    --x="${SHELF[0]}" --y="${SHELF[1]}" --z="${SHELF[2]}" "${QUICK[@]}" </dev/null | sed -u '/^Blender /d; /^$/d'
}

main "$@"
