# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2034
# Sourced by the two commands: Debian packages, then the native module. Does nothing where everything is in place.
#
#   need_packages NAME...   installs the Debian 12 packages that are missing, and says which
#   build_release TARGET    configures where needed and builds a target of the release preset

RUN_PACKAGES=(
  g++ cmake ninja-build python3-dev pybind11-dev libeigen3-dev libglm-dev libboost-dev libsqlite3-dev libgtest-dev
  libbenchmark-dev blender python3 python3-numpy ffmpeg fonts-dejavu-core libegl1 libgl1-mesa-dri
)
TEST_PACKAGES=(python3-pytest python3-scipy python3-matplotlib xvfb xauth chromium slurm-wlm)

fail() {
  echo "$*" >&2
  exit 1
}

is_installed() {
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  else
    sudo -n "$@"
  fi
}

# A full disk or a missing mirror is apt's to explain: its last lines are shown.
apt_quietly() {
  local log
  log=$(mktemp)
  if ! as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y "$@" </dev/null >"$log" 2>&1; then
    tail -n 8 "$log" >&2
    rm -f "$log"
    fail "apt-get $1 failed; its last lines are above."
  fi
  rm -f "$log"
}

need_packages() {
  local name missing=()
  command -v dpkg-query >/dev/null || fail "This is not Debian, so these packages cannot be installed here: $*"
  for name in "$@"; do
    is_installed "$name" || missing+=("$name")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ] && ! sudo -n true 2>/dev/null; then
    fail "These Debian packages are missing and need root to install: apt-get install ${missing[*]}"
  fi
  echo "Installing Debian packages: ${missing[*]}"
  apt_quietly update
  apt_quietly install --no-install-recommends "${missing[@]}"
}

# Runs a command with its output in a log under build/logs; shows the end of the log when the command fails.
logged() {
  local log=$ROOT/build/logs/$1.log
  shift
  mkdir -p "$ROOT/build/logs"
  if ! "$@" >"$log" 2>&1 </dev/null; then
    tail -n 40 "$log" >&2
    return 1
  fi
}

# CMake configures again by itself when a CMake file changes, but not when the presets do.
configure_preset() {
  local ninja=$ROOT/build/$1/build.ninja
  if [ ! -e "$ninja" ] || [ "$ROOT/CMakePresets.json" -nt "$ninja" ]; then
    echo "Configuring build/$1"
    (cd "$ROOT" && logged "configure-$1" cmake --preset "$1") || return 1
    touch "$ninja"
  fi
}

build_preset() {
  local preset=$1 log=$ROOT/build/logs/build-$1.log
  configure_preset "$preset" || return 1
  echo "Native build, preset $preset (some minutes when it is new)"
  (cd "$ROOT" && logged "build-$preset" cmake --build --preset "$preset" --target "${@:2}") || return 1
  ! grep -q 'no work to do' "$log" || echo "Nothing to build: all is up to date"
}

build_release() {
  build_preset release "$@" || fail "The native build failed; the end of its log is above, the rest in build/logs."
}
