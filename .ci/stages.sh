# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
# For .ci/run and .ci/long: commands as named stages, and how long each took.

stage_times=""

# stage NAME COMMAND...: runs the command. Where it fails the script ends, with the times so far. (Within a function that is a stage
# `set -e` does not hold: what may fail there is followed by `|| return 1`.)
stage() {
  stage_name=$1
  shift
  printf '\n== %s\n' "$stage_name"
  stage_begin=$(date +%s)
  stage_code=0
  "$@" || stage_code=$?
  stage_times="$stage_times$(printf '%6d s  %s' $(($(date +%s) - stage_begin)) "$stage_name")
"
  if [ "$stage_code" -ne 0 ]; then
    print_stage_times
    printf '%s failed with exit code %d\n' "$stage_name" "$stage_code" >&2
    exit 1
  fi
}

print_stage_times() {
  printf '\n== How the time was spent\n%s' "$stage_times"
}

if command -v ccache >/dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER="${CMAKE_CXX_COMPILER_LAUNCHER:-ccache}"; fi

# build PRESET: configures it, if that was not done, and builds it. A preset that another one is built by has that one's folder.
build() {
  [ -f "build/${1%%-*}/build.ninja" ] || cmake --preset "${1%%-*}" || return 1
  cmake --build --preset "$1"
}

run_tests() {
  preset=$1
  shift
  ctest --preset "$preset" --parallel "$(nproc)" "$@"
}
