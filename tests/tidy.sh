#!/usr/bin/env bash
# Lets clang-tidy check the sources of src/ and tests/ that it has not checked in their present form. Needs what tests/run.sh
# configures (build/release).
#
# The form of a source is a hash of its preprocessed text, its flags, its exceptions (NOLINT) and the checks. Forms without findings
# are remembered in SPRUNG_TIDY_CACHE (~/.cache/sprung/tidy), which all clones share. The script ends after SPRUNG_TIDY_SECONDS
# (600): later runs check what it did not reach. Sources with known findings come first, then those of src/ in the order of their
# hashes, so that each change of a widely used header begins elsewhere.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build=build/release
cache=${SPRUNG_TIDY_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/sprung/tidy}
end=$((EPOCHSECONDS + ${SPRUNG_TIDY_SECONDS:-600}))

if [[ ! -e $build/compile_commands.json ]]; then
  echo "$build is not configured: run tests/run.sh, or cmake --preset release" >&2
  exit 2
fi
tidy=$(command -v clang-tidy-14 || command -v clang-tidy) || { echo "clang-tidy is not installed" >&2; exit 2; }
mkdir -p "$cache"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/findings"

# clang-tidy cannot read the headers that GCC compiled ahead.
sed -E 's/ -Winvalid-pch -include [^" ]*cmake_pch.hxx//' $build/compile_commands.json > "$work/compile_commands.json"
checks=$({ "$tidy" --version; git ls-files '*.clang-tidy' | xargs cat; grep -rh --include='*.h' NOLINT src tests; } | sha256sum)

# Lines "SOURCE<tab>COMMAND", where COMMAND preprocesses the source. Line numbers, which the macros of tests contain, become 0.
sed -nE 's/^ *"command": "(.*)",$/\1/p' "$work/compile_commands.json" | sed -E 's/\\(.)/\1/g; s/ -o [^ ]+ -c / -w -E -P -D__LINE__=0 /' |
  awk -v root="$PWD/" '{ source = $NF } index(source, root "src/") == 1 || index(source, root "tests/") == 1 {
    print substr(source, length(root) + 1) "\t" $0 }' > "$work/commands"

# Prints "PRIORITY FORM SOURCE".
form_of() {
  local source=${1%%$'\t'*} command=${1#*$'\t'} form priority
  form=$({ echo "$checks $command"; grep NOLINT "$source" || true; eval "$command"; } | sed "s|$PWD/||g" | sha256sum | cut -c -40)
  priority=2
  if [[ -e $cache/$form ]]; then
    touch "$cache/$form" # still in use
    priority=checked
  elif [[ -e $cache/$form.findings ]]; then
    priority=0
  elif [[ $source == src/* ]]; then
    priority=1
  fi
  echo "$priority $form $source"
}

# Prints "SOURCE" once it is checked.
check() {
  local form source status=0
  read -r _ form source <<< "$1"
  ((EPOCHSECONDS < end)) || return 0
  timeout $((end - EPOCHSECONDS)) "$tidy" -p "$work" --quiet "$source" > "$work/$form" 2>&1 || status=$?
  ((status != 124)) || return 0 # out of time
  if ((status == 0)); then
    touch "$cache/$form"
    rm -f "$cache/$form.findings"
  else
    touch "$cache/$form.findings"
    grep -vE '^[0-9]+ warnings? |^Suppressed |^Use -header-filter|^[0-9]+ warnings? treated as errors' "$work/$form" > "$work/findings/$form" ||
      echo "$source: clang-tidy ended with $status" > "$work/findings/$form"
  fi
  echo "$source"
}

export build cache end tidy work checks
export -f form_of check
in_parallel() { xargs --delimiter='\n' --max-args=1 --max-procs="$(nproc)" --no-run-if-empty bash -euo pipefail -c "$1 \"\$0\""; }
in_parallel form_of < "$work/commands" > "$work/forms"
sort "$work/forms" | grep -v '^checked' > "$work/unchecked" || true
in_parallel check < "$work/unchecked" > "$work/done"

# Forms that no clone has met for a season.
find "$cache" -type f -mtime +90 -delete
total=$(wc -l < "$work/forms") unchecked=$(wc -l < "$work/unchecked") checked=$(wc -l < "$work/done")
echo "$total sources: $((total - unchecked)) were checked before, $checked now, $((unchecked - checked)) are left to the next run"
if [[ -n $(ls "$work/findings") ]]; then
  cat "$work"/findings/*
  exit 1
fi
