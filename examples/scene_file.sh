#!/usr/bin/env bash
# Prints the absolute path of a scene: scene_file.sh SCENE. SCENE is a file or the name of an example.
# Ends with 2 if there is no such scene, and names the example that was probably meant.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
scene="$1"
example="${scene#examples/}"
example="${example%.json}"
if [[ -f "$scene" ]]; then
  realpath "$scene"
elif [[ "$example" != */* && -f "$here/$example.json" ]]; then
  echo "$here/$example.json"
else
  # The name with the fewest edits (insert, remove, replace), if these are at most a third of its letters.
  near="$(cd "$here" && printf '%s\n' *.json | awk -v word="$(basename "$example")" '
    function least(a, b, c) { return a < b ? (a < c ? a : c) : (b < c ? b : c) }
    function edits(a, b,  i, j, d) {
      for (i = 0; i <= length(a); ++i) d[i, 0] = i
      for (j = 0; j <= length(b); ++j) d[0, j] = j
      for (i = 1; i <= length(a); ++i)
        for (j = 1; j <= length(b); ++j)
          d[i, j] = least(d[i - 1, j] + 1, d[i, j - 1] + 1, d[i - 1, j - 1] + (substr(a, i, 1) != substr(b, j, 1)))
      return d[length(a), length(b)]
    }
    { sub(/\.json$/, ""); count = edits(word, $0) }
    count <= length($0) / 3 && (!best || count < fewest) { best = $0; fewest = count }
    END { print best }')"
  echo "There is no scene '$scene'.${near:+ Did you mean the example '$near'?} The examples are:" >&2
  (cd "$here" && printf '  %s\n' *.json) >&2
  exit 2
fi
