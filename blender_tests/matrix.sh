#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The same tests on the Blenders of three Debian releases: this machine's and, in chroots, those of trixie and sid.
# Prints one line per Blender: versions, passed, failed, skipped, date. Logs stay in build/logs/matrix.
#
#     bash blender_tests/matrix.sh [--clean] [--parts "native python blender window lift slurm"] [here|trixie|sid ...]
#
# Needs root, network for a chroot that is new, and 6 GB in $REACHCAST_CHROOTS (/var/tmp/reachcast-matrix). --clean removes
# the chroots named and makes them anew. Recordings: as for run.sh; a chroot sees them read-only.
set -euo pipefail
ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$ROOT/examples/setup.sh"

CHROOTS=${REACHCAST_CHROOTS:-/var/tmp/reachcast-matrix}
MIRROR=${REACHCAST_MIRROR:-http://deb.debian.org/debian}
MOCAP=${REACHCAST_MOCAP:-$ROOT/../shared/mocap}
LOGS=$ROOT/build/logs/matrix
PARTS='native python blender window lift slurm'
LINES=()
STATUS=0

# What the Blender of a release needs and its package does not ask for.
extra_packages() {
  case $1 in
    sid) echo python3-cattr python3-requests ;;  # Blender 5.2 and its add-ons import them as they start
  esac
}

# make_chroot SUITE: a small Debian with the project's packages; made once, kept for the next run.
make_chroot() {
  local suite=$1 root=$CHROOTS/$1 extra
  [ ! -e "$root/.complete" ] || return 0
  extra=$(extra_packages "$suite")
  echo "Making a chroot of $suite in $root (some 10 minutes; log: $LOGS/$suite-chroot.log)"
  rm -rf --one-file-system "$root"
  mkdir -p "$root"
  {
    debootstrap --variant=minbase "$suite" "$root" "$MIRROR"
    # An archived mirror's Release files may be past their date.
    echo 'Acquire::Check-Valid-Until "false";' >"$root/etc/apt/apt.conf.d/90reachcast"
    # shellcheck disable=SC2086
    inside "$root" "apt-get -q update && apt-get -q -y install --no-install-recommends \
      ${RUN_PACKAGES[*]} ${TEST_PACKAGES[*]} $extra && apt-get clean"
  } >"$LOGS/$suite-chroot.log" 2>&1 </dev/null || { tail -n 15 "$LOGS/$suite-chroot.log" >&2; return 1; }
  touch "$root/.complete"
}

# inside ROOT COMMAND: in a mount and process namespace of its own, so that nothing stays mounted or running however it ends.
# To stop it, kill -9 its unshare process.
inside() {
  # shellcheck disable=SC2016
  unshare --mount --pid --fork --kill-child bash -euc '
    root=$1 mocap=$2
    mount --bind "$root" "$root"
    mount -t proc proc "$root/proc"
    mount -t tmpfs -o mode=755 tmpfs "$root/dev"
    mkdir -p "$root/dev/shm" "$root/mocap"
    for node in null zero full random urandom tty; do
      touch "$root/dev/$node"
      mount --bind "/dev/$node" "$root/dev/$node"
    done
    ln -s /proc/self/fd "$root/dev/fd"
    mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"
    if [ -d "$mocap" ]; then
      mount --bind "$mocap" "$root/mocap"
      mount -o remount,bind,ro "$root/mocap"
    fi
    exec chroot "$root" /usr/bin/env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin \
      DEBIAN_FRONTEND=noninteractive REACHCAST_MOCAP=/mocap bash -euc "$3"
  ' inside "$1" "$MOCAP" "$2" </dev/null
}

# A copy of the source, without what git ignores; what was built in the chroot stays.
copy_source() {
  local target=$1/src
  mkdir -p "$target"
  find "$target" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
  git -C "$ROOT" ls-files -z --cached --others --exclude-standard \
    | tar -C "$ROOT" --null --ignore-failed-read -T - -c | tar -C "$target" -x
}

VERSIONS='blender -b --factory-startup --python-expr "import bpy, sys
print(\"VERSIONS\", bpy.app.version_string, *sys.version_info[:3])" 2>/dev/null | grep ^VERSIONS || echo VERSIONS unknown'

# test_suite SUITE: runs the parts there; one line for the summary.
test_suite() {
  local suite=$1 root=$CHROOTS/$1 log=$LOGS/$1.log status=0 versions counts blender python
  echo "== $suite: $PARTS"
  if [ "$suite" = here ]; then
    versions=$(bash -c "$VERSIONS")
    # shellcheck disable=SC2086
    bash "$ROOT/blender_tests/run.sh" $PARTS >"$log" 2>&1 </dev/null || status=$?
  else
    make_chroot "$suite" || { note "$suite: no chroot could be made" 1; return; }
    copy_source "$root"
    versions=$(inside "$root" "$VERSIONS")
    # A chroot of an earlier run may lack what is needed since; run.sh looks for all other packages.
    inside "$root" "cd /src && source examples/setup.sh && need_packages $(extra_packages "$suite") &&
      bash blender_tests/run.sh $PARTS" >"$log" 2>&1 || status=$?
    rm -rf "${LOGS:?}/$suite" && cp -r "$root/src/build/logs" "$LOGS/$suite"
  fi
  counts=$(tail -n 1 "$log")
  if [[ ! $counts =~ ^[0-9]+\ passed,\ [0-9]+\ failed,\ [0-9]+\ skipped$ ]]; then
    tail -n 20 "$log" >&2
    counts='the run broke off'
    status=1
  fi
  grep -E '^[a-z_-]+: [0-9]+ passed' "$log" || true
  read -r blender python <<<"$(sed -E 's/^VERSIONS (.*) ([0-9]+) ([0-9]+) ([0-9]+)$/\1 \2.\3.\4/' <<<"$versions")"
  note "$suite: Blender $blender, Python $python: $counts, $(date -I)" "$status"
}

note() {
  LINES+=("$1")
  [ "$2" -eq 0 ] || STATUS=1
}

main() {
  local clean=false suite suites=()
  while [ $# -gt 0 ]; do
    case $1 in
      --clean) clean=true ;;
      --parts) PARTS=${2:?--parts takes the names of parts}; shift ;;
      here | trixie | sid) suites+=("$1") ;;
      *) fail "matrix.sh: unknown argument '$1'; its first lines say what it takes" ;;
    esac
    shift
  done
  [ ${#suites[@]} -gt 0 ] || suites=(here trixie sid)
  mkdir -p "$LOGS"
  if [[ " ${suites[*]} " =~ \ (trixie|sid)\  ]]; then
    [ "$(id -u)" -eq 0 ] || fail "matrix.sh makes chroots and mounts in them: run it as root, or with 'here' alone"
    need_packages debootstrap
  fi
  for suite in "${suites[@]}"; do
    if $clean && [ "$suite" != here ]; then
      rm -rf --one-file-system "${CHROOTS:?}/$suite"
    fi
    test_suite "$suite"
  done
  printf '%s\n' "${LINES[@]}"
  return "$STATUS"
}

main "$@"
