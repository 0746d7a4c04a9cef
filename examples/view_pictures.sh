#!/usr/bin/env bash
# Makes the pictures of the viewer in the READMEs from real pages: view_pictures.sh. Needs what examples/view.sh builds.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

examples/install_packages.sh run view view-test
page_tests=tests/viewer/page
modules=build/page_tests
cmake -D FROM="$PWD/$page_tests" -D TO="$PWD/$modules" -D NPM=npm -P $page_tests/install_playwright.cmake
SPRUNG_PROGRAM="$PWD/build/release/bin/sprung" SPRUNG_SOURCE_DIR="$PWD" SPRUNG_TEST_MESHES=/usr/share/glmark2/models \
  SPRUNG_PAGE_TEST_MODULES="$PWD/$modules/node_modules" SPRUNG_PICTURES="$PWD/examples/pictures" \
  node $page_tests/run_tests.mjs $page_tests/pictures.mjs
