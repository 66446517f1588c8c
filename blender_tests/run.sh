#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# All tests, native and in Blender. Ends in one line: N passed, N failed, N skipped. Logs stay in build/logs.
#
#     bash blender_tests/run.sh [PART...]      parts: sanitized python blender window lift slurm (these by default), native,
#                                              bench
#
# sanitized and native are the same tests, with sanitizers and as released: one of them is enough for every run.
#
# Recordings are looked for in $REACHCAST_MOCAP, else in ../shared/mocap beside the project; without them tests skip.
set -euo pipefail
ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$ROOT/examples/setup.sh"
cd "$ROOT"

LOGS=$ROOT/build/logs
MOCAP=${REACHCAST_MOCAP:-$ROOT/../shared/mocap}
WORK=''
PASSED=0 FAILED=0 SKIPPED=0

have_recordings() {
  [ -d "$MOCAP/omomo" ] || [ -d "$MOCAP/lieblich_lifting" ]
}

# count PART PASSED FAILED SKIPPED
count() {
  PASSED=$((PASSED + $2)) FAILED=$((FAILED + $3)) SKIPPED=$((SKIPPED + $4))
  echo "$1: $2 passed, $3 failed, $4 skipped ($((SECONDS - BEGAN)) s)"
}

# The end of a part's log, then one failure: it did not come as far as counting its own tests.
broken() {
  tail -n 40 "$LOGS/$1.log"
  count "$1" 0 1 0
}

begin() {
  BEGAN=$SECONDS
  echo "== $1"
}

# run PART COMMAND...: the output goes to the part's log; the status is returned.
run() {
  local part=$1
  shift
  "$@" >"$LOGS/$part.log" 2>&1 </dev/null
}

# A part whose log ends in "N passed, N failed, N skipped". FAIL and ERROR blocks of the log are printed.
count_last_line() {
  local part=$1 status=$2 line
  line=$(grep -E '^[0-9]+ passed, [0-9]+ failed, [0-9]+ skipped$' "$LOGS/$part.log" | tail -n 1) || true
  if [[ ! $line =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed,\ ([0-9]+) ]]; then
    broken "$part"
    return
  fi
  local passed=${BASH_REMATCH[1]} failed=${BASH_REMATCH[2]} skipped=${BASH_REMATCH[3]}
  if [ "$status" -ne 0 ] && [ "$failed" -eq 0 ]; then
    tail -n 20 "$LOGS/$part.log"
    failed=1
  fi
  [ "$failed" -eq 0 ] || awk '/^(FAIL|ERROR)/ {on = 1} /^(ok|skip) / {on = 0} on && ++shown <= 200' "$LOGS/$part.log"
  count "$part" "$passed" "$failed" "$skipped"
}

# A part whose log ends in pytest's summary.
count_pytest() {
  local part=$1 status=$2 summary passed failed skipped
  summary=$(grep -E '^[^=]*[0-9]+ (passed|failed|skipped|error).* in [0-9.]+s' "$LOGS/$part.log" | tail -n 1) || true
  passed=$(number_before passed "$summary") failed=$(number_before failed "$summary")
  failed=$((failed + $(number_before error "$summary"))) skipped=$(number_before skipped "$summary")
  [ "$status" -eq 0 ] || [ "$failed" -gt 0 ] || failed=1
  [ "$failed" -eq 0 ] || tail -n 80 "$LOGS/$part.log"
  count "$part" "$passed" "$failed" "$skipped"
}

number_before() {
  grep -oE "[0-9]+ $1" <<<"$2" | grep -oE '[0-9]+' || echo 0
}

native_tests() {
  local part=$1 preset=$2 status=0 totals
  begin "$part: ctest of the preset $preset"
  build_preset "$preset" all || { count "$part" 0 1 0; return; }
  rm -f "$LOGS/$part.xml"
  run "$part" ctest --preset "$preset" -j2 --output-junit "$LOGS/$part.xml" || status=$?
  totals=$(/usr/bin/python3 - "$LOGS/$part.xml" <<'PY'
import sys, xml.etree.ElementTree as tree
try:
    suite = tree.parse(sys.argv[1]).getroot()
except (OSError, tree.ParseError):
    sys.exit()
total, failed, skipped = (int(suite.get(name, 0)) for name in ("tests", "failures", "skipped"))
skipped += int(suite.get("disabled", 0))
print(total - failed - skipped, failed, skipped)
PY
  )
  if [ -z "$totals" ] || { [ "$status" -ne 0 ] && [[ $totals =~ ^[0-9]+\ 0\  ]]; }; then
    broken "$part"
    return
  fi
  if [ "$status" -ne 0 ]; then
    grep -E -m 20 -A 12 '\*\*\*Failed|Failure$|ERROR: |runtime error' "$LOGS/$part.log" || true
  fi
  # shellcheck disable=SC2086
  count "$part" $totals
}

python_tests() {
  local status=0
  begin "python: files that need pytest"
  mapfile -t files < <(grep -lE '^(import|from) pytest' blender_tests/test_*.py)
  run python /usr/bin/python3 -m pytest -q -p no:cacheprovider "${files[@]}" || status=$?
  count_pytest python "$status"
}

blender_tests() {
  local status=0
  begin "blender: everything else, inside Blender"
  run blender blender -b --factory-startup --python-exit-code 1 --python blender_tests/runner.py || status=$?
  count_last_line blender "$status"
}

# A corpus of the recordings for the parts that take one; nothing without recordings.
recorded_corpus() {
  local file=$WORK/corpus.sqlite
  have_recordings || return 0
  [ -e "$file" ] || logged corpus /usr/bin/python3 examples/build_corpus.py --mocap "$MOCAP" --out "$file" || return 1
  echo "$file"
}

window_tests() {
  local status corpus file part
  begin "window: panels in a real window"
  corpus=$(recorded_corpus) || { count window 0 1 0; return; }
  for file in blender_tests/test_*_window.py; do
    part=$(basename "$file" .py) status=0
    run "$part" timeout 900 xvfb-run -a -s "-screen 0 1280x900x24" blender --factory-startup --enable-event-simulate \
      --window-geometry 0 0 1280 800 --python "$file" -- --out "$LOGS" ${corpus:+--corpus "$corpus"} || status=$?
    count_last_line "$part" "$status"
  done
}

bench_test() {
  local name
  for name in bench_bake bench_path bench_pictures bench_batch; do
    begin "bench: $name"
    if ! run "$name" blender -b --factory-startup --python-exit-code 1 --python "blender_tests/$name.py"; then
      broken "$name"
    elif grep -q '^skipped: ' "$LOGS/$name.log"; then
      count "$name" 0 0 1
    else
      grep -E 'ratio|a second' "$LOGS/$name.log"
      count "$name" 1 0 0
    fi
  done
  begin "bench: a corpus of a million motions"
  if run bench_large_corpus /usr/bin/python3 blender_tests/bench_large_corpus.py; then
    cat "$LOGS/bench_large_corpus.log"
    count bench_large_corpus 1 0 0
  else
    broken bench_large_corpus
  fi
}

# The main job, small: its files and numbers for both rigs, then what it does with a shelf that nobody reaches.
lift_test() {
  local status=0 rig
  begin "lift: the main job for both rigs"
  for rig in mannequin rigify; do
    run "lift-$rig" bash examples/lift_to_shelf.sh --quick --rig "$rig" --out "$WORK/$rig" \
      || tail -n 20 "$LOGS/lift-$rig.log"
  done
  run lift-refused bash examples/lift_to_shelf.sh --quick --shelf 0 0.5 3 --out "$WORK/refused" || true
  run lift /usr/bin/python3 blender_tests/check_lift.py "$WORK" "$LOGS/lift-refused.log" || status=$?
  count_last_line lift "$status"
}

slurm_test() {
  local status=0
  begin "slurm: a batch on two nodes, one of which is killed midway"
  run slurm /usr/bin/python3 blender_tests/check_slurm.py || status=$?
  count_last_line slurm "$status"
}

main() {
  local part parts=("$@")
  [ ${#parts[@]} -gt 0 ] || parts=(sanitized python blender window lift slurm)
  mkdir -p "$LOGS"
  WORK=$(mktemp -d)
  trap 'rm -rf "$WORK"' EXIT
  need_packages "${RUN_PACKAGES[@]}" "${TEST_PACKAGES[@]}"
  build_release reachcast_core simulate_corpus
  for part in "${parts[@]}"; do
    case $part in
      native) native_tests native release ;;
      sanitized) native_tests sanitized asan-ubsan ;;
      python | blender | window) "${part}_tests" ;;
      bench | lift | slurm) "${part}_test" ;;
      *) fail "run.sh: unknown part '$part'" ;;
    esac
  done
  echo "$PASSED passed, $FAILED failed, $SKIPPED skipped"
  [ "$FAILED" -eq 0 ]
}

main "$@"
