#!/usr/bin/env bash
# Lets clang-tidy look at the sources that changed since a commit: tests/tidy.sh [COMMIT]. Without COMMIT it is the last tag, or the
# one below as long as there is none. Needs what tests/run.sh configures (build/release).
#
# A file counts as changed when more than its name, comments and includes differ; a changed header is checked through the sources of
# its own name, or else through the first source that includes it. To stay within three minutes on two cores, at most kMostFiles are
# checked: those of src/ first, in an order that their text alone decides.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

kFirstCommit=31d74f0
kMostFiles=24 # some 10 s each on one core
build=build/release

if [[ ! -e $build/compile_commands.json ]]; then
  echo "$build is not configured: run tests/run.sh, or cmake --preset release" >&2
  exit 2
fi
tidy=$(command -v clang-tidy-14 || command -v clang-tidy) || { echo "clang-tidy is not installed" >&2; exit 2; }
since=${1:-$(git describe --tags --abbrev=0 2> /dev/null || echo "$kFirstCommit")}
if ! git rev-parse --quiet --verify "$since^{commit}" > /dev/null; then
  if [[ $# -gt 0 ]]; then
    echo "there is no commit $since here" >&2
    exit 2
  fi
  since=$(git hash-object -t tree /dev/null) # a shallow clone: everything counts as changed
fi

# The code of a text: without includes, comments and empty lines.
code() { sed -E '/^#include /d; s|[[:space:]]*//.*||; /^[[:space:]]*$/d'; }

changed_files() {
  local status before after
  git diff --find-renames --diff-filter=d --name-status "$since" -- src tests |
    while IFS=$'\t' read -r status before after; do
      after=${after:-$before}
      [[ $after == *.h || $after == *.cpp ]] || continue
      if [[ $status == A ]] || ! cmp -s <(git show "$since:$before" | code) <(code < "$after"); then echo "$after"; fi
    done
  git ls-files --others --exclude-standard -- 'src/*.h' 'src/*.cpp' 'tests/*.h' 'tests/*.cpp'
}

# The sources through which a file is checked.
sources_of() {
  local file=$1 stem found
  if [[ $file == *.cpp ]]; then
    echo "$file"
    return
  fi
  stem=$(basename "$file" .h)
  found=$(git ls-files --cached --others --exclude-standard -- "src/**/$stem.cpp" "tests/**/$stem.cpp" "tests/**/${stem}_test.cpp")
  if [[ -z $found ]]; then
    found=$(git grep --untracked -lF "#include \"${file#*/}\"" -- 'src/*.cpp' 'tests/*.cpp' | head -n 1) || true
  fi
  if [[ -n $found ]]; then echo "$found"; fi
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# clang-tidy cannot read the headers that GCC compiled ahead.
sed -E 's/ -Winvalid-pch -include [^" ]*cmake_pch.hxx//' $build/compile_commands.json > "$work/compile_commands.json"

changed_files > "$work/changed"
while read -r file; do sources_of "$file"; done < "$work/changed" | sort -u > "$work/sources"
# Only what is compiled: programs that CMake was told to leave out are not.
while read -r source; do
  if grep -qF "\"file\": \"$PWD/$source\"" "$work/compile_commands.json"; then
    echo "${source%%/*} $(git hash-object "$source") $source"
  fi
done < "$work/sources" | sort | cut -d ' ' -f 3 > "$work/compiled"
count=$(wc -l < "$work/compiled")
head -n $kMostFiles "$work/compiled" > "$work/checked"
echo "$count sources changed since $since, $(wc -l < "$work/checked") of them checked"

if ! xargs --arg-file="$work/checked" --max-args=1 --max-procs="$(nproc)" --no-run-if-empty \
  "$tidy" -p "$work" --quiet 2> "$work/errors" > "$work/findings"; then
  cat "$work/findings"
  grep -vE '^[0-9]+ warnings? generated|^Suppressed|^Use -header-filter' "$work/errors" >&2 || true
  exit 1
fi
