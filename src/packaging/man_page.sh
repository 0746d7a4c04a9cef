#!/usr/bin/env bash
# man_page.sh PROGRAM FILE.gz: writes the man page sprung(1), of what PROGRAM prints as help of itself and of each command.
set -euo pipefail
program=$1
help=$("$program" help)
commands=$(sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p' <<<"$help")

{
  printf '%s\n' "$help"
  for command in $commands; do
    printf '@command %s\n' "$command"
    "$program" help "$command"
  done
} | awk -v version="$("$program" --version)" -f "$(dirname "${BASH_SOURCE[0]}")/man_page.awk" | gzip -9n >"$2.part"
mv "$2.part" "$2"
