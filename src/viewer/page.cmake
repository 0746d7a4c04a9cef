# Builds the page and makes its text a source of the viewer.
file(GLOB_RECURSE page_sources CONFIGURE_DEPENDS viewer/page/*.ts viewer/page/*.css viewer/page/*.html viewer/page/*.mjs)
list(FILTER page_sources EXCLUDE REGEX /node_modules/)
set(page ${SPRUNG_PAGE_FOLDER}/page.html)
set(page_cpp ${SPRUNG_PAGE_FOLDER}/page.cpp)
add_custom_command(
  OUTPUT ${page_cpp}
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${CMAKE_CURRENT_SOURCE_DIR}/viewer/page ${SPRUNG_PAGE_FOLDER}
  COMMAND ${NPM} run --silent build -- ${page}
  COMMAND ${CMAKE_COMMAND} -D IN=${page} -D OUT=${page_cpp} -P ${CMAKE_CURRENT_SOURCE_DIR}/viewer/embed.cmake
  WORKING_DIRECTORY ${SPRUNG_PAGE_FOLDER}
  DEPENDS ${page_sources} ${CMAKE_CURRENT_SOURCE_DIR}/viewer/page/package.json ${CMAKE_CURRENT_SOURCE_DIR}/viewer/embed.cmake
  COMMENT "Building the viewer's page")
target_sources(sprung_viewer PRIVATE ${page_cpp})
set_source_files_properties(${page_cpp} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
