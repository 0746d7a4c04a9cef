#!/usr/bin/env bash
# Compares the runs of scenarios_tests of two builds bit for bit, by the hashes of all positions of all frames. Tests may have been
# renamed in between. A test that ran on other scenes shows up as two that differ.
#
#   SPRUNG_SCENARIO_HASHES=before.txt .../scenarios_tests    # of the build before the change: a file that does not exist yet
#   SPRUNG_SCENARIO_HASHES=after.txt .../scenarios_tests     # and after
#   tests/compare_scenarios.sh before.txt after.txt
#
# Prints the runs that only one of the files has (<: before, >: after); exit status 1 when there are any.
set -euo pipefail
if [[ $# -ne 2 || ! -e $1 || ! -e $2 ]]; then
  sed -n '2,9s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi

# Each file's hashes are counted, because one run may be in several tests.
awk 'NR == FNR { before[$1, ++count[$1]] = $0; next }
     { ++seen[$1] }
     ($1, seen[$1]) in before { delete before[$1, seen[$1]]; ++same; next }
     { print "> " $2 " frames of " $3; ++different }
     END {
       for (key in before) { split(before[key], run, " "); print "< " run[2] " frames of " run[3]; ++different }
       print same + 0 " runs are the same, " different + 0 " differ"
       exit different > 0
     }' "$1" "$2"
