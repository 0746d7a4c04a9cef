#!/usr/bin/env bash
# completion_test.sh PROGRAM COMPLETION: what the completion for bash proposes, with the commands and options of PROGRAM.
set -uo pipefail
program=$1
source "$2" || exit
compopt() { :; } # bash has it only while it completes
cd "$(mktemp -d)" || exit
trap 'rm -rf "$PWD"' EXIT
mkdir 'a folder'
touch scene.json mesh.obj 'two words.json'
failures=0

# Words of a command line, of which the last is completed; then, after `gives`, what is proposed.
completion() {
  local words=() expected
  while [[ $1 != gives ]]; do
    words+=("$1")
    shift
  done
  shift
  COMP_WORDS=("${words[@]}")
  COMP_CWORD=$((${#words[@]} - 1))
  _sprung "$program" "${words[-1]}" "${words[-2]}"
  expected=$(printf '%s\n' "$@" | sort)
  if [[ $(printf '%s\n' "${COMPREPLY[@]}" | sort) != "$expected" ]]; then
    echo "${words[*]} gives ${COMPREPLY[*]:-nothing} instead of ${*:-nothing}"
    failures=$((failures + 1))
  fi
}

completion sprung va gives validate
completion sprung --v gives --version
completion sprung help ma gives materials
completion sprung run --ove gives --overwrite
completion sprung plot --fram gives
completion sprung run '' gives 'a folder' scene.json 'two words.json'
completion sprung info m gives mesh.obj
completion sprung plot '' gives 'a folder'
completion sprung run scene.json --out '' gives 'a folder'
completion sprung run scene.json --quiet s gives scene.json
completion sprung run scene.json --set '' gives
completion sprung run scene.json --format us gives usda
completion sprung run scene.json --format = us gives usda
completion sprung run scene.json --format obj,np gives obj,npz obj,npz64
completion sprung materials cott gives cotton
completion sprung unknown '' gives
[[ $failures -eq 0 ]]
