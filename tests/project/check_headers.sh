#!/usr/bin/env bash
# check_headers.sh FOLDER LIST EIGEN COMPILER [SECOND]: compiles each header below FOLDER alone with COMPILER, and those of LIST in one
# source with SECOND. Fails if a header does not compile, includes a library other than Eigen, or is neither in LIST nor included by
# those that are.
set -euo pipefail
export folder=$1 eigen=$3
list=$2
compiler=$4
second=${5:-$compiler}
mapfile -t headers < <(cd "$folder" && find . -name '*.h' -printf '%P\n' | sort)
mapfile -t named <"$list"

included_files() { # COMPILER HEADER...: prints all files that the headers include, and the headers
  local log files foreign
  if ! log=$(printf '#include "%s"\n' "${@:2}" | "$1" -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Werror -isystem "$eigen" \
             -I "$folder" -H -x c++ - 2>&1); then
    echo "$1 does not compile ${*:2}:" >&2
    grep -v '^\.' <<<"$log" >&2
    return 1
  fi
  files=$(sed -n 's/^\.\.* //p' <<<"$log") # -H prints a dot for each level of inclusion, then the file
  foreign=$(grep -v -e "^$folder/" -e "^$eigen/" <<<"$files" |
            grep -E '/(fcl|assimp|CLI|nlohmann|boost|fmt|tbb|oneapi)/|/tiny_obj_loader\.h' || true)
  if [[ -n $foreign ]]; then
    printf '%s includes:\n%s\n' "${*:2}" "$foreign" >&2
    return 1
  fi
  echo "$files"
}
export -f included_files

printf '%s\0' "${headers[@]}" | xargs -0 -n 1 -P 2 bash -c 'included_files "$@" >/dev/null' included_files "$compiler"
reached=$(included_files "$second" "${named[@]}" | sed -n "s:^$folder/::p" | sort -u)
if ! diff <(printf '%s\n' "${headers[@]}") - <<<"$reached"; then
  echo "$list does not lead to the headers marked with <"
  exit 1
fi
echo "${#headers[@]} headers compile"
