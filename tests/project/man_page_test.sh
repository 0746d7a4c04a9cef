#!/usr/bin/env bash
# man_page_test.sh PROGRAM PAGE.gz: groff reads the man page without a warning; it has each line of the help of each command once.
set -euo pipefail
program=$1
page=$2

warnings=$(zcat "$page" | groff -man -Tutf8 -ww 2>&1 >/dev/null)
if [[ -n $warnings ]]; then
  echo "$warnings"
  exit 1
fi
# In one column, so that no line is broken, without what only formats.
text=$(zcat "$page" | groff -man -Tascii -P-cbou -rLL=2000n | sed 's/^ *//; s/  */ /g')
failures=0

expect() { # TEXT: a line of the page
  grep --quiet --line-regexp --fixed-strings -e "$1" <<<"$text" && return
  echo "the man page lacks: $1"
  failures=$((failures + 1))
}

# The words of a help, without titles: the name of an option and its text share a line there, not in the page.
words() { tr -s ' \n' '\n' | sed '/^[A-Z][a-z]*:$/d'; }

commands=$("$program" help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
[[ $(wc -w <<<"$commands") -gt 5 ]]
for command in $commands; do
  expect "$command"
  section=$(sed -n "/^$command\$/,\$p" <<<"$text")
  "$program" help "$command" | sed '/^Examples:/,$d' | words >"$page.expected"
  words <<<"$section" >"$page.found"
  # The section begins with its name, ends where the next begins, and may have a full stop after the summary.
  sed -i '1d' "$page.found"
  count=$(wc -l <"$page.expected")
  if ! diff <(sed 's/\.$//' "$page.expected") <(head -n "$count" "$page.found" | sed 's/\.$//') >"$page.difference"; then
    echo "the section of $command differs from its help:"
    head -n 5 "$page.difference"
    failures=$((failures + 1))
  fi
done
while read -r example; do expect "$example"; done < <("$program" help | sed -n '/^Examples:/,/^$/s/^  //p')
expect "sprung - simulates spring-damper networks that collide with meshes, and writes animations"
expect "EXIT STATUS"
rm -f "$page".{expected,found,difference}
[[ $failures -eq 0 ]]
